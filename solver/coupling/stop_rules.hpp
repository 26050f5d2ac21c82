#pragma once
/// \file Rules by which a run of rock ends: rock is at rest, or nothing or little crosses a gate.
#include <optional>
#include <string>
#include <vector>

#include "solver/ports/bed_operations.hpp"
#include "solver/ports/dem_engine.hpp"

namespace cutterflow::coupling {

/// Rock that crossed the gate of BelowSettings.
struct Passage {
    double time = 0.0;  ///< [s]
    double mass = 0.0;  ///< positive along the gate's normal [kg]
};

/// Kept in a checkpoint. Times [s].
struct StopState {
    std::optional<double> at_rest_since;
    std::optional<double> last_crossing;  ///< of the gate of IdleSettings, or the run's start
    std::optional<double> counted_since;  ///< from when on `passed` is complete, but for what is older than the window
    std::vector<Passage> passed{};
};

/// How much a bed moves. Both are 0 without rock that could.
struct Restlessness {
    double energy = 0.0;  ///< mean of v^2/(2 g d) [-]
    double speed = 0.0;   ///< largest v/sqrt(g d) [-]
};

/// Of the rocks that are not frozen, without their spin. \param gravity  > 0 [m/s2]
Restlessness restlessness(const Rocks& rocks, const std::vector<int>& frozen, double gravity);

class StopRules {
public:
    StopRules() = default;
    StopRules(std::optional<AtRestSettings> at_rest, std::optional<IdleSettings> idle, std::optional<BelowSettings> below,
              double start_time)
        : at_rest_(std::move(at_rest)), idle_(std::move(idle)), below_(std::move(below)), state_{{}, start_time, start_time} {}

    bool watches_rest() const { return at_rest_.has_value(); }
    void note_rest(double time, const Restlessness& now);
    /// \param mass  positive along the gate's normal [kg]
    void note_crossing(double time, const std::string& gate, double mass);

    /// Whether rock has been at rest for long enough at `time` [s].
    bool at_rest(double time) const;
    /// Whether the gate has been idle for long enough.
    bool idle(double time) const;
    /// Whether less than the rate passed in the last window; not before the run has lasted so long.
    bool below(double time) const;

    const StopState& state() const { return state_; }
    void restore(const StopState& state);

private:
    std::optional<AtRestSettings> at_rest_;
    std::optional<IdleSettings> idle_;
    std::optional<BelowSettings> below_;
    StopState state_;
};

}  // namespace cutterflow::coupling
