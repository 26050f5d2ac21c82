#pragma once
/// \file Upper surface of grains: seen from a side as a line, seen from above as a map.
#include <vector>

#include "postproc/analysis/measures/grains.hpp"

namespace cutterflow::postproc {

/// Columns of equal width between two places; a column stands for its middle.
struct Columns {
    double from = 0.0, to = 0.0;  ///< [m]
    int count = 0;
    double width() const { return (to - from) / count; }
    double middle(int column) const { return from + (column + 0.5) * width(); }
};

/// Upper envelope of spheres seen from a side: for each column at u the highest z + sqrt(R^2 - (u - u_i)^2) of all spheres i with
/// |u - u_i| < R.
/// \param u, z  of the centres [m]; \param diameter  as long
/// \param empty  height of a column without a sphere, and least height of all
std::vector<double> upper_envelope(const std::vector<double>& u, const std::vector<double>& z, const std::vector<double>& diameter,
                                   const Columns& columns, double empty);

/// Height over a grid of square cells, row by row (x runs first).
struct HeightMap {
    double x0 = 0.0, y0 = 0.0;  ///< corner of the first cell [m]
    double cell = 0.0;          ///< [m]
    int columns = 0, rows = 0;
    std::vector<double> height;  ///< [m], at the middle of each cell
    double x(int i) const { return x0 + (i + 0.5) * cell; }
    double y(int j) const { return y0 + (j + 0.5) * cell; }
    double at(int i, int j) const { return height[static_cast<std::size_t>(j) * columns + i]; }
};

/// Highest z + sqrt(R^2 - rho^2) over the middle of each cell, rho the horizontal distance from a sphere's centre.
/// \param lower, upper  horizontal extent; the last cells may reach beyond it
HeightMap height_map(const Grains& grains, const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, double cell, double empty);

/// Median of the cells whose middles lie within half of `diameter` of each cell's middle.
HeightMap median_filtered(const HeightMap& map, double diameter);

/// Mean of the same cells.
HeightMap mean_filtered(const HeightMap& map, double diameter);

}  // namespace cutterflow::postproc
