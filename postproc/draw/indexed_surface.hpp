#pragma once
/// \file A surface as points and triangles between them, small enough for pages and pictures.
#include <array>
#include <cstdint>
#include <vector>

#include "postproc/draw/triangle_surface.hpp"

namespace cutterflow::postproc {

inline constexpr std::size_t k_most_triangles = 60000;  ///< of a surface in a page or a series of pictures

/// Points are on a cubic grid: low + step * (i, j, k).
struct IndexedSurface {
    Vec3 low = Vec3::Zero();  ///< [m]
    double step = 0.0;        ///< [m]
    std::vector<std::array<std::uint16_t, 3>> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    Vec3 point(std::size_t index) const { return low + step * Vec3(points[index][0], points[index][1], points[index][2]); }
};

/// Puts a surface on a grid of 65,536 points along its longest side. Corners that fall on one grid point become one and triangles
/// that lose a side go; the grid is made coarser by halves until at most `most_triangles` are left.
IndexedSurface index_surface(const TriangleSurface& surface, std::size_t most_triangles = k_most_triangles);

}  // namespace cutterflow::postproc
