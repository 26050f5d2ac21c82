#pragma once
/// \file Dense random packings with known outer shapes, for tests.
#include <cstdint>
#include <functional>

#include "postproc/analysis/measures/grains.hpp"

namespace cutterflow::postproc::testing {

/// Grains that fill a box at random without overlaps above 2 %, by pushing overlapping ones apart in a periodic cube that is then
/// repeated; those for which `keep` holds for the centre.
/// \param diameter  mean [m]; sizes are uniform within 10 % of it
Grains packed_grains(const Vec3& lower, const Vec3& upper, double diameter, unsigned seed, const std::function<bool(const Vec3&)>& keep);

/// Solid share of packed_grains.
inline constexpr double k_packed_share = 0.58;

}  // namespace cutterflow::postproc::testing
