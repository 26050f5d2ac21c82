#include "geometry/base/statistics/production.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "geometry/base/statistics/sample.hpp"

namespace cutterflow {
namespace {

constexpr std::size_t k_values_per_group = 5;  // of MSER-5
constexpr double k_rounding = 1e-12;
constexpr double k_largest_drift = 0.1;                                                    // of hold-up between windows of the start-up
constexpr double k_shortest_window = 1.5, k_shortest_start = 3.0, k_shortest_batch = 1.0;  // [s]
constexpr double k_revolutions_of_start = 2.0;
constexpr double k_largest_correlation = 0.3;
constexpr std::size_t k_fewest_batches = 8;
constexpr double k_steady_change = 0.05;  // of hold-up, over what was fed
constexpr std::size_t k_intervals_per_batch = 10;

/// Linear between the times of a series; the end values outside.
double at(const std::vector<double>& times, const std::vector<double>& values, double time) {
    const auto after = std::lower_bound(times.begin(), times.end(), time);
    if (after == times.begin()) return values.front();
    if (after == times.end()) return values.back();
    const auto i = static_cast<std::size_t>(after - times.begin());
    const double share = (time - times[i - 1]) / (times[i] - times[i - 1]);
    return values[i - 1] + share * (values[i] - values[i - 1]);
}

/// What a growing series gained in equal intervals from `from` on, as many as end by `to`.
std::vector<double> gains(const std::vector<double>& times, const std::vector<double>& values, double from, double to, double interval) {
    std::vector<double> gained;
    const auto count = static_cast<std::size_t>((to - from) / interval * (1.0 + 1e-12));
    for (std::size_t i = 0; i < count; ++i) {
        const double start = from + static_cast<double>(i) * interval;
        gained.push_back(at(times, values, start + interval) - at(times, values, start));
    }
    return gained;
}

double lag1_correlation(const std::vector<double>& values) {
    const double mean = sample_of(values).mean;
    double product = 0.0, square = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        square += (values[i] - mean) * (values[i] - mean);
        if (i > 0) product += (values[i] - mean) * (values[i - 1] - mean);
    }
    return square > 0.0 ? product / square : 0.0;
}

/// Means of `size` values each; what is over at the beginning is left out.
std::vector<double> means_of(const std::vector<double>& values, std::size_t size) {
    std::vector<double> means;
    for (std::size_t first = values.size() % size; first < values.size(); first += size)
        means.push_back(std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(first),
                                        values.begin() + static_cast<std::ptrdiff_t>(first + size), 0.0) /
                        static_cast<double>(size));
    return means;
}

/// When hold-up has settled; none when it does not up to `last` [s].
std::optional<double> settled(const ProductionSeries& series, double begin, double last, double revolution) {
    const double window = std::max(revolution, k_shortest_window);
    for (double end = begin + std::max(2.0 * window, std::max(k_revolutions_of_start * revolution, k_shortest_start));
         end <= last * (1.0 + 1e-12); end += 0.1 * window) {
        const double before = mean_over(series.time, series.held, end - 2.0 * window, end - window);
        const double after = mean_over(series.time, series.held, end - window, end);
        if (std::abs(after - before) <= k_largest_drift * std::max(before, after)) return end;
    }
    return std::nullopt;
}

/// The first time at which anything was fed.
std::optional<double> first_fed(const ProductionSeries& series) {
    const auto fed = std::find_if(series.fed.begin(), series.fed.end(), [](double mass) { return mass > 0.0; });
    if (fed == series.fed.end()) return std::nullopt;
    return series.time[static_cast<std::size_t>(fed - series.fed.begin())];
}

/// The last time at which anything was fed, when nothing came since for twice as long as ever between two times; the end of the series
/// otherwise.
double feed_end(const ProductionSeries& series) {
    std::optional<double> last;
    double longest = 0.0;
    for (std::size_t i = 1; i < series.time.size(); ++i) {
        if (!(series.fed[i] > series.fed[i - 1])) continue;
        if (last) longest = std::max(longest, series.time[i] - *last);
        last = series.time[i];
    }
    const bool ended = longest > 0.0 && series.time.back() - *last > 2.0 * longest;
    return ended ? *last : series.time.back();
}

}  // namespace

