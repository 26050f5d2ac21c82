#pragma once
/// \file Sizes of cut rock: a law of mass over diameter, cut into classes of equal mass.
#include <vector>

namespace cutterflow::cases {

enum class SizeLaw {
    rosin_rammler,  ///< F(d) = 1 - exp(-(d/d63)^m), m = spread
    log_normal,     ///< F(d) = (1 + erf(ln(d/d50) / (s sqrt(2))))/2, s = spread
};

/// Share F(d) of the rock's mass below a diameter.
struct SizeDistribution {
    SizeLaw law = SizeLaw::rosin_rammler;
    double scale = 0.0;                    ///< d63 or d50 [m] > 0
    double spread = 0.0;                   ///< m or s [-] > 0
    double smallest = 0.0, largest = 0.0;  ///< the law is truncated to these diameters [m]

    double mass_below(double diameter) const;            ///< F(d) of the whole law
    double truncated_mass_below(double diameter) const;  ///< (F(d) - F(smallest)) / (F(largest) - F(smallest))
};

/// Diameters [m] of `classes` classes of equal mass: each at the middle of its mass.
/// \pre smallest < largest, and the law has mass between them
std::vector<double> equal_mass_diameters(const SizeDistribution& sizes, int classes);

}  // namespace cutterflow::cases
