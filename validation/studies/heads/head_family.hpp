#pragma once
/// \file The family of parametric heads on which statements about "any cutter" are measured.
#include "geometry/head/crown_cutter.hpp"

namespace cutterflow::validation {

/// Head number `index` (0, 1, ...) of a design of experiments that fills the ranges below evenly for any number of heads. Sizes relative to
/// the ring radius R:
///
///     R 0.1 to 1.6 m (evenly in its logarithm), blades 4 to 8 in turn, wrap 20 to 90 degrees of either sign in turn, rake 0 to 25 degrees,
///     thickness at the ring 0.055 to 0.09 R and at the hub 0.8 to 1.2 of that, hub radius 0.28 to 0.36 R, hub depth 0.9 to 1.35 R,
///     exponent of the contour 1.6 to 2.6, depth of the blades 0.12 to 0.15 R at the ring and 0.16 to 0.22 R at the hub;
///     every second pair of heads has 4 to 8 picks per blade, 0.06 to 0.1 R long, leaning by 0 to 40 degrees.
///
/// The points are those of an additive recurrence with the powers of the inverse generalised golden ratio (Roberts 2018), which needs no
/// random numbers. \pre index >= 0
geometry::CrownParameters family_head(int index);

/// Number k (0, 1, ...) of point `index` of that sequence, in [0, 1). \pre 0 <= k < 16
double family_share(int index, int k);

}  // namespace cutterflow::validation
