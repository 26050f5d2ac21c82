#pragma once
/// \file The round body that points sweep as they turn about an axis.
#include <algorithm>
#include <limits>

#include "geometry/base/axis_frame.hpp"
#include "solver/space/box.hpp"

namespace cutterflow::coupling {

struct SweptBody {
    double radius = 0.0;                                     ///< [m]
    double first = std::numeric_limits<double>::infinity();  ///< along the axis, from its origin [m]
    double last = -std::numeric_limits<double>::infinity();

    void add(const RotationAxis& axis, const Vec3& point) {
        const Vec3 arm = point - axis.origin;
        const double along = axis.direction.dot(arm);
        radius = std::max(radius, (arm - along * axis.direction).norm());
        first = std::min(first, along);
        last = std::max(last, along);
    }
    Box box(const RotationAxis& axis) const {
        const Vec3& n = axis.direction;
        const Vec3 middle = axis.origin + 0.5 * (first + last) * n;
        const Vec3 half = 0.5 * (last - first) * n.cwiseAbs() + radius * (Vec3::Ones() - n.cwiseProduct(n)).cwiseMax(0.0).cwiseSqrt();
        return {middle - half, middle + half};
    }
};

}  // namespace cutterflow::coupling
