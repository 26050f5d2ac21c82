#pragma once
/// \file Mean and scatter of repeated values.
#include <cstddef>
#include <vector>

namespace cutterflow::postproc {

struct Sample {
    double mean = 0.0;
    double variance = 0.0;  ///< of one value
    std::size_t count = 0;
};

Sample sample_of(const std::vector<double>& values);

/// Half the width of the two-sided 95 % interval of a mean, in its standard errors.
double student_factor(double degrees_of_freedom);

/// Half the 95 % interval of the mean, by Student's t. \pre two values or more
double half_interval(const Sample& sample);

}  // namespace cutterflow::postproc
