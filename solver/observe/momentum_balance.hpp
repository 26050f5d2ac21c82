#pragma once
/// \file Balance of the momentum of rock and fluid over a step, from their states.
#include <gsl/span>

#include "solver/ports/communicator.hpp"
#include "solver/ports/dem_engine.hpp"
#include "solver/ports/fluid_engine.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::coupling {

/// What a step did to momentum, over its turnover: the sum over all rocks of |impulse of the fluid| + |impulse of weight less buoyancy|.
struct MomentumErrors {
    double error = 0.0;            ///< |gain of rock, fluid and carry - impulses from outside - interface - replaced - turned|
    double interface_error = 0.0;  ///< |FluidLoads::interface_impulse|
    double replaced = 0.0;         ///< |FluidLoads::replaced_momentum|
    double turned = 0.0;           ///< |FluidLoads::turned_momentum|
    double carried = 0.0;          ///< |sum of what the fluid has yet to receive|: it grows without end where the fluid takes nothing
    double boundary = 0.0;         ///< |FluidLoads::boundary_impulse|: 0 where the fluid has no boundary
};

/// Balance of
///   P = sum_p m_p v_p + rho_f sum_c V_c (alpha_c u_c + carry_c)                                            [N s]
/// over a step, from velocities, void fractions and carry before and after it. From outside come the impulses of contacts (those between
/// rocks cancel) and weight on rock, and of the boundary on the fluid. Nothing enters that an engine says of what it exchanged with the
/// other. All errors are 0 while there is no turnover.
class MomentumBalance {
public:
    MomentumBalance(const FluidProperties& properties, const FluidEngine& fluid, const DemEngine& dem, Communicator& communicator)
        : properties_(properties), fluid_(fluid), dem_(dem), communicator_(communicator) {}

    /// Takes the state before the step. \param carry  momentum per mixture volume over density, per cell [m/s]
    void begin(gsl::span<const Vec3> carry);

    /// Compares with the state after the step. Collective.
    MomentumErrors end(gsl::span<const Vec3> carry, const DemStep& rock, const FluidLoads& loads);

private:
    Vec3 momentum_of_fluid() const;
    Vec3 momentum_of_carry(gsl::span<const Vec3> carry) const;

    FluidProperties properties_;
    const FluidEngine& fluid_;
    const DemEngine& dem_;
    Communicator& communicator_;
    Vec3 rock_before_ = Vec3::Zero();
    Vec3 fluid_before_ = Vec3::Zero(), carry_before_ = Vec3::Zero();  // this rank's share
};

}  // namespace cutterflow::coupling
