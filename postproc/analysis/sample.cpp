#include "postproc/analysis/sample.hpp"

#include <cmath>

#include <boost/math/distributions/students_t.hpp>

namespace cutterflow::postproc {

constexpr double k_confidence = 0.95;

Sample sample_of(const std::vector<double>& values) {
    Sample sample;
    sample.count = values.size();
    for (const double value : values) sample.mean += value / static_cast<double>(sample.count);
    for (const double value : values) sample.variance += (value - sample.mean) * (value - sample.mean);
    if (sample.count > 1) sample.variance /= static_cast<double>(sample.count - 1);
    return sample;
}

double student_factor(double degrees_of_freedom) {
    return quantile(boost::math::students_t(degrees_of_freedom), 0.5 * (1.0 + k_confidence));
}

double half_interval(const Sample& sample) {
    const auto n = static_cast<double>(sample.count);
    return student_factor(n - 1.0) * std::sqrt(sample.variance / n);
}

}  // namespace cutterflow::postproc
