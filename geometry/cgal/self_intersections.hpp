#pragma once
#include <utility>
#include <vector>

#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// Pairs of triangles (indices, smaller first, sorted) that intersect other than in the edge or point they share. Exact predicates; any
/// soup of triangles will do. Triangles without area and exact duplicates are left out: inspect_surface lists them by themselves.
std::vector<std::pair<std::size_t, std::size_t>> find_self_intersections(const TriangleSurface& surface);

}  // namespace cutterflow::geometry
