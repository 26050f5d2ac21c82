#pragma once
/// \file Records of a run, per step. CsvRecorder writes the files of docs/design/001-contracts.md; tests keep the rows.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <gsl/span>

#include "geometry/base/vec3.hpp"
#include "solver/observe/limiter_counts.hpp"
#include "solver/observe/momentum_balance.hpp"
#include "solver/observe/rock_account.hpp"
#include "solver/ports/dem_engine.hpp"

namespace cutterflow::coupling {

/// Fate of a rock: the last state of its centre.
enum class Fate { never_entered, in_cutter, spilled, sucked_up };
inline constexpr std::array<Fate, 4> k_fates{Fate::never_entered, Fate::in_cutter, Fate::spilled, Fate::sucked_up};
const char* fate_name(Fate fate);

enum class EventSurface { feed, head, mouth, domain, start, remove, extract };
enum class EventDirection { in, out };
const char* surface_name(EventSurface surface);
const char* direction_name(EventDirection direction);

/// A rock crosses a surface.
struct RockEvent {
    double time = 0.0;  ///< [s]
    int id = 0;
    EventSurface surface = EventSurface::feed;
    EventDirection direction = EventDirection::in;
    Vec3 position = Vec3::Zero();  ///< [m]
    Vec3 velocity = Vec3::Zero();  ///< [m/s]
    double rotor_angle = 0.0;      ///< [rad]
    double azimuth = 0.0;          ///< [rad], 0 = lowest
    double axial = 0.0;            ///< [m]
    double diameter = 0.0;         ///< [m]
    double density = 0.0;          ///< [kg/m3]
    std::string bin;               ///< of head events, else empty
};

/// One moment of the rocks' motion.
struct RunInstant {
    double time = 0.0;         ///< [s]
    double rotor_angle = 0.0;  ///< [rad]
};

/// The event of rock `p` at its present place.
RockEvent rock_event(EventSurface surface, EventDirection direction, const Rocks& rocks, std::size_t p, const RunInstant& now);

/// A rock of the feed that found no place when it was due.
struct RejectedRock {
    int id = 0;
    double time = 0.0;
    std::string reason;
};

/// A rock's centre crosses a gate.
struct GateRow {
    double time = 0.0;  ///< [s]
    std::string gate;
    int id = 0;
    int sense = 0;                 ///< +1 along the gate's normal, -1 against it
    Vec3 position = Vec3::Zero();  ///< [m]
    Vec3 velocity = Vec3::Zero();  ///< [m/s]
    double diameter = 0.0;         ///< [m]
    double mass = 0.0;             ///< [kg]
};

/// An extraction after a step.
struct ExtractionRow {
    double time = 0.0;       ///< [s]
    int event = 0;           ///< its number in the list of events, from 0
    double due = 0.0;        ///< rate times time so far [kg]
    double extracted = 0.0;  ///< so far [kg]
    int in_region = 0;       ///< rocks that could be taken
    bool starved = false;    ///< the next rock is due, or all are, and the region has none
};

struct CountAndMass {
    int count = 0;
    double mass = 0.0;  ///< [kg]
};

/// Placed rock by fate at one time.
struct FateTotals {
    CountAndMass placed;
    std::array<CountAndMass, 4> by_fate;  ///< indexed by Fate
    const CountAndMass& of(Fate fate) const { return by_fate[static_cast<std::size_t>(fate)]; }
    /// Share of the placed mass that is neither sucked up nor spilled; 1 when nothing was placed.
    double undecided() const;
};

/// Where the rock of the feed is, by mass [kg]. Each rock is in one place:
///   fed = owed + in_head + delivered + spilled_mixing + spilled_cutting + on_bed + left_behind_mixing + left_behind_cutting.
/// Spilled rock is within reach and may come back; what is left behind is lost for good.
struct RockLedger {
    double fed = 0.0;   ///< was due so far, or there at the start
    double owed = 0.0;  ///< was due and is not in: it found no place
    double in_head = 0.0;
    double delivered = 0.0;            ///< sucked up
    double spilled_mixing = 0.0;       ///< outside the head, after it had been mixed into the head's flow
    double spilled_cutting = 0.0;      ///< outside the head, thrown out where it was cut
    double on_bed = 0.0;               ///< outside the head, never having been in it; rock from a cut face starts inside
    double left_behind_mixing = 0.0;   ///< outside and so far off that it was taken out, after it had been mixed in
    double left_behind_cutting = 0.0;  ///< likewise, never mixed in

