#pragma once
/// \file What a cutter head is, as far as flow and rock care: axis, blades, ring, contour, carrying sense.
#include <optional>

#include "geometry/base/axis_frame.hpp"
#include "geometry/head/blade_profile.hpp"
#include "geometry/head/revolution_contour.hpp"
#include "geometry/head/rotational_symmetry.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// Sense of rotation about the axis in which the blades push rock towards the suction side.
enum class CarryingSense { positive, negative, none };

/// How the blades push along the axis.
struct Carrying {
    CarryingSense sense = CarryingSense::none;
    /// Integral of r n_azimuth n_z over the surface by that of r |n_azimuth| (n the outward normal): the axial share of the push that the
    /// blades give, per unit of torque-bearing area. Positive: positive rotation pushes towards +z. none below 0.02.
    double measure = 0.0;
};

/// \pre the surface is in the run's frame (axis z, suction side at +z)
Carrying carrying_sense(const TriangleSurface& surface);

/// A head understood. Lengths in metres.
struct Head {
    RotationAxis axis;            ///< in the file's frame; origin in the ring plane, direction from hub to ring
    RotationalSymmetry symmetry;  ///< blades and how well they repeat
    Eigen::Isometry3d to_run_frame = Eigen::Isometry3d::Identity();  ///< from the file's frame (in metres)
    TriangleSurface surface;                                         ///< in the run's frame
    double ring_radius = 0.0;                                        ///< outer radius of the ring at the ring plane
    double lowest_z = 0.0;                                           ///< of the hub's end, negative: the head's height is -lowest_z
    double steel_above_ring = 0.0;                                   ///< height above the ring plane of steel nearer to the axis (a shaft)
    Carrying carrying;
    RevolutionContour contour;       ///< from the lowest point to the ring plane
    std::optional<double> passage;   ///< passage_between_blades; none without blades
    double thickness = 0.0;          ///< smallest_thickness of the steel
    std::vector<BladeSlice> blades;  ///< from the lowest point to the ring plane; none without blades
};

/// Axis and blades by rotational symmetry; the outer radius runs in (from 0.75 to 0.5 of its largest) over more height at the hub's end
/// than at the ring's; the ring plane, z = 0, is the highest point of the steel that is farther from the axis than 0.6 of the largest
/// radius (the ring's top face); the ring radius is the largest radius within 0.02 of the largest radius below it. The head turns by the
/// smallest angle that makes its axis z. An axis that already is the z axis, within 0.02 degrees and 1e-4 of the radius, is taken as such:
/// the head is shifted along z only. \pre the surface [m] is sound \throws UserError  when there is no rotational symmetry, both ends
/// look alike, or a separate body is not repeated by the blades' symmetry
Head understand_head(const TriangleSurface& surface);

}  // namespace cutterflow::geometry
