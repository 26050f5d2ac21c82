#pragma once
#include <utility>
#include <vector>

#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// A piece of a triangle of the old surface that no other triangle crosses.
struct Facet {
    Triangle corners;    ///< indices into the arrangement's points
    std::size_t parent;  ///< a triangle of the old surface on which it lies
    int multiplicity;    ///< how many triangles have it in the facet's sense, less those that have it in the other; not 0
};

/// Triangles divided where they cross: two facets share an edge, a point, or nothing.
struct Arrangement {
    std::vector<Vec3> points;  ///< exact places rounded to double; equal ones are distinct when only rounding made them equal
    std::vector<Facet> facets;
};

/// Divides the triangles of a surface along their intersections, in exact arithmetic. Triangles that overlap in their plane are divided
/// alike and counted as one facet.
/// \param crossing  the pairs of triangles that intersect, as find_self_intersections gives them
/// \pre   no triangle without area, no two with the same points
Arrangement arrange(const TriangleSurface& surface, const std::vector<std::pair<std::size_t, std::size_t>>& crossing);

}  // namespace cutterflow::geometry
