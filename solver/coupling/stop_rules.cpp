#include "solver/coupling/stop_rules.hpp"

#include <algorithm>
#include <cmath>

namespace cutterflow::coupling {
namespace {

constexpr double k_rounding = 1e-9;  // of times that are sums of steps [s]

}  // namespace

Restlessness restlessness(const Rocks& rocks, const std::vector<int>& frozen, double gravity) {
    Restlessness sum;
    int moving = 0;
    for (std::size_t p = 0; p < rocks.size(); ++p) {
        if (std::binary_search(frozen.begin(), frozen.end(), rocks.id[p])) continue;
        const double d = rocks.diameter[p];
        sum.energy += 0.5 * rocks.velocity[p].squaredNorm() / (gravity * d);
        sum.speed = std::max(sum.speed, rocks.velocity[p].norm() / std::sqrt(gravity * d));
        ++moving;
    }
    if (moving > 0) sum.energy /= moving;
    return sum;
}

void StopRules::note_rest(double time, const Restlessness& now) {
    if (!at_rest_) return;
    if (now.energy > at_rest_->energy || now.speed > at_rest_->speed)
        state_.at_rest_since.reset();
    else if (!state_.at_rest_since)
        state_.at_rest_since = time;
}

void StopRules::note_crossing(double time, const std::string& gate, double mass) {
    if (idle_ && idle_->gate == gate) state_.last_crossing = time;
    if (!below_ || below_->gate != gate) return;
    std::vector<Passage>& passed = state_.passed;
    passed.erase(std::remove_if(passed.begin(), passed.end(), [&](const Passage& one) { return one.time < time - below_->window; }),
                 passed.end());
    passed.push_back({time, mass});
}

bool StopRules::at_rest(double time) const {
    if (!at_rest_ || !state_.at_rest_since || time < at_rest_->from - k_rounding) return false;
    return time - *state_.at_rest_since >= at_rest_->hold - k_rounding;
}

bool StopRules::idle(double time) const {
    return idle_ && time - state_.last_crossing.value_or(time) >= idle_->duration - k_rounding;
}

bool StopRules::below(double time) const {
    if (!below_ || time - state_.counted_since.value_or(time) < below_->window - k_rounding) return false;
    double mass = 0.0;
    for (const Passage& one : state_.passed)
        if (one.time > time - below_->window) mass += one.mass;
    return std::abs(mass) < below_->rate * below_->window;
}

/// A checkpoint of an earlier version has not counted: this run does from its own start on.
void StopRules::restore(const StopState& state) {
    const std::optional<double> start = state_.counted_since;
    state_ = state;
    if (!state_.counted_since) state_.counted_since = start;
}

}  // namespace cutterflow::coupling
