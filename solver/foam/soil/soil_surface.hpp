#pragma once
/// \file The closed surface of the soil. Only for .cpp files of solver/foam.
#include <filesystem>
#include <vector>

#include "solver/space/steel_tree.hpp"

namespace cutterflow::foam {

class SoilSurface {
public:
    /// \pre  the triangles close one or several solids
    explicit SoilSurface(std::vector<coupling::SteelTriangle> triangles) : triangles_(std::move(triangles)), tree_(triangles_) {}

    /// Distance [m] to the surface, below 0 in the soil; where it is larger than `limit` [m], limit with that sign.
    double distance(const Vec3& point, double limit) const {
        const double distance = tree_.distance(point, limit);
        return tree_.contains(point) ? -distance : distance;
    }
    const std::vector<coupling::SteelTriangle>& triangles() const { return triangles_; }

private:
    std::vector<coupling::SteelTriangle> triangles_;
    coupling::SteelTree tree_;
};

/// Reads an STL file in metres. \throws UserError  when it is not there, cannot be read or does not close
SoilSurface read_soil_surface(const std::filesystem::path& file);

}  // namespace cutterflow::foam
