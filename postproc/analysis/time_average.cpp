#include "postproc/analysis/time_average.hpp"

#include <algorithm>
#include <cmath>

namespace cutterflow::postproc {
namespace {

/// Start of the step of value i.
double step_start(const std::vector<double>& times, std::size_t i) {
    if (i > 0) return times[i - 1];
    return times.size() > 1 ? 2.0 * times[0] - times[1] : times[0];
}

struct Integral {
    double value = 0.0;
    double duration = 0.0;
    int steps = 0;
};

Integral integrate(const std::vector<double>& times, const std::vector<double>& values, double start, double end) {
    Integral sum;
    const auto first = std::upper_bound(times.begin(), times.end(), start);
    for (auto i = static_cast<std::size_t>(first - times.begin()); i < times.size(); ++i) {
        const double from = std::max(step_start(times, i), start);
        const double to = std::min(times[i], end);
        if (to <= from) break;
        sum.value += values[i] * (to - from);
        sum.duration += to - from;
        ++sum.steps;
    }
    return sum;
}

std::optional<double> batch_error(const std::vector<double>& times, const std::vector<double>& values, double start, double end,
                                  double period) {
    // A thousandth of a period short still counts as whole: the run's end is a sum of time steps.
    const double periods = std::floor((end - start) / period + 1e-3);
    if (!(periods >= k_fewest_batches && std::isfinite(periods))) return std::nullopt;
    const double periods_per_batch = std::max(1.0, std::floor(periods / k_batches));
    const int batches = static_cast<int>(periods / periods_per_batch);
    const double width = periods_per_batch * period;
    std::vector<double> means;
    for (int batch = batches; batch > 0; --batch) {
        const Integral part = integrate(times, values, std::max(start, end - batch * width), end - (batch - 1) * width);
        if (part.steps < k_steps_per_batch) return std::nullopt;
        means.push_back(part.value / part.duration);
    }
    double mean = 0.0;
    for (const double value : means) mean += value / batches;
    double variance = 0.0;
    for (const double value : means) variance += (value - mean) * (value - mean) / (batches - 1);
    return std::sqrt(variance / batches);
}

}  // namespace

std::optional<TimeAverage> time_average(const std::vector<double>& times, const std::vector<double>& values, double start, double end,
                                        double period) {
    if (times.empty()) return std::nullopt;
    const double from = std::max(start, step_start(times, 0));
    const double to = std::min(end, times.back());
    const Integral whole = integrate(times, values, from, to);
    if (!(whole.duration > 0.0)) return std::nullopt;
    return TimeAverage{whole.value / whole.duration, batch_error(times, values, from, to, period), from, to};
}

}  // namespace cutterflow::postproc
