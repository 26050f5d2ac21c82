#pragma once
/// \file Largest radius of a head.
#include <algorithm>

#include "geometry/head/contour.hpp"

namespace cutterflow::geometry {

/// Of the tips: the contour's largest radius over all z [m].
inline double tip_radius(const Contour& contour) {
    return *std::max_element(contour.radius().begin(), contour.radius().end());
}

}  // namespace cutterflow::geometry
