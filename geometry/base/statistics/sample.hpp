#pragma once
/// \file Mean and scatter of repeated values.
#include <cstddef>
#include <vector>

namespace cutterflow {

struct Sample {
    double mean = 0.0;
    double variance = 0.0;  ///< of one value
    std::size_t count = 0;
};

Sample sample_of(const std::vector<double>& values);

/// The middle one of the values in their order; of an even number the upper of the two in the middle. \pre one value or more
double median(std::vector<double> values);

/// Of the mean. \pre one value or more
double standard_error(const Sample& sample);

/// Half the 95 % interval of the mean, by Student's t. \pre two values or more
double half_interval(const Sample& sample);

/// Half the 95 % interval of the sum or difference of two independent means, with Welch's and Satterthwaite's degrees of freedom; 0 when
/// neither scatters. \pre two values or more in both
double half_interval_of_two(const Sample& a, const Sample& b);

}  // namespace cutterflow
