#pragma once
/// \file What flows out of the head in its axial bins: the radial velocity just outside the contour, averaged over azimuth, and the flux
/// through a surface that is closed but for the backplate.
#include <vector>

#include "geometry/head/axial_bins.hpp"
#include "geometry/head/contour.hpp"
#include "solver/ports/fluid_engine.hpp"

namespace cutterflow::coupling {

/// Points of every bin and the radial unit vectors there: circles of 360 azimuths at four heights, shifted against each other, `offset`
/// outside the contour along its normal in the meridional plane. `gap` is watched outside the ring's cylinder, `below_hub` under the
/// contour's lower end on four rings of equal area. One group per bin.
WatchedPlaces outflow_places(const geometry::Contour& contour, const std::vector<geometry::AxialBin>& bins, double offset);

/// Places whose mean along their directions is the outward flux of a bin [m3/s]: circles of 360 azimuths in the middle of four conical
/// bands per bin, whose directions are outward normals times four areas of a band. The bands of all bins join: from the backplate at the
/// ring's radius outwards by `offset`, down to the ring plane, along the contour at `offset`, and to the axis `offset` under its lower end.
/// So all fluxes add up to that through the backplate, which is less the discharge.
WatchedPlaces flux_places(const geometry::Contour& contour, const std::vector<geometry::AxialBin>& bins, double offset);

/// Both: the radial velocity of every bin, then its flux.
WatchedPlaces velocity_and_flux_places(const geometry::Contour& contour, const std::vector<geometry::AxialBin>& bins, double offset);

}  // namespace cutterflow::coupling
