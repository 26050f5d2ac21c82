#include "postproc/analysis/measures/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include <fmt/format.h>
#include <boost/math/distributions/chi_squared.hpp>
#include <unsupported/Eigen/FFT>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/statistics/sample.hpp"

namespace cutterflow::postproc {

namespace {

constexpr std::size_t k_fewest_values = 16;
constexpr std::size_t k_padding = 4;    ///< at least so many times the segment, so that lines lie dense about a peak
constexpr std::size_t k_main_lobe = 2;  ///< half width of the main lobe of Hann's window, in 1 over the segment's length
constexpr double k_false_alarm = 0.01;

std::vector<double> equally_sampled(const std::vector<double>& times, const std::vector<double>& values) {
    const std::size_t n = times.size();
    std::vector<double> samples;
    std::size_t at = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double when = times.front() + static_cast<double>(i) / static_cast<double>(n - 1) * (times.back() - times.front());
        while (at + 2 < n && times[at + 1] < when) ++at;
        const double share = (when - times[at]) / (times[at + 1] - times[at]);
        samples.push_back(values[at] + share * (values[at + 1] - values[at]));
    }
    return samples;
}

std::size_t power_of_two(std::size_t least) {
    std::size_t n = 1;
    while (n < least) n *= 2;
    return n;
}

/// One-sided density of a segment less its mean, under Hann's window.
std::vector<double> periodogram(const double* values, std::size_t length, double interval) {
    const double mean = std::accumulate(values, values + length, 0.0) / static_cast<double>(length);
    std::vector<double> padded(power_of_two(k_padding * length), 0.0);
    double squares = 0.0;
    for (std::size_t i = 0; i < length; ++i) {
        const double window = 0.5 - 0.5 * std::cos(2.0 * k_pi * (static_cast<double>(i) + 0.5) / static_cast<double>(length));
        padded[i] = window * (values[i] - mean);
        squares += window * window;
    }
    std::vector<std::complex<double>> transform;
    Eigen::FFT<double> fft;
    fft.fwd(transform, padded);
    std::vector<double> power;
    for (std::size_t k = 0; k <= padded.size() / 2; ++k) power.push_back(2.0 * std::norm(transform[k]) * interval / squares);
    return power;
}

/// The first of the highest lines in [from, to).
std::size_t highest_line(const std::vector<double>& power, std::size_t from, std::size_t to) {
    const auto highest =
        std::max_element(power.begin() + static_cast<std::ptrdiff_t>(from), power.begin() + static_cast<std::ptrdiff_t>(to));
    return static_cast<std::size_t>(highest - power.begin());
}

bool is_local_maximum(const std::vector<double>& power, std::size_t k) {
    return (k == 0 || power[k] >= power[k - 1]) && (k + 1 >= power.size() || power[k] >= power[k + 1]);
}

/// Place of a line's peak between lines, at most half a line away; the line itself where power rises beyond it.
double peak_about(const std::vector<double>& power, std::size_t k) {
    const auto line = static_cast<double>(k);
    if (k == 0 || k + 1 >= power.size() || !is_local_maximum(power, k) || power[k - 1] <= 0.0 || power[k + 1] <= 0.0) return line;
    const double left = std::log(power[k - 1]), middle = std::log(power[k]), right = std::log(power[k + 1]);
    const double curvature = left - 2.0 * middle + right;
    return line + (curvature < 0.0 ? 0.5 * (left - right) / curvature : 0.0);
}

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

Spectrum spectrum_of(const std::vector<double>& times, const std::vector<double>& values, int segments) {
    const std::size_t n = times.size(), length = 2 * n / static_cast<std::size_t>(segments + 1);
    if (length < k_fewest_values)
        throw UserError(fmt::format("{} values for {} segments of a spectrum", n, segments),
                        fmt::format("A segment needs {} values", k_fewest_values), "Take a longer window or fewer segments");
    const std::vector<double> samples = equally_sampled(times, values);
    const double interval = (times.back() - times.front()) / static_cast<double>(n - 1);
    std::vector<std::vector<double>> parts;
    for (int s = 0; s < segments; ++s) {
        const std::size_t start = segments == 1 ? 0 : (n - length) * static_cast<std::size_t>(s) / static_cast<std::size_t>(segments - 1);
        parts.push_back(periodogram(samples.data() + start, length, interval));
    }
    Spectrum spectrum;
    spectrum.power.assign(parts.front().size(), 0.0);
    const double line = 1.0 / (interval * static_cast<double>(2 * (spectrum.power.size() - 1)));
    const auto lobe = static_cast<std::size_t>(std::ceil(k_main_lobe / (line * interval * static_cast<double>(length))));
    for (std::size_t k = 0; k < spectrum.power.size(); ++k) {
        spectrum.frequency.push_back(static_cast<double>(k) * line);
        for (const auto& part : parts) spectrum.power[k] += part[k] / segments;
    }
    const std::size_t highest = highest_line(spectrum.power, lobe, spectrum.power.size());
    if (!is_local_maximum(spectrum.power, highest)) return spectrum;
    const double peak = peak_about(spectrum.power, highest);
    const auto at = static_cast<std::size_t>(std::lround(peak));
    spectrum.peak_frequency = peak * line;
    double carried = 0.0;
    const std::size_t from = at > lobe ? at - lobe : 0, to = std::min(at + lobe + 1, spectrum.power.size());
    for (std::size_t k = from; k < to; ++k) carried += spectrum.power[k] * line;
    spectrum.amplitude = std::sqrt(2.0 * carried);
    const double s = segments, freedom = 36.0 * s * s / (19.0 * s - 1.0);
    const boost::math::chi_squared noise(freedom);
    const auto lines = static_cast<double>(spectrum.power.size());
    spectrum.peak_over_median =
        spectrum.power[at] / median_of({spectrum.power.begin() + static_cast<std::ptrdiff_t>(lobe), spectrum.power.end()});
    spectrum.noise_limit = quantile(noise, std::pow(1.0 - k_false_alarm, 1.0 / lines)) / quantile(noise, 0.5);
    if (segments >= 4) {
        std::vector<double> peaks;
        for (const auto& part : parts) peaks.push_back(peak_about(part, highest_line(part, std::max<std::size_t>(from, 1), to)) * line);
        spectrum.standard_error = std::sqrt(sample_of(peaks).variance / (0.5 * (segments + 1)));
    }
    return spectrum;
}

}  // namespace cutterflow::postproc
