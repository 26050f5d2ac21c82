#pragma once
#include "geometry/repair/welding.hpp"

namespace cutterflow::geometry::repair {

/// Joins borders that run along each other with different points (T-junctions): an open edge is divided at every border point within
/// `distance` [m] of it. count: edges divided.
Stepped join_seams(const TracedSurface& traced, double distance);

/// Separates the surface where it touches itself in a single point: of the fans of triangles that meet there the largest keeps the point,
/// each other one gets a new point, `distance` [m] from it towards the middle of the fan. count: points added.
Stepped part_touching_points(const TracedSurface& traced, double distance);

}  // namespace cutterflow::geometry::repair
