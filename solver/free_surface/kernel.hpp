#pragma once
/// \file The kernel between particles and grid: the quadratic B-spline.
#include <array>

namespace cutterflow::free_surface {

/// Weights of the three nodes around a point.
struct KernelWeights {
    int first = 0;  ///< the lowest node
    std::array<double, 3> weight{};
};

/// Quadratic B-spline of nodes at whole numbers, for a point at `s` >= -0.5 (in spacings). The weights add up to 1 and their first moment
/// is exact: sum w_i i = s. [SteffenKirbyBerzins2008]
inline KernelWeights quadratic_weights(double s) {
    const int nearest = static_cast<int>(s + 0.5);
    const double t = s - nearest;
    return {nearest - 1, {0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)}};
}

/// Share of the kernel of a node in a cell's centre that falls on the cell below, on its own cell and on the one above: integrals of the
/// B-spline, so that evenly spread particles beside a closed cell read the same fraction as in the open.
inline constexpr std::array<double, 3> k_cell_share{1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0};

}  // namespace cutterflow::free_surface
