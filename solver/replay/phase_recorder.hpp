#pragma once
/// \file Records the flow by rotor phase while it is solved.
#include <filesystem>

#include "solver/ports/communicator.hpp"
#include "solver/ports/settings.hpp"
#include "solver/replay/flow_recording.hpp"

namespace cutterflow::coupling {

/// Time means of the flow at the phases of a recording. A step's flow counts for the two phases that it lies between, in proportion to its
/// nearness and to the step's length: a flow that is linear in the angle is recorded as it is.
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

    void write(const std::filesystem::path& folder, const Communicator& communicator) const;
    /// Goes on from what `write` wrote on any number of ranks. \throws UserError  when it is of other settings or cells
    void restore(const std::filesystem::path& folder);

private:
    RecordSettings settings_;
    FlowRecording recording_;
};

}  // namespace cutterflow::coupling
