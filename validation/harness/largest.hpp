#pragma once
/// \file Largest values that keep a not-a-number: std::max drops it where it comes second, and a bound would then pass.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace cutterflow::validation {

/// The larger of two; not-a-number if one of them is.
inline double larger(double one, double other) {
    return std::isnan(other) ? other : std::max(one, other);
}

/// The largest of some; not-a-number if one of them is.
/// \throws std::runtime_error  when there are none: a bound would be held against nothing
inline double largest(const std::vector<double>& values) {
    if (values.empty()) throw std::runtime_error("no values to take the largest of");
    double most = values.front();
    for (const double value : values) most = larger(most, value);
    return most;
}

}  // namespace cutterflow::validation
