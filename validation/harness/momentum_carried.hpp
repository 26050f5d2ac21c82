#pragma once
/// \file The bound of momentum_carried (balance.csv): what the water has yet to receive, over the turnover of the step.
///
/// A step lays X, what rock hands over, and half of what was owed, K/2. Where the water takes the share t of that, K becomes
/// K/2 + (1 - t)(X + K/2), for a steady X  K = 2 (1 - t)/t X: less than X from t = 2/3 on, without end for t = 0. Of a water that does take
/// it only what drag and added mass lag behind in a step is owed. |X| is at most the turnover, but where a
/// step has no part in how much it is: rock that a contact stops, or that sets off at once and pushes the water aside. What is owed of
/// such a blow goes by halves. So the largest value is bound where there are none, and the median of the steps with rock everywhere.
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "geometry/base/statistics/sample.hpp"

namespace cutterflow::validation {

inline constexpr double k_most_carried = 1.0;

/// Median of momentum_carried over the steps with rock; 0 without any, not-a-number if one of them is. \param balance  its columns
inline double median_carried(const std::map<std::string, std::vector<double>>& balance) {
    const std::vector<double>&rocks = balance.at("rocks"), &carried = balance.at("momentum_carried");
    std::vector<double> with_rock;
    for (std::size_t i = 0; i < carried.size(); ++i) {
        if (std::isnan(carried[i])) return std::numeric_limits<double>::quiet_NaN();
        if (rocks[i] > 0.0) with_rock.push_back(carried[i]);
    }
    return with_rock.empty() ? 0.0 : median(std::move(with_rock));
}

}  // namespace cutterflow::validation
