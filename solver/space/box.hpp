#pragma once
/// \file Axis-aligned boxes of the searches.
#include <algorithm>
#include <limits>

#include "geometry/base/vec3.hpp"

namespace cutterflow::coupling {

/// An axis-aligned box; without points its lower corner lies above the upper one.
struct Box {
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());   ///< [m]
    Vec3 upper = Vec3::Constant(-std::numeric_limits<double>::infinity());  ///< [m]

    void extend(const Box& by) {
        lower = lower.cwiseMin(by.lower);
        upper = upper.cwiseMax(by.upper);
    }
    bool meets(const Box& other) const {
        return (lower.array() <= other.upper.array()).all() && (upper.array() >= other.lower.array()).all();
    }
    /// From a point to the nearest and to the farthest place of the box [m2].
    double squared_distance(const Vec3& point) const {
        double sum = 0.0;
        for (int i = 0; i < 3; ++i) {
            const double d = std::max({lower[i] - point[i], point[i] - upper[i], 0.0});
            sum += d * d;
        }
        return sum;
    }
    double squared_reach(const Vec3& point) const {
        double sum = 0.0;
        for (int i = 0; i < 3; ++i) {
            const double d = std::max(point[i] - lower[i], upper[i] - point[i]);
            sum += d * d;
        }
        return sum;
    }
};

}  // namespace cutterflow::coupling
