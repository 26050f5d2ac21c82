#pragma once
/// \file Fates, crossings and last exits of every rock, decided from the motion of its centre.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geometry/head/axial_bins.hpp"
#include "geometry/head/contour.hpp"
#include "solver/observe/run_recorder.hpp"
#include "solver/ports/dem_engine.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::coupling {

/// Columns of RockLedger that a placed rock may stand in.
enum class RockPlace { in_head, delivered, spilled_mixing, spilled_cutting, on_bed, left_behind_mixing, left_behind_cutting };

/// State of one placed rock. Plain numbers: a checkpoint writes it out.
struct TrackedRock {
    int id = 0;
    double diameter = 0.0, density = 0.0;
    Vec3 position = Vec3::Zero();  ///< last known [m]
    bool in_run = true;            ///< false once it left the domain
    bool inside = false;           ///< in the head's volume, with hysteresis
    bool was_inside = false;       ///< has been in it at some time
    bool sucked_up = false;        ///< final
    bool mixed = false;            ///< has been in the head's flow: not only where it was cut
    bool left_behind = false;      ///< outside and far off; final
    double start_distance = 0.0;   ///< signed, to the head's volume, where it came in [m]
    std::optional<std::size_t> last_exit_bin;
    std::optional<double> first_exit_time, first_exit_azimuth;  ///< [s], [rad]

    Fate fate() const;
    RockPlace place() const;
    double mass() const;
};

/// The ledger of rock that was fed. What is still in the run counts by the rocks of the DEM: one that it lost is missing.
/// \param rocks  ever placed, by id
RockLedger ledger_of(const std::map<int, TrackedRock>& rocks, const Rocks& present, double fed, double owed);

/// Follows every rock. The head's volume is that of geometry::Contour, joined with the mouth and the pipe behind it, so that rock on its
/// way up the pipe has not left. A rock changes sides once its centre is `hysteresis` diameters beyond the boundary; the event is placed
/// where it passes that distance, interpolated linearly within the step. A rock that starts within the volume counts as having been in it.
///
/// Rock of a batch that is in the volume is mixed. Rock from a cut face starts just within the contour: it is mixed once it has come
/// `hysteresis` diameters deeper than it started; if it leaves without, it was spilled by cutting. Rock that is left behind keeps its
/// cause.
class FateTracker {
public:
    FateTracker(const FateSettings& settings, geometry::Contour contour);

    const std::vector<geometry::AxialBin>& bins() const { return bins_; }

    /// Adds a rock. \return its feed event
    RockEvent place(int id, double diameter, double density, const Vec3& position, const Vec3& velocity, const RunInstant& now);

    /// Updates the rocks' positions. \return crossings in order of time
    std::vector<RockEvent> move(const Rocks& rocks, const RunInstant& before, const RunInstant& after);

    /// A rock left the domain at `position`; inside the suction pipe that is sucked up. \return its events
    std::vector<RockEvent> leave(int id, const Vec3& position, const Vec3& velocity, const RunInstant& before, const RunInstant& after);

    /// Rocks in the run that are decided and need not be followed any more: sucked up, left behind.
    std::vector<int> finished() const;
    /// They are out of the run. \return their events
    std::vector<RockEvent> take_out(gsl::span<const int> ids, const Rocks& present, const RunInstant& now);

    FateTotals totals() const;
    std::vector<RockOutcome> outcomes() const;
    Fate fate_of(int id) const { return rocks_.at(id).fate(); }

    /// All rocks ever placed, by id; what a checkpoint keeps.
    const std::map<int, TrackedRock>& rocks() const { return rocks_; }
    void restore(std::map<int, TrackedRock> rocks) { rocks_ = std::move(rocks); }

    /// Signed distance [m] to the head's volume with mouth and pipe; negative inside.
    double signed_distance(const Vec3& position) const;

private:
    /// Position of a point relative to the mouth's axis [m].
    struct PipePlace {
        double depth, radius;
    };
    PipePlace place_in_pipe(const Vec3& position) const;
    bool is_left_behind(const Vec3& position, double distance) const;
    std::vector<RockEvent> follow(TrackedRock& rock, const Vec3& position, const Vec3& velocity, const RunInstant& before,
                                  const RunInstant& after);
    RockEvent event(const TrackedRock& rock, EventSurface surface, EventDirection direction, const Vec3& position, const Vec3& velocity,
                    const RunInstant& moment) const;

    FateSettings settings_;
    geometry::Contour contour_;
    std::vector<geometry::AxialBin> bins_;
    Vec3 pipe_direction_;
    double pipe_start_;  // depth at which pipe and head overlap
    std::map<int, TrackedRock> rocks_;
};

}  // namespace cutterflow::coupling