std::size_t mser5_truncation(const std::vector<double>& values) {
    const std::size_t groups = values.size() / k_values_per_group;
    std::vector<double> means;
    for (std::size_t i = 0; i < groups; ++i)
        means.push_back(std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(i * k_values_per_group),
                                        values.begin() + static_cast<std::ptrdiff_t>((i + 1) * k_values_per_group), 0.0) /
                        static_cast<double>(k_values_per_group));
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t dropped = 0; 2 * dropped < groups; ++dropped) {
        const std::vector<double> rest(means.begin() + static_cast<std::ptrdiff_t>(dropped), means.end());
        const double mean = sample_of(rest).mean;
        double squares = 0.0;
        for (const double value : rest) squares += (value - mean) * (value - mean);
        if (squares <= static_cast<double>(rest.size()) * std::pow(k_rounding * mean, 2)) return dropped * k_values_per_group;
        const double error = squares / std::pow(static_cast<double>(rest.size()), 2);
        if (error >= least) continue;
        least = error;
        best = dropped;
    }
    return best * k_values_per_group;
}

std::optional<BatchMeans> batch_means(const std::vector<double>& values, std::size_t shortest) {
    for (std::size_t size = shortest; values.size() / size >= k_fewest_batches; size *= 2) {
        const std::vector<double> means = means_of(values, size);
        const double correlation = lag1_correlation(means);
        if (correlation >= k_largest_correlation) continue;
        const Sample sample = sample_of(means);
        return BatchMeans{sample.mean, half_interval(sample), means.size(), size, correlation};
    }
    return std::nullopt;
}

double gain_over(const std::vector<double>& times, const std::vector<double>& values, double from, double to) {
    return at(times, values, to) - at(times, values, from);
}

double mean_over(const std::vector<double>& times, const std::vector<double>& values, double from, double to) {
    std::vector<double> nodes{from};
    for (const double time : times)
        if (time > from && time < to) nodes.push_back(time);
    nodes.push_back(to);
    double integral = 0.0;
    for (std::size_t i = 1; i < nodes.size(); ++i)
        integral += 0.5 * (at(times, values, nodes[i - 1]) + at(times, values, nodes[i])) * (nodes[i] - nodes[i - 1]);
    return integral / (to - from);
}

double longest_time_above(const std::vector<double>& time, const std::vector<double>& values, double limit) {
    double longest = 0.0;
    std::optional<double> since;
    for (std::size_t i = 0; i < time.size(); ++i) {
        if (values[i] <= limit) {
            since.reset();
            continue;
        }
        if (!since) since = time[i];
        longest = std::max(longest, time[i] - *since);
    }
    return longest;
}

double shortest_fed_time(double revolution) {
    return std::max(k_revolutions_of_start * revolution, k_shortest_start) +
           static_cast<double>(k_fewest_batches) * std::max(revolution, k_shortest_batch);
}

std::optional<Production> production_of(const ProductionSeries& series, double revolution) {
    const std::optional<double> begin = first_fed(series);
    if (!begin) return std::nullopt;
    const double end = feed_end(series);
    const double batch = std::max(revolution, k_shortest_batch);
    const double interval = batch / static_cast<double>(k_intervals_per_batch);

    Production production;
    production.start = settled(series, *begin, end, revolution);
    double from = production.start.value_or(std::min(end, *begin + std::max(k_revolutions_of_start * revolution, k_shortest_start)));
    const std::size_t dropped = mser5_truncation(gains(series.time, series.delivered, *begin, end, interval));
    from = std::max(from, *begin + static_cast<double>(dropped) * interval);
    if (production.start) production.start = from;

    const double revolutions = std::floor((end - from) / revolution * (1.0 + 1e-12));
    if (revolutions < 1.0) return std::nullopt;
    production.to = end;
    production.from = end - revolutions * revolution;
    const auto gain = [&](const std::vector<double>& values) { return gain_over(series.time, values, production.from, production.to); };
    production.fed = gain(series.fed);
    if (!(production.fed > 0.0)) return std::nullopt;
    production.delivered = gain(series.delivered);
    production.spilled = gain(series.spilled);
    production.held_change = gain(series.held);
    production.held = mean_over(series.time, series.held, production.from, production.to);
    production.is_steady = production.start.has_value() && std::abs(production.held_change) < k_steady_change * production.fed;
    production.undelivered = 1.0 - production.delivered / production.fed;
    // Hold-up that falls is spilled and delivered beside what comes in.
    std::tie(production.spillage_min, production.spillage_max) = std::minmax({production.spilled / production.fed, production.undelivered});

    std::vector<double> shares = gains(series.time, series.delivered, production.from, production.to, interval);
    for (double& share : shares) share /= production.fed * interval / (production.to - production.from);
    production.share = batch_means(shares, k_intervals_per_batch);
    return production;
}

}  // namespace cutterflow
