#pragma once
/// \file The same shape with fewer and better triangles, within a given distance.
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// Bounds of a coarsened surface.
struct CoarseningBounds {
    double deviation = 0.0;       ///< [m] distance that a point of the given surface may have to the new one
    double edge_length = 0.0;     ///< [m]; edges within the surface get at most a third longer
    double smallest_angle = 0.0;  ///< [rad] wanted of every triangle
};

/// The surface with edges collapsed as long as samples of the given one (its points, and points along its edges) stay within `deviation` of
/// it (KleinLiebichStrasser1996), and then with thin triangles divided, their points moved along the given surface and edges flipped until
/// no angle is below `smallest_angle` (after Hu2017). Borders stay as they are, so that surfaces that share them still meet. The deviation
/// is bounded at the samples; surface_distance measures it. Where borders, sharp edges or the deviation prevent it, an angle stays smaller.
/// \throws CheckFailure  when the triangles do not form a 2-manifold
TriangleSurface coarsened(const TriangleSurface& surface, const CoarseningBounds& bounds);

/// Hausdorff distance of two surfaces [m]: the largest distance from one to the other of their points and of points a `spacing` [m] apart
/// on edges and triangles. \throws CheckFailure  when triangles do not form a 2-manifold
double surface_distance(const TriangleSurface& a, const TriangleSurface& b, double spacing);

}  // namespace cutterflow::geometry
