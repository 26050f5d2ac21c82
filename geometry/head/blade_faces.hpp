#pragma once
/// \file Where the steel of a turning head comes first: leading faces of its blades by height, and the picks along them.
#include <vector>

#include "geometry/cgal/solid_search.hpp"
#include "geometry/head/contour.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// Steel at one height, in the azimuths that it covers near the contour; at rotor angle 0.
struct SteelInterval {
    double leading = 0.0;  ///< azimuth of the face that comes first [rad], in [0, 2 pi)
    double width = 0.0;    ///< of the steel behind it [rad]
};

/// Azimuths that steel covers at any radius between 0.9 and 1.0 of the contour's, at height z: found on circles at 720 azimuths, edges to
/// 1e-6 rad; steel narrower than half a degree may be missed. Works for any closed surface. Empty where steel covers all azimuths, as in
/// the ring, or none. \param sense  of rotation about +z: +1 or -1
std::vector<SteelInterval> steel_intervals(const SolidSearch& cutter, const Contour& head, double z, double sense);

/// A strip along each blade's leading edge, without thickness, from a little within the contour to `length` beyond it along its normal:
/// rows of picks, nearer to each other than rock is wide. At rotor angle 0. Where steel closes the circumference, as the ring and the hub
/// do, there is none. \param heights  at which the edges are looked for, >= 2 \param sense  of rotation about +z: +1 or -1 \param length  >
/// 0 [m]
TriangleSurface pick_rows(const SolidSearch& cutter, const Contour& head, double length, double sense, int heights);

}  // namespace cutterflow::geometry
