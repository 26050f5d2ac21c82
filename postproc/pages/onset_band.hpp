#pragma once
/// \file The outflow at which rock began to leave through the bin below the ring in the reference's simulations, as a band in plots against
/// outflow.
#include <string>

#include "postproc/draw/plot.hpp"

namespace cutterflow::postproc {

/// Radial velocity just outside the contour in the first 30 mm below the ring at which spillage there set in: model cutter at scale 1:4,
/// ring radius 0.4 m, rock of 20 mm, 20 to 90 rpm [m/s]. [NieuwboerVanRheeKeetels2023]
inline constexpr double k_onset_low = 0.05, k_onset_high = 0.23;

/// Shades the band in a plot whose x axis is that velocity, and gives the axis the range from `low` to `high` and the band.
void add_onset_band(Plot& plot, double low, double high);

/// Caption of the band.
std::string onset_band_text();

}  // namespace cutterflow::postproc
