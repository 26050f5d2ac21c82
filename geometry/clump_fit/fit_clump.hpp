#pragma once
/// \file A clump that stands for a rock given by its surface.
#include "geometry/clump/clump.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

inline constexpr int k_most_balls = 64;

/// A rock's numbers beside its clump's.
struct ClumpFit {
    Clump clump;                     ///< with the rock's sphericity
    ClumpProperties of_rock;         ///< its solid's
    ClumpProperties of_clump;        ///< the union's
    double inscribed_volume = 0.0;   ///< of the union of the spheres before they were polished [m3]
    double surface_deviation = 0.0;  ///< root mean square of the distance of the clump's surface from the rock's [m]
};

/// First `balls` spheres within the rock, each the one that fills most of what the others left empty: of the points of a lattice that with
/// its distance from the surface (CGAL) as radius. Then centres and radii are polished together (Levenberg and Marquardt, Eigen) to the
/// least of
///
///   sum over k of (e_k/0.002)^2 + mean over the surface of (s/(0.02 d))^2 + sum over the spheres of ((move/d)^2 + ln(r/r_0)^2)/0.1^2
///
/// with the relative errors e_k of volume, centre of mass over d, the tensor of inertia over its mean moment, and the shadows in the
/// directions of the rock's smallest and largest; s is the distance of a point of the rock's surface from the clump's,
/// d the diameter of equal volume. The polished spheres reach out of the rock where they leave it empty elsewhere.
/// \pre the surface is closed, outward, without self-intersections \throws UserError  when `balls` is not within 1 and k_most_balls, when
/// the rock is so thin that no point of the lattice lies within, when the spheres do not make one rock
ClumpFit fit_clump(const TriangleSurface& rock, int balls);

}  // namespace cutterflow::geometry
