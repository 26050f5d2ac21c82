#pragma once
/// \file Where the run averages the velocity: planes for pictures, points of measurement.
#include <optional>

#include "cases/scenes/cutter/case_inputs.hpp"
#include "cases/study/study.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::cases {

/// Points, row by row, of a plane through the axis and the mouth's centre: from the tank's bottom, or a quarter of the ring radius below
/// the head, to 0.6 ring radii above the backplate, and 1.5 ring radii to both sides.
VelocitySetInput axial_plane(const Study& study, const HeadSize& head);

/// Points, row by row, of the plane 0.3425 ring radii under the ring plane (137 mm at R = 0.4 m, the reference model), 1.4 ring radii to
/// all sides.
VelocitySetInput plane_under_ring(const Study& study, const HeadSize& head);

/// The places around the study's points of measurement (postproc::adv_places), point by point.
/// \pre  the study names points \throws UserError  with every mistake of their file
VelocitySetInput adv_set(const Study& study);

/// Refuses points of measurement that lie outside the tank, or in steel or soil whatever the rotor's angle. A still point through which the
/// blades pass is in water between them.
/// \param cutter  at rotor angle 0, run's frame \param soil  none: no bank stands beside the head
/// \pre  the study names points \throws UserError  with every mistake of their file
void require_adv_points(const Study& study, const HeadSize& head, const geometry::TriangleSurface& cutter,
                        const std::optional<geometry::TriangleSurface>& soil);

/// What the run's sampling depends on of a file of points: places and frames, not what was measured there.
std::string adv_places_hash(const std::filesystem::path& points_file);

}  // namespace cutterflow::cases
