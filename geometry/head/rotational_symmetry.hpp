#pragma once
/// \file The axis of a head and the number of its blades, from its rotational symmetry.
#include "geometry/base/axis_frame.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// What turning a surface about an axis by 360/n degrees does to it.
struct RotationalSymmetry {
    RotationAxis axis;      ///< through the solid's centroid's foot; the direction's sign is arbitrary
    int blade_count = 0;    ///< the largest n that the surface is symmetric to; 0 for a surface of revolution
    double residual = 0.0;  ///< RMS distance [m] between the turned surface and the surface, worst tenth left out
    double contrast = 0.0;  ///< 1 - residual / (the same at the worst angle): 1 exact symmetry, 0 none
};

/// Finds the axis among the principal axes of the solid's inertia (an n-fold axis with n >= 3 is one, exactly), or, where its moments are
/// too alike to tell, among directions all around; then fits direction and origin so that the surface turned by all multiples of 360/n
/// degrees lies on itself: least squares of the distances normal to the surface, outliers left out. blade_count is the largest n from 2 to
/// 12 with a contrast of 0.6 or more and a minimum of the residual there. \pre the surface is sound \throws UserError  when no axis has
/// that contrast
RotationalSymmetry find_rotational_symmetry(const TriangleSurface& surface);

}  // namespace cutterflow::geometry
