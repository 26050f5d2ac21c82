#pragma once
/// \file A clump's shape without its size.
#include <optional>

#include "geometry/clump/clump.hpp"

namespace cutterflow::geometry {

/// A clump of volume-equivalent diameter 1 with its centre of mass in the origin, along the axes of its file. A rock of diameter d has all
/// lengths times d, moments of inertia times its density and d^5.
struct UnitClump {
    std::vector<Ball> balls;
    Vec3 moments = Vec3::Zero();                         ///< principal ones, per density, ascending
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: right-handed principal axes, in the order of the moments
    std::optional<double> sphericity;                    ///< where the file has one

    /// Of the ball that reaches farthest from the centre of mass.
    double reach() const;
};

/// \pre no mistakes
UnitClump unit_clump(const Clump& clump);

}  // namespace cutterflow::geometry
