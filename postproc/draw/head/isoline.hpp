#pragma once
/// \file Lines of equal value on a regular grid of points.
#include <vector>

namespace cutterflow::postproc {

/// Pieces of a line, each of two points, NaN between them: as a series takes them.
struct Isoline {
    std::vector<double> x, y;
};

/// Linear along the edges of the triangles that halve each cell.
/// \param value  at x[i], y[j]: i + j*x.size()
Isoline isoline(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& value, double level);

}  // namespace cutterflow::postproc
