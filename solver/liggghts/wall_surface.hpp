#pragma once
/// \file The triangles of a wall as its STL has them, and where they are near a point.
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "geometry/base/vec3.hpp"
#include "solver/space/steel_tree.hpp"

namespace cutterflow::liggghts {

using Triangle = std::array<Vec3, 3>;

/// Reads a binary or ASCII STL.
/// \throws UserError  when the file cannot be read, has no triangle or ends early
std::vector<Triangle> read_stl(const std::filesystem::path& file);

/// The point of a triangle that is nearest to `point`. Beside a triangle without area that of its edges.
Vec3 nearest_point(const Triangle& triangle, const Vec3& point);

/// Some triangles of a wall.
struct NearTriangles {
    std::vector<Triangle> triangles;
    std::vector<std::int32_t> numbers;  ///< their places in the wall's file, from 0
};

/// The triangles of one wall.
class WallSurface {
public:
    explicit WallSurface(std::vector<Triangle> triangles);

    /// In the order of the wall's file.
    const std::vector<Triangle>& triangles() const { return triangles_; }

    /// Whether a triangle is nearer to `point` than `distance` [m].
    bool is_within(const Vec3& point, double distance) const { return tree_.distance(point, distance) < distance; }

    /// The triangles nearer to `point` than `distance` [m]. Any two of them are in the same order in every answer.
    NearTriangles near(const Vec3& point, double distance) const;

    /// Sum of the triangles' solid angles seen from `point` over 4 pi: +-1 inside a closed surface, 0 outside of it. Taken as 0 outside the
    /// surface's box.
    double winding_number(const Vec3& point) const;

private:
    std::vector<Triangle> triangles_;
    coupling::SteelTree tree_;
    Vec3 low_, high_;
};

/// Whether a point of winding number `turns` lies inside a surface. One that is not closed has no inside, as its winding number is not
/// whole.
bool is_inside(double turns);
/// The same of surfaces that may form a closed one only together: they count by their sum, and each by itself where an open one among them
/// leaves a fraction of a turn.
bool is_inside(const std::vector<double>& turns);

}  // namespace cutterflow::liggghts