    double left_behind() const { return left_behind_mixing + left_behind_cutting; }
    double spilled() const { return spilled_mixing + spilled_cutting + left_behind(); }
    double held() const { return owed + in_head + on_bed; }  ///< neither delivered nor spilled
    /// |fed - sum of the others| / fed; infinite where there is rock and none was fed.
    double error() const;
};

/// Outcome of one rock.
struct RockOutcome {
    int id = 0;
    Fate fate = Fate::never_entered;
    std::string last_exit_bin;                                  ///< empty: never left the head
    std::optional<double> first_exit_time, first_exit_azimuth;  ///< [s], [rad]
    Vec3 position = Vec3::Zero();                               ///< last known [m]
    double diameter = 0.0;
    double density = 0.0;
};

struct LoadsRow {
    double time = 0.0, rotor_angle = 0.0;
    double torque_pressure = 0.0, torque_viscous = 0.0, torque_rock = 0.0;  ///< on the cutter about its axis, by the right hand [N m]
    double power = 0.0;                                                     ///< of the drive [W]
    std::optional<Vec3> soil_force{};                                       ///< of the water on the soil [N]
};

struct BalanceRow {
    double time = 0.0;
    double solid_volume_error = 0.0;  ///< |volume on the mesh - volume of rock| / volume of rock
    double deposit_error = 0.0;       ///< |momentum laid into cells - that of the rocks| / (sum |impulse| + carry)
    MomentumErrors momentum;
    double flow_balance_error = 0.0;  ///< (|net flow of open patches and interfaces| + flow through walls) / flow through open patches
    double interface_imbalance = 0.0;
    double interface_mismatch = 0.0;
    double domain_surplus = 0.0;
    int clipped_cells = 0;
    double continuity_error = 0.0;
    std::optional<double> outlet_flow, outlet_pressure;  ///< of the named outlet [m3/s], [m2/s2]
    double solid_fraction_max = 0.0;
    int overfull_cells = 0;
    LimiterCounts limited;
    double courant_max = 0.0;
    double speed_max = 0.0;  ///< of the fluid in a cell [m/s]
    double overlap_ratio_max = 0.0;
    int dem_substeps = 0, rocks = 0, contacts = 0;
    double exchanged_volume = 0.0;    ///< of fluid displaced by rock since the start, less fluid that replaced removed rock [m3]
    double exchanged_momentum = 0.0;  ///< amount of that fluid's momentum [N s]
};

/// Wall seconds of one step, largest rank.
struct CostRow {
    double time = 0.0, step = 0.0, fluid = 0.0, mesh_motion = 0.0, mapping = 0.0, dem = 0.0, output = 0.0;
};

/// Rocks at a field write.
struct RockPicture {
    double time = 0.0;
    gsl::span<const int> id;
    gsl::span<const Vec3> position, velocity;
    gsl::span<const double> diameter, density;
    gsl::span<const Vec3> hydrodynamic_force;         ///< drag and the Du/Dt parts, mean over the step [N]
    gsl::span<const Vec3> contact_force;              ///< of rock and steel, mean over the step [N]
    gsl::span<const Fate> fate;                       ///< empty when fates are not followed
    gsl::span<const int> frozen;                      ///< ids, sorted
    gsl::span<const int> shape;                       ///< as Rock::shape; empty when all rock is spheres
    gsl::span<const Eigen::Quaterniond> orientation;  ///< as Rock::orientation; empty with `shape`
};

/// An active sub-model, and why it is active.
struct ModelNote {
    std::string name, why;
};

/// Sums over the run, for cost.json.
struct RunCost {
    int ranks = 1;
    double cells = 0.0;
    int steps = 0;
    double wall = 0.0;  ///< [s]
    double core = 0.0;  ///< processor time of all ranks, user and system [s]
    CostRow totals;
};

class VelocitySets;

class RunRecorder {
public:
    virtual ~RunRecorder() = default;
    /// Opens the tables. What may refuse a start has passed by then, so that a refused one leaves those of an earlier one.
    virtual void begin() = 0;
    virtual void event(const RockEvent& event) = 0;
    virtual void rejected(const RejectedRock& rock) = 0;
    virtual void account(double time, const AccountTotals& totals) = 0;
    virtual void gate(const GateRow& row) = 0;
    virtual void extraction(const ExtractionRow& row) = 0;
    /// \param overlap_ratio  largest overlap over a rock's radius in the step
    virtual void contacts(double time, int contacts, double overlap_ratio) = 0;
    virtual void walls(double time, gsl::span<const WallForce> forces) = 0;
    virtual void fates(double time, const FateTotals& totals) = 0;
    virtual void ledger(double time, const RockLedger& ledger) = 0;
    /// \param radial_velocity  averaged over azimuth, one per axial bin [m/s] \param flux  outwards, as many [m3/s]
    virtual void outflow(double time, gsl::span<const double> radial_velocity, gsl::span<const double> flux) = 0;
    virtual void loads(const LoadsRow& row) = 0;
    virtual void balance(const BalanceRow& row) = 0;
    virtual void cost(const CostRow& row) = 0;
    virtual void picture(const RockPicture& picture) = 0;
    /// Work of rock on walls so far.
    virtual void wall_work(double time, gsl::span<const WallWork> works) = 0;
    /// Rewrites the table of outcomes.
    virtual void outcomes(gsl::span<const RockOutcome> outcomes) = 0;
    /// Rewrites the tables of averaged velocities. \param time  up to which they go [s]
    virtual void velocity(const VelocitySets& sets, double time) = 0;
    /// The last call: all rows are on the disk before the run counts as finished.
    virtual void finished(const RunCost& cost) = 0;
    /// A warning for the reader of the results, recorded once.
    virtual void warning(double time, const std::string& text) = 0;
    /// Writes all rows to the disk.
    virtual void flush() = 0;
};

/// Discards everything: for ranks that do not write.
class SilentRecorder : public RunRecorder {
public:
    void begin() override {}
    void event(const RockEvent&) override {}
    void rejected(const RejectedRock&) override {}
    void account(double, const AccountTotals&) override {}
    void gate(const GateRow&) override {}
    void extraction(const ExtractionRow&) override {}
    void contacts(double, int, double) override {}
    void walls(double, gsl::span<const WallForce>) override {}
    void fates(double, const FateTotals&) override {}
    void ledger(double, const RockLedger&) override {}
    void outflow(double, gsl::span<const double>, gsl::span<const double>) override {}
    void loads(const LoadsRow&) override {}
    void balance(const BalanceRow&) override {}
    void cost(const CostRow&) override {}
    void picture(const RockPicture&) override {}
    void wall_work(double, gsl::span<const WallWork>) override {}
    void outcomes(gsl::span<const RockOutcome>) override {}
    void velocity(const VelocitySets&, double) override {}
    void finished(const RunCost&) override {}
    void warning(double, const std::string&) override {}
    void flush() override {}
};

}  // namespace cutterflow::coupling
