#pragma once
/// \file Weights of the mapping between rock and fluid, as functions of (distance / kernel width)^2. Unnormalised: the mapping divides by
/// the volume-weighted sum over the cells that it finds. Both vanish with zero slope at the cut, so that no cell pops in or out.
#include <cmath>

namespace cutterflow::physics {

/// The kernels reach this many widths. [NieuwboerVanRheeKeetels2023]
inline constexpr double k_kernel_reach = 3.0;
inline constexpr double k_kernel_reach2 = k_kernel_reach * k_kernel_reach;

/// Gaussian from rock to fluid, less its tangent at the cut:  exp(-q/2) - exp(-q_c/2) (1 - (q - q_c)/2),  q = r^2/sigma^2, q_c = 9.
/// Positive below q_c (a convex function less its tangent), 0 beyond. [XiaoSun2011, NieuwboerVanRheeKeetels2023]
inline double gaussian_weight(double q) {
    if (q >= k_kernel_reach2) return 0.0;
    const double at_cut = std::exp(-0.5 * k_kernel_reach2);
    return std::exp(-0.5 * q) - at_cut * (1.0 - 0.5 * (q - k_kernel_reach2));
}

/// From this many widths on the quadratic weight is faded out.
inline constexpr double k_quadratic_fade_start = 2.0;

/// Quadratic weight from fluid to rock, which favours fluid that the rock does not disturb:  q for r <= 2 sigma, then q s^2 (3 - 2 s) with
/// s = (9 - q)/(9 - 4), which goes to zero with zero slope at r = 3 sigma. (The hard cut of the source drops a cell at its largest weight.)
/// [NieuwboerVanRheeKeetels2023]
inline double quadratic_weight(double q) {
    constexpr double fade = k_quadratic_fade_start * k_quadratic_fade_start;
    if (q <= fade) return q;
    if (q >= k_kernel_reach2) return 0.0;
    const double s = (k_kernel_reach2 - q) / (k_kernel_reach2 - fade);
    return q * s * s * (3.0 - 2.0 * s);
}

}  // namespace cutterflow::physics
