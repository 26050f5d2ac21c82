#pragma once
#include <array>
#include <vector>

#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// For each edge (two indices into `points`) those of `candidates` (indices) that lie within `distance` [m] of it and farther than that
/// from both its ends, in order from the first end to the second.
std::vector<std::vector<std::uint32_t>> find_points_on_edges(const std::vector<Vec3>& points,
                                                             const std::vector<std::array<std::uint32_t, 2>>& edges,
                                                             const std::vector<std::uint32_t>& candidates, double distance);

}  // namespace cutterflow::geometry
