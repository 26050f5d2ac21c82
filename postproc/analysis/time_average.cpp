#include "postproc/analysis/time_average.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/base/statistics/sample.hpp"

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

/// Means over equal stretches; none when there are too few of them.
std::optional<Sample> batch_means(const std::vector<double>& times, const std::vector<double>& values, double start, double end,
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
    return sample_of(means);
}

}  // namespace

std::optional<TimeAverage> time_average(const std::vector<double>& times, const std::vector<double>& values, double start, double end,
                                        double period) {
    if (times.empty()) return std::nullopt;
    const double from = std::max(start, step_start(times, 0));
    const double to = std::min(end, times.back());
    const Integral whole = integrate(times, values, from, to);
    if (!(whole.duration > 0.0)) return std::nullopt;
    TimeAverage average{whole.value / whole.duration, std::nullopt, std::nullopt, from, to};
    if (const std::optional<Sample> batches = batch_means(times, values, from, to, period)) {
        average.standard_error = standard_error(*batches);
        average.half_interval = half_interval(*batches);
    }
    return average;
}

}  // namespace cutterflow::postproc
