#pragma once
/// \file Weights of the mapping between rock and fluid, as functions of (distance / kernel width)^2. Unnormalised: the mapping divides by
/// the volume-weighted sum over the cells that it finds. Both vanish with zero slope at the cut, so that cells enter and leave smoothly.
#include <algorithm>
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

/// Quadratic weight from fluid to rock, small where the rock disturbs the fluid:  q for r <= 2 sigma, then q s^2 (3 - 2 s) with
/// s = (9 - q)/(9 - 4), which goes to zero with zero slope at r = 3 sigma. (The hard cut of the source drops a cell at its largest weight.)
/// [NieuwboerVanRheeKeetels2023]
inline double quadratic_weight(double q) {
    constexpr double fade = k_quadratic_fade_start * k_quadratic_fade_start;
    if (q <= fade) return q;
    if (q >= k_kernel_reach2) return 0.0;
    const double s = (k_kernel_reach2 - q) / (k_kernel_reach2 - fade);
    return q * s * s * (3.0 - 2.0 * s);
}

/// Width of the near weight over the kernel's.
inline constexpr double k_near_width = 0.5;

/// Gaussian from fluid to rock, half as wide as the deposit: what a rock feels is the flow over its own size, and a kernel of sigma = d
/// is 1.7 d across.
inline double near_weight(double q) {
    return gaussian_weight(q / (k_near_width * k_near_width));
}

/// Integrals of the weights over space, in units of sigma^3: what they are compared by.
inline constexpr double k_gaussian_integral = 11.770376;
inline constexpr double k_quadratic_integral = 285.71962;
inline constexpr double k_near_integral = k_near_width * k_near_width * k_near_width * k_gaussian_integral;

/// Share of a resolved rock's weight, quadratic or near, in the sampling weight: 1 for rock as large as cells and above, 0 for rock below
/// half a cell, smooth between. The quadratic weight is a shell: it samples waves of about 3 sigma with the wrong sign (-0.14 of their
/// height), so that drag amplifies them. Rock that is small relative to its kernel hardly disturbs the sampled fluid and uses the deposit
/// kernel, with which drag can only remove energy.
/// \param own_width_share  gamma d / sigma, in (0, 1]
inline double resolved_share(double own_width_share) {
    // sigma = 1.5 dx there, so 1/3 is a rock of half a cell and 2/3 one of a cell.
    const double s = std::min(1.0, std::max(0.0, 3.0 * own_width_share - 1.0));
    return s * s * (3.0 - 2.0 * s);
}

/// Weight from fluid to rock: a resolved rock's weight and the Gaussian mixed.
/// \param resolved  quadratic_weight(q) / k_quadratic_integral or near_weight(q) / k_near_integral
/// \param gaussian  gaussian_weight(q), which a caller needs anyway
inline double sampling_weight(double resolved, double gaussian, double share) {
    return share * resolved + (1.0 - share) * gaussian / k_gaussian_integral;
}

}  // namespace cutterflow::physics
