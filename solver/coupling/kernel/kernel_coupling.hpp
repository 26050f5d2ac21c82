#pragma once
/// \file Exchange of fluid and rock over one step: void fraction, forces on rock, momentum for the fluid.
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "solver/coupling/kernel/mapping.hpp"
#include "solver/coupling/rock_coupling.hpp"
#include "solver/physics/catalogue.hpp"
#include "solver/ports/communicator.hpp"
#include "solver/ports/dem_engine.hpp"
#include "solver/ports/fluid_engine.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::coupling {

/// The flow at a rock, sampled with psi; it stays as it is over one step.
struct FlowAtRock {
    Vec3 velocity = Vec3::Zero();           ///< u [m/s]
    Vec3 acceleration = Vec3::Zero();       ///< Du/Dt [m/s2]
    double void_fraction = 1.0;             ///< [-]
    Vec3 vorticity = Vec3::Zero();          ///< [1/s], with lift only
    Vec3 stress_divergence = Vec3::Zero();  ///< div(tau) [m/s2], without viscous force only
    bool has_cells = true;                  ///< false: no cell of the mesh is in reach, and rock and fluid feel nothing of each other
};

/// One step's exchange. Call in order: insert (when rock is due), sample, move, map, book.
///
/// With D the drag per slip velocity, V a rock's volume, J the impulse of drag and Du/Dt parts on it over the step, dv the change of its
/// velocity (with contacts and weight), the fluid is to receive per cell, over rho_f and mixture volume,
///   target = sum_p w_p (-J_p / (rho_f dt) + C_AM V_p dv_p / dt + D_p (ubar_p - u_old) / rho_f) + carry / (2 dt)       [m/s2],
/// where ubar_p = sum_c w_p u_old V_c: drag slows down each part of the fluid in a kernel by its own slip, which adds up to nothing over
/// the cells of a rock. The fluid receives target - K (u_new - u_old) - M (Du/Dt_new - Du/Dt_old), K = sum_p w_p D_p / rho_f, M = (1 +
/// C_AM) solid fraction, because drag and Du/Dt parts lagged by a step would be unstable. What is still owed, carry = carry_old / 2 +
/// (target - received) dt, goes into the next targets by halves: momentum is exchanged to the last bit, part of it some steps late.
class KernelCoupling final : public RockCoupling {
public:
    KernelCoupling(const CouplingSettings& settings, const FluidProperties& properties, FluidEngine& fluid, DemEngine& dem,
                   Communicator& communicator);

    /// Puts rock into the run at the present time; rock without a velocity gets the local fluid velocity. The void fraction is replaced
    /// with that of all rock, without a source. \return ids of `due` that found no place
    /// \throws CheckFailure  when cells are so full of rock that no fluid is left (also of map), or when rock has no cell in reach
    std::vector<int> insert(const std::vector<FeedRock>& due) override;

    std::vector<bool> room_for(const std::vector<FeedRock>& rocks) const override;

    void adopt_present_rock() override;

    /// Takes rock out of the run. The fluid takes its place without a source: the volume flow of fluid and rock together does not change.
    void remove(gsl::span<const int> ids) override;

    /// Samples the flow at every rock on the present mesh. What a flow that does not feel rock needs of it, the void fraction, is laid
    /// here, once a step.
    void sample() override;

    /// Longest step [s] in which rock travels a quarter of its kernel width, relative to the cells of either zone, and the rotor interface
    /// a quarter of the narrowest; in a flow that does not feel rock, rock half of its width. Infinity without rock. Kernels are at
    /// least 1.5 cells wide, and what moves with the rock is smooth on them.
    double travel_limit() const override;

    const DemStep& move() override;

    /// Builds both void fractions and the momentum exchange on the moved mesh; nothing for a flow that does not feel rock.
    void map() override;

    gsl::span<const double> void_fraction_old() const override { return void_fraction_old_; }
    gsl::span<const double> void_fraction_new() const override { return void_fraction_new_; }
    MomentumExchange exchange() const override { return {source_, drag_rate_, inertia_}; }

