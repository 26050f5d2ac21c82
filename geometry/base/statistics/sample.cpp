#include "geometry/base/statistics/sample.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>

namespace cutterflow {

namespace {

constexpr double k_confidence = 0.95;

/// Half the width of the two-sided interval of a mean, in its standard errors.
double student_factor(double degrees_of_freedom) {
    return quantile(boost::math::students_t(degrees_of_freedom), 0.5 * (1.0 + k_confidence));
}

}  // namespace

Sample sample_of(const std::vector<double>& values) {
    Sample sample;
    sample.count = values.size();
    if (values.empty()) return sample;
    double above_first = 0.0;  // so that the mean of equal values is that value, to the bit
    for (const double value : values) above_first += value - values.front();
    sample.mean = values.front() + above_first / static_cast<double>(sample.count);
    for (const double value : values) sample.variance += (value - sample.mean) * (value - sample.mean);
    if (sample.count > 1) sample.variance /= static_cast<double>(sample.count - 1);
    return sample;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double standard_error(const Sample& sample) {
    return std::sqrt(sample.variance / static_cast<double>(sample.count));
}

double half_interval(const Sample& sample) {
    return student_factor(static_cast<double>(sample.count) - 1.0) * standard_error(sample);
}

double half_interval_of_two(const Sample& a, const Sample& b) {
    const double va = a.variance / static_cast<double>(a.count), vb = b.variance / static_cast<double>(b.count);
    if (va + vb == 0.0) return 0.0;
    const double freedom =
        (va + vb) * (va + vb) / (va * va / static_cast<double>(a.count - 1) + vb * vb / static_cast<double>(b.count - 1));
    return student_factor(freedom) * std::sqrt(va + vb);
}

}  // namespace cutterflow
