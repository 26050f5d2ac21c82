#pragma once
#include <vector>

#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// Triangles of least area that close a loop of points, without new points. Indices count along the loop; the triangles pass the loop's
/// edges in its own sense. Empty when there is no such patch. The cost grows with the cube of the loop's points.
std::vector<Triangle> triangulate_hole(const std::vector<Vec3>& loop);

}  // namespace cutterflow::geometry
