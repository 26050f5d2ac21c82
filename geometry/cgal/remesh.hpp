#pragma once
/// \file Surfaces with better triangles.
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// Clears a closed surface of the short edges that boolean operations leave: those of rounding size, and those along feature lines (edges
/// whose faces meet at more than `feature_angle_deg`) that are shorter than `shortest_edge` [m]. Corners, where feature lines meet or
/// end, and the bounding box stay.
TriangleSurface with_thinned_features(const TriangleSurface& surface, double shortest_edge, double feature_angle_deg);

/// The same closed surface with triangles of nearly equal sides. Feature edges are kept, divided where they are too long; other points lie
/// on the old surface, so that the deviation is that of chords of `edge_length` [m]. The bounding box stays.
TriangleSurface remeshed(const TriangleSurface& surface, double edge_length, double feature_angle_deg);

}  // namespace cutterflow::geometry
