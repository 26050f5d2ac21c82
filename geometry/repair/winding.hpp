#pragma once
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry::repair {

/// Signed solid angle of a triangle at a point, over 4 pi; positive when the point is on its back side [VanOosteromStrackee1983].
/// 0 for a point in the triangle's plane outside it.
double solid_angle_share(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& seen_from);

/// How often a surface winds about a point: 1 inside a closed, outward oriented surface, 0 outside; a fraction near an open one
/// (Jacobson2013).
double winding_number(const TriangleSurface& surface, const Vec3& point);

}  // namespace cutterflow::geometry::repair
