#pragma once
/// \file Distances on a Cartesian grid. Only for .cpp files of solver/foam.
#include <array>
#include <functional>
#include <vector>

#include "geometry/base/vec3.hpp"

namespace cutterflow::foam {

/// A function of place, sampled at the nodes of a grid and linear along each of its lines in between: what is linear in space stays exact.
class DistanceGrid {
public:
    /// Covers the box from `lower` to `upper` [m] with nodes `spacing` [m] apart. \pre lower <= upper, spacing > 0
    DistanceGrid(const Vec3& lower, const Vec3& upper, double spacing, const std::function<double(const Vec3&)>& distance);

    /// Outside of the box the value of the nearest place in it.
    double at(const Vec3& point) const;
    double spacing() const { return spacing_; }

private:
    Vec3 lower_;
    double spacing_;
    std::array<std::ptrdiff_t, 3> nodes_;
    std::vector<float> values_;
};

}  // namespace cutterflow::foam
