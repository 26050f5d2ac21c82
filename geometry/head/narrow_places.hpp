#pragma once
/// \file The narrowest places of a head: what rock must pass and what a mesh must resolve.
#include "geometry/head/revolution_contour.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// Diameter [m] of the largest sphere that gets between the blades from outside into the head. On its way in, the sphere's centre crosses
/// every surface that the contour, scaled about the middle of the ring plane, makes; on each of them the largest sphere is found that
/// touches no steel, and the smallest of these is the passage; below, the hub closes them. One pitch is looked at: all are alike in a
/// symmetric head. \param contour  of the head, ring plane z = 0 \param blades  2 or more \pre the surface is closed and in the
/// run's frame
double passage_between_blades(const TriangleSurface& head, const RevolutionContour& contour, int blades);

/// Thickness [m] below which a fiftieth of the surface lies: of thin parts, such as blades, the thinnest. The thickness at a point is the
/// diameter of the largest ball inside the solid that touches the surface there, counted where the ball touches the other side too, more
/// than 120 degrees away; so edges and corners, where balls shrink to nothing, do not count. \pre the surface is closed and outward
double smallest_thickness(const TriangleSurface& solid);

}  // namespace cutterflow::geometry
