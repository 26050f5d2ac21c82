#include "solver/replay/run_clock.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace cutterflow::coupling {
namespace {

/// Times are sums of steps: this share of a step or of an interval is rounding.
constexpr double k_time_tolerance = 1e-6;

}  // namespace

std::string RunClock::time_name() const {
    return fmt::format("{:.9g}", time_);
}

bool RunClock::running() const {
    return times_.end - time_ > k_time_tolerance * longest_step_;
}

/// The next multiple of the write interval, or the end when that is earlier.
double RunClock::next_write_time() const {
    if (!times_.write_interval) return times_.end;
    const double interval = *times_.write_interval;
    return std::min(times_.end, interval * (std::floor(time_ / interval + k_time_tolerance) + 1.0));
}

void RunClock::advance(double limit, double stop_time) {
    const double ahead = std::min(next_write_time(), stop_time) - time_;
    const double longest = std::min(longest_step_, limit);
    step_ = ahead / std::max(1.0, std::ceil(ahead / longest - k_time_tolerance));
    time_ += step_;
}

bool RunClock::write_is_due() const {
    if (!times_.write_interval) return false;
    const double intervals = time_ / *times_.write_interval;
    return std::abs(intervals - std::round(intervals)) <= k_time_tolerance;
}

}  // namespace cutterflow::coupling
