#pragma once
/// \file The closed surface of the soil.
#include <vector>

#include "solver/space/steel_tree.hpp"

namespace cutterflow::coupling {

class SoilSurface {
public:
    /// \pre  the triangles close one or several solids
    explicit SoilSurface(std::vector<SteelTriangle> triangles) : triangles_(std::move(triangles)), tree_(triangles_) {}

    /// Distance [m] to the surface, below 0 in the soil; where it is larger than `limit` [m], limit with that sign.
    double distance(const Vec3& point, double limit) const {
        const double distance = tree_.distance(point, limit);
        return tree_.contains(point) ? -distance : distance;
    }
    const std::vector<SteelTriangle>& triangles() const { return triangles_; }

private:
    std::vector<SteelTriangle> triangles_;
    SteelTree tree_;
};

}  // namespace cutterflow::coupling
