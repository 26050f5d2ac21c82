#pragma once
/// \file Pictures of the mean velocity on a plane through the axis and on a plane under the ring.
#include <optional>

#include "postproc/draw/plot.hpp"
#include "postproc/run/run_reader.hpp"

namespace cutterflow::postproc {

/// Colour: speed in the plane; arrows: its direction and size. Through the axis and the mouth's centre: to the right towards the mouth,
/// upwards along the axis from hub to ring, with the outline of the head's contour. None when the run did not sample the plane.
/// \throws UserError  when the table is no grid
std::optional<Plot> axial_plane_plot(const RunData& run);

/// The plane under the ring, seen from the hub, the lowest side down.
std::optional<Plot> under_ring_plot(const RunData& run);

/// "mean over 3 revolutions from t = 1 s": what the pictures are averages of.
std::string averaging_text(const Table& plane);

}  // namespace cutterflow::postproc
