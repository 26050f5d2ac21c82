#pragma once
#include <vector>

#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// Corners of a closed polygon, in either sense.
using PlanarLoop = std::vector<Eigen::Vector2d>;

/// Delaunay triangles of the region between a polygon and its holes, counter-clockwise, without new points.
/// \param loops  outer polygon first, then the holes inside it; no two may cross or touch
/// \return indices into the loops' corners, numbered through in order
std::vector<Triangle> triangulate_region(const std::vector<PlanarLoop>& loops);

}  // namespace cutterflow::geometry
