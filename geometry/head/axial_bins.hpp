#pragma once
/// \file The axial bins of spillage and of radial outflow: one definition for the solver's sampler and for the reports.
#include <string>
#include <vector>

#include "geometry/head/contour.hpp"

namespace cutterflow::geometry {

/// A band of the head's boundary. `gap` lies between ring plane and backplate, `below_hub` below the contour's lower end.
struct AxialBin {
    std::string name;    ///< "gap", "0-30mm", ... (distance below the ring), "below_hub"
    double z_min = 0.0;  ///< [m], in the head's frame; -infinity for below_hub
    double z_max = 0.0;  ///< [m]; z_backplate for gap
};

/// Bands that a head is divided into at most.
inline constexpr double k_most_axial_bins = 1000.0;

/// Bins from the backplate down: gap, then bands of `width` [m] > 0 from the ring plane to the contour's lower end (the last one may be
/// narrower), then below_hub.
std::vector<AxialBin> axial_bins(const Contour& contour, double width);

/// Index of the bin that holds axial coordinate z [m]; above the backplate counts as gap. Bins as axial_bins returns them.
std::size_t bin_of(const std::vector<AxialBin>& bins, double z);

}  // namespace cutterflow::geometry
