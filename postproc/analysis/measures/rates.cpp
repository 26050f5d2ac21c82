#include "postproc/analysis/measures/rates.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/base/statistics/sample.hpp"
#include "postproc/analysis/measures/line_fit.hpp"

namespace cutterflow::postproc {

namespace {

constexpr int k_samples = 1000;              ///< of the line's fit
constexpr double k_random_walk = 6.0 / 5.0;  ///< variance of the least-squares slope of a random walk over that of its end points

}  // namespace

double PassedMass::at(double when) const {
    const auto after = std::upper_bound(time.begin(), time.end(), when);
    if (after == time.begin()) return 0.0;
    const auto n = static_cast<std::size_t>(after - time.begin());
    if (steps || n == time.size()) return mass[n - 1];
    const double share = (when - time[n - 1]) / (time[n] - time[n - 1]);
    return mass[n - 1] + share * (mass[n] - mass[n - 1]);
}

std::optional<double> time_when(const PassedMass& passed, double mass) {
    for (std::size_t n = 0; n < passed.time.size(); ++n) {
        if (passed.mass[n] < mass) continue;
        if (passed.steps || n == 0) return passed.time[n];
        const double share = (mass - passed.mass[n - 1]) / (passed.mass[n] - passed.mass[n - 1]);
        return passed.time[n - 1] + share * (passed.time[n] - passed.time[n - 1]);
    }
    return std::nullopt;
}

Rate rate_in(const PassedMass& passed, double from, double to) {
    std::vector<double> times, masses;
    for (int n = 0; n < k_samples; ++n) {
        times.push_back(from + (n + 0.5) / k_samples * (to - from));
        masses.push_back(passed.at(times.back()));
    }
    const LineFit line = fit_line(times, masses);
    Rate rate{line.slope, std::nullopt, 0.0, line.intercept, from, to};
    const auto inside = std::count_if(passed.time.begin(), passed.time.end(), [&](double time) { return time > from && time <= to; });
    const int stretches = static_cast<int>(std::min<std::ptrdiff_t>(k_stretches, inside));
    if (stretches < k_fewest_stretches) return rate;
    std::vector<double> slopes;
    const double length = (to - from) / stretches;
    for (int n = 0; n < stretches; ++n) slopes.push_back((passed.at(from + (n + 1) * length) - passed.at(from + n * length)) / length);
    const Sample sample = sample_of(slopes);
    rate.standard_error = std::sqrt(k_random_walk * sample.variance / stretches);
    rate.half_interval = std::sqrt(k_random_walk) * half_interval(sample);
    return rate;
}

std::optional<std::pair<double, double>> middle_half(const PassedMass& passed) {
    if (passed.total() <= 0.0) return std::nullopt;
    const auto from = time_when(passed, 0.25 * passed.total()), to = time_when(passed, 0.75 * passed.total());
    if (!from || !to || *from >= *to) return std::nullopt;
    return std::pair{*from, *to};
}

}  // namespace cutterflow::postproc
