#pragma once
/// \file Time steps of a run whose fluid is not solved.
#include <optional>
#include <string>

namespace cutterflow::coupling {

/// When a run without a fluid solver runs.
struct ClockTimes {
    double start = 0.0, end = 0.0;         ///< [s]
    std::optional<double> write_interval;  ///< of pictures [s]
};

/// Steps of equal length that meet the pictures, the end and the times at which rock comes in.
class RunClock {
public:
    /// \param longest_step  [s], > 0
    RunClock(const ClockTimes& times, double longest_step)
        : times_(times), longest_step_(longest_step), time_(times.start), step_(longest_step) {}

    double time() const { return time_; }  ///< [s]
    double step() const { return step_; }  ///< the last one; before the first the longest [s]
    std::string time_name() const;
    bool running() const;
    /// Goes one step on, at most `limit` and not beyond `stop_time` [s].
    void advance(double limit, double stop_time);
    /// Whether a picture is due now.
    bool write_is_due() const;

private:
    double next_write_time() const;

    ClockTimes times_;
    double longest_step_;
    double time_;
    double step_;
};

}  // namespace cutterflow::coupling
