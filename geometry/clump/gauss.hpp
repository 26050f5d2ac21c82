#pragma once
/// \file Gauss' rule of 16 points.
#include <boost/math/quadrature/gauss.hpp>

namespace cutterflow::geometry {

/// Calls visit(x, weight) at each point; the sum of f(x) weight is the integral of f from `from` to `to`.
template <class Visit>
void at_gauss_points(double from, double to, Visit visit) {
    using Rule = boost::math::quadrature::gauss<double, 16>;
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    for (std::size_t k = 0; k < Rule::abscissa().size(); ++k) {
        visit(middle - half * Rule::abscissa()[k], half * Rule::weights()[k]);
        visit(middle + half * Rule::abscissa()[k], half * Rule::weights()[k]);
    }
}

}  // namespace cutterflow::geometry
