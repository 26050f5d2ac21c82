#pragma once
/// \file The triangles of a wall as its STL has them: for the box of the simulation, the measured rotor angle and where rock may not be
/// put.
#include <array>
#include <filesystem>
#include <vector>

#include "geometry/base/vec3.hpp"

namespace cutterflow::liggghts {

using Triangle = std::array<Vec3, 3>;

/// Reads a binary or ASCII STL.
/// \throws UserError  when the file cannot be read, has no triangle or ends early
std::vector<Triangle> read_stl(const std::filesystem::path& file);

/// Distance [m] of a point to a triangle.
double distance_to(const Triangle& triangle, const Vec3& point);

/// The triangles of one wall.
class WallSurface {
public:
    explicit WallSurface(std::vector<Triangle> triangles);

    const std::vector<Triangle>& triangles() const { return triangles_; }

    /// Whether a triangle is nearer to `point` than `distance` [m].
    bool is_within(const Vec3& point, double distance) const;

    /// Sum of the triangles' solid angles seen from `point` over 4 pi: +-1 inside a closed surface, 0 outside of it. Taken as 0 outside the
    /// surface's box.
    double winding_number(const Vec3& point) const;

private:
    struct Ball {
        Vec3 centre;
        double radius;
    };

    std::vector<Triangle> triangles_;
    std::vector<Ball> balls_;  // around each triangle
    Vec3 low_, high_;
};

/// Whether a point of winding number `turns` lies inside steel. Surfaces that form a closed one only together count by their sum; one that
/// is not closed has no inside, as its winding number is not whole.
bool is_inside(double turns);

}  // namespace cutterflow::liggghts
