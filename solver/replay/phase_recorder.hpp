#pragma once
/// \file Records the flow by rotor phase while it is solved.
#include <filesystem>

#include "solver/ports/communicator.hpp"
#include "solver/ports/settings.hpp"
#include "solver/replay/flow_recording.hpp"

namespace cutterflow::coupling {

/// Time means of the flow at the phases of a recording. A step's flow counts for the two phases that it lies between, in proportion to its
/// nearness and to the step's length: a flow that is linear in the angle is recorded as it is.
///
/// A flow that has developed is the same after each revolution. Of one that is recorded over a revolution or more the change is told, of
/// the turning cells from the first sample to the one a revolution later, to a step's angle: sqrt(sum V |du|^2 / sum V |u|^2).
class PhaseRecorder {
public:
    /// \throws UserError  when not exactly one zone turns. Collective.
    PhaseRecorder(const RecordSettings& settings, const FluidEngine& fluid);

    /// Takes the present flow when its time is in the interval.
    void sample(const FluidEngine& fluid);

    /// Whether the time is past the interval's end.
    bool is_over(double time) const { return time >= settings_.end_time; }
    /// Whether every phase has been seen.
    bool is_complete() const;

    /// Adds up the change of all ranks, once the interval is over; none when it was shorter than a revolution or a run was resumed in it.
    /// Collective. \return it [-]
    std::optional<double> tell_change(Communicator& communicator);

    void write(const std::filesystem::path& folder, const Communicator& communicator) const;
    /// Goes on from what `write` wrote on any number of ranks. \throws UserError  when it is of other settings or cells
    void restore(const std::filesystem::path& folder);

private:
    /// Sums over this rank's turning cells, by volume [m5/s2].
    struct Change {
        double squares = 0.0, of_differences = 0.0;
    };
    std::vector<Vec3> turning_velocity(const FluidEngine& fluid, const Eigen::Matrix3d& into_rotor) const;
    bool has_samples() const;
    void follow_change(const FluidEngine& fluid, double angle, const Eigen::Matrix3d& into_rotor);

    RecordSettings settings_;
    FlowRecording recording_;
    std::vector<Vec3> first_;            // velocity of turning cells in the rotor's frame at the first sample
    std::optional<double> first_angle_;  // of the rotor [rad]
    std::optional<Change> change_;
};

}  // namespace cutterflow::coupling
