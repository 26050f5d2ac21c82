#pragma once
/// \file Distances on a Cartesian grid.
#include <array>
#include <functional>
#include <vector>

#include "geometry/base/vec3.hpp"

namespace cutterflow::coupling {

/// A function of place, sampled at the nodes of a grid and linear along each of its lines in between: what is linear in space stays exact.
/// A node is asked for when it is needed. Nodes lie at multiples of the spacing, so that grids over other boxes have the same ones.
class DistanceGrid {
public:
    /// Covers the box from `lower` to `upper` [m] with nodes `spacing` [m] apart. \pre lower <= upper, spacing > 0
    DistanceGrid(const Vec3& lower, const Vec3& upper, double spacing, std::function<double(const Vec3&)> distance);

    /// Outside of the box the value of the nearest place in it.
    double at(const Vec3& point);
    double spacing() const { return spacing_; }

private:
    double at_node(std::ptrdiff_t node);

    double spacing_;
    std::array<std::ptrdiff_t, 3> first_, nodes_;
    std::function<double(const Vec3&)> distance_;
    std::vector<float> values_;  // not a number: not asked for yet
};

}  // namespace cutterflow::coupling
