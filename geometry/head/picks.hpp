#pragma once
/// \file The picks of a head whose file has none, as rock meets them.
#include <vector>

#include "geometry/cgal/solid_search.hpp"
#include "geometry/head/contour.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// A strip along each blade's leading edge, without thickness, from a little within the contour to `length` beyond it along its normal:
/// rows of picks, nearer to each other than rock is wide. At rotor angle 0. Where steel closes the circumference, as the ring and the hub
/// do, there is none. \param heights  at which the edges are looked for, >= 2 \param sense  of rotation about +z: +1 or -1 \param length  >
/// 0 [m]
TriangleSurface pick_rows(const SolidSearch& cutter, const Contour& head, double length, double sense, int heights);

}  // namespace cutterflow::geometry
