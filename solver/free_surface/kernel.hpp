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

/// Quarters of a cell, by which the room that solids take of a kernel is summed.
inline constexpr int k_parts = 4;

/// Mean weights of a quarter of a cell, 0 the lowest, for the nodes in the centres of the cell below, of its own cell and of the one above.
/// The four together give the integrals 1/6, 2/3, 1/6 of the B-spline.
inline KernelWeights part_weights(int part) {
    const double t = (part + 0.5) / k_parts - 0.5, square = t * t + 1.0 / (12.0 * k_parts * k_parts);
    return {-1, {0.125 - 0.5 * t + 0.5 * square, 0.75 - square, 0.125 + 0.5 * t + 0.5 * square}};
}

}  // namespace cutterflow::free_surface
