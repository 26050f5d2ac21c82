#pragma once
/// \file Blades along the axis, read from the surface alone: how steep they are and how much of the circumference they close.
#include <optional>
#include <vector>

#include "geometry/head/revolution_contour.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// A slice of a head across its axis.
struct BladeSlice {
    double z = 0.0;         ///< of its middle [m]
    double angle = 0.0;     ///< beta between the blades' faces and the axis [rad]: positive when they carry towards the ring
    double coverage = 0.0;  ///< share of the azimuths that meet steel outside half the contour's radius; 1 in ring and hub
    double depth = 0.0;     ///< w: along the radius, from the outermost steel in to the innermost outside half the contour's radius [m]
};

/// Slices of equal thickness from the head's lowest point to the ring plane.
///
/// tan(beta) = sum(A n_azimuth n_z) / sum(A n_azimuth^2) over the surface within the slice outside half the contour's radius, A area and n
/// normal: the slope n_z / n_azimuth of faces, each weighted by its thrust. Faces that do not push around the axis (edges, ring, hub) count
/// nothing. Gravity along a rising blade towards the ring is g sin(beta - l) with the axis inclined by l.
/// \param surface  in the run's frame \param carrying_sense  1 when positive rotation carries towards the ring, else -1
std::vector<BladeSlice> blade_profile(const TriangleSurface& surface, const RevolutionContour& contour, double carrying_sense, int slices);

/// Share of the slices with blades (coverage below 1) that are flatter than `inclination` [rad] asks; none without such slices.
std::optional<double> share_flatter_than(const std::vector<BladeSlice>& profile, double inclination);

}  // namespace cutterflow::geometry
