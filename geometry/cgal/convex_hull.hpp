#pragma once
/// \file Convex hulls of points.
#include <vector>

#include "geometry/cgal/planar_region.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// The smallest convex polygon that holds all points, counter-clockwise, from its point of least x on; points on its sides are left out.
/// \pre three points or more that do not lie on a line
PlanarLoop convex_hull(const std::vector<Eigen::Vector2d>& points);

/// The smallest convex solid that holds all points. \pre four points or more that do not lie in a plane
TriangleSurface convex_hull(const std::vector<Vec3>& points);

}  // namespace cutterflow::geometry
