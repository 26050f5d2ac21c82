#pragma once
/// \file A straight line through points by least squares.
#include <vector>

namespace cutterflow::postproc {

/// y = intercept + slope x
struct LineFit {
    double slope = 0.0, intercept = 0.0;
    double r2 = 0.0;        ///< 1 - sum of squared residuals over that about the mean; 0 when y does not vary
    double residual = 0.0;  ///< root mean square, in the unit of y
    std::size_t points = 0;
};

/// \pre two different x at least
LineFit fit_line(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace cutterflow::postproc