    /// Updates the carry from the momentum that the fluid received. MomentumBalance tells whether it did.
    ExchangeBalance book() override;

    /// New warnings since the last call: closures outside their range, rock whose centre lies in steel, rock without cells.
    std::vector<std::string> take_warnings() override { return std::exchange(warnings_, {}); }

    const std::vector<FlowAtRock>& flow() const { return flow_; }
    const Mapping& mapping() const { return mapping_; }
    const BookedExchange& booked() const override { return booked_; }

    /// Momentum per mixture volume over rho_f that this rank's cells have yet to receive [m/s]; with `booked` all that a checkpoint needs.
    const std::vector<Vec3>& carry() const override { return carry_; }
    void restore(std::vector<Vec3> carry, const BookedExchange& booked) override;

private:
    std::vector<double> spread_present_rock();
    void follow_set_of_rock();
    void replace_void_fraction();
    void note_rock_without_cells();
    void note_fullness(const std::vector<double>& solid_fraction, double largest);
    void sample_with(const Stencils& stencils, std::vector<FlowAtRock>& flow) const;
    void take_out_own_trace();
    Vec3 velocity_of_cells(std::size_t rock) const;
    void map_present_rock();
    void require_all_rocks() const;
    void follow_departures();
    void add_impulses(const Stencils& stencils, gsl::span<const Vec3> impulse, gsl::span<const Vec3> velocity_change,
                      gsl::span<const double> volume);
    void even_out_within_kernels(const std::vector<double>& drag);
    std::vector<double> volumes_of_rock_in_both(std::vector<double> volumes) const;
    std::vector<double> void_fraction_before(const std::vector<double>& volume, const std::vector<double>& old_solid,
                                             const std::vector<double>& present_solid);
    physics::RockInFluid rock_in_fluid(const Rocks& rocks, std::size_t p, const FlowAtRock& flow) const;
    double sphericity_of(int shape) const;
    double drag_per_slip(const physics::RockInFluid& rock, double slip_speed) const;
    Vec3 steady_force(const physics::RockInFluid& rock, const FlowAtRock& flow) const;
    void check_ranges();
    void check_range(const physics::Closure& closure, const physics::RockNumbers& numbers, int id);
    void warn_once(const std::string& subject, const std::string& text);
    double volume_error(const std::vector<double>& solid_fraction, const std::vector<double>& rock_volume) const;
    RockShapes shapes(const std::vector<Vec3>& position) const;

    CouplingSettings settings_;
    FluidProperties properties_;
    FluidEngine& fluid_;
    DemEngine& dem_;
    Communicator& communicator_;
    physics::DragLaw drag_;
    physics::HindranceLaw hindrance_;
    physics::LiftLaw lift_;  // null: none
    Mapping mapping_;
    double interface_speed_;

    Stencils present_;                       // of dem_.rocks() on the present mesh
    Stencils old_;                           // of the same rocks where they were when the step began
    std::vector<FlowAtRock> flow_;           // at the rocks when the step began
    Rocks before_;                           // the rocks when the step began
    DemStep step_;                           // what moved them
    std::vector<std::size_t> index_before_;  // of each rock of dem_.rocks() in before_

    std::vector<double> void_fraction_old_, void_fraction_new_;
    std::vector<Vec3> source_;  // the target
    std::vector<double> drag_rate_, inertia_;
    std::vector<Vec3> carry_;
    Vec3 rock_momentum_ = Vec3::Zero();  // that the rocks got from the fluid over the step [N s]
    double gross_impulse_ = 0.0;
    BookedExchange booked_;
    ExchangeBalance balance_;
    std::set<int> without_cells_;         // ids of all rock so far that had no cells
    std::size_t next_without_cells_ = 1;  // number of them that is told next
    std::set<std::string> warned_;
    std::vector<std::string> warnings_;
};

}  // namespace cutterflow::coupling
