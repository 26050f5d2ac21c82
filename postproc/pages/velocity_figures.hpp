#pragma once
/// \file Pictures of the mean velocity on a plane through the axis and on a plane under the ring.
#include <optional>

#include "postproc/draw/plot.hpp"
#include "postproc/run/run_reader.hpp"

namespace cutterflow::postproc {

/// Colour: speed in the plane; arrows: its direction and size. Through the axis and the mouth's centre: to the right towards the mouth,
/// upwards along the axis from hub to ring, with the outline of the head's contour. None when the run did not sample the plane.
/// \throws UserError  when the table is no grid
std::optional<Figure> axial_plane(const RunData& run);

/// The plane under the ring, seen from the hub, the lowest side down.
std::optional<Figure> plane_under_ring(const RunData& run);

}  // namespace cutterflow::postproc
