#pragma once
/// \file Radial velocity of the fluid just outside the head's contour, averaged over azimuth in the axial bins.
#include <vector>

#include "geometry/head/axial_bins.hpp"
#include "geometry/head/contour.hpp"
#include "solver/ports/fluid_engine.hpp"

namespace cutterflow::coupling {

/// Points of every bin and the radial unit vectors there: circles of 360 azimuths at four heights, shifted against each other, `offset`
/// outside the contour along its normal in the meridional plane. `gap` is watched outside the ring's cylinder, `below_hub` under the
/// contour's lower end on four rings of equal area. One group per bin.
WatchedPlaces outflow_places(const geometry::Contour& contour, const std::vector<geometry::AxialBin>& bins, double offset);

}  // namespace cutterflow::coupling
