#pragma once
/// \file Grains on a grid of a plane, as means across the third direction: void fraction, velocity.
#include <vector>

#include "postproc/analysis/measures/grains.hpp"

namespace cutterflow::postproc {

/// A grid of square cells over two sides of a box; values are means over the third.
struct PlaneGrid {
    BoxRegion box;
    int across = 1;     ///< axis of the means: 0 x, 1 y, 2 z
    double cell = 0.0;  ///< as asked for; columns and rows fill the box, so that cells are this large or a little smaller [m]
    int first() const { return across == 0 ? 1 : 0; }   ///< axis of the columns
    int second() const { return across == 2 ? 1 : 2; }  ///< axis of the rows
    int columns() const;
    int rows() const;
    double width() const { return (box.upper[first()] - box.lower[first()]) / columns(); }
    double height() const { return (box.upper[second()] - box.lower[second()]) / rows(); }
    double x(int i) const { return box.lower[first()] + (i + 0.5) * width(); }    ///< middle of a column
    double z(int j) const { return box.lower[second()] + (j + 0.5) * height(); }  ///< middle of a row
    std::size_t cells() const { return static_cast<std::size_t>(columns()) * rows(); }
};

/// Volume and momentum over density of the grains' parts in each cell, row by row.
struct SolidMap {
    std::vector<double> volume;            ///< [m3]
    std::vector<Vec3> volume_by_velocity;  ///< sum of volume times velocity [m4/s]
    double speed_sum = 0.0;                ///< sum of volume times speed in the box [m4/s]
    double faster_volume = 0.0;            ///< of grains faster than `fast` in the box [m3]
};

/// Every grain gives equal parts of its volume to the cells of the points of unit_sphere_points; parts outside the box are left out.
SolidMap solid_map(const Grains& grains, const PlaneGrid& grid, double fast = 0.0);

/// 1 less the share of each cell's volume that grains fill.
std::vector<double> void_fraction(const SolidMap& map, const PlaneGrid& grid);

struct VoidArea {
    double area = 0.0;                         ///< [m2]
    double equivalent_diameter = 0.0;          ///< of the circle of that area [m]
    double width = 0.0, height = 0.0;          ///< extents along columns and rows [m]
    std::vector<double> outline_x, outline_z;  ///< middles of the fine cells at its rim [m]
};

/// Area in which the void fraction, bilinear between the cells' middles, is at least `threshold` and which is connected to the seed. Cells
/// are divided into 8 x 8 for it.
/// \return area 0 when the seed lies below the threshold
VoidArea void_area(const std::vector<double>& void_fraction, const PlaneGrid& grid, double seed_x, double seed_z, double threshold);

}  // namespace cutterflow::postproc
