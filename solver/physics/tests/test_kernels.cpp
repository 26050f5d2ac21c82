// The kernels' value and slope at the cut, and what they are near the rock.
#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/physics/kernels.hpp"

namespace cutterflow::physics {
namespace {

double slope(double (*weight)(double), double q, double h) {
    return (weight(q + h) - weight(q - h)) / (2.0 * h);
}

TEST(Gaussian, is_the_gaussian_near_the_rock) {
    EXPECT_NEAR(gaussian_weight(0.0), 1.0 - std::exp(-4.5) * 5.5, 1e-15);
    EXPECT_NEAR((gaussian_weight(0.0) - gaussian_weight(1.0)) - (1.0 - std::exp(-0.5)), -0.5 * std::exp(-4.5), 1e-15);
}

TEST(Gaussian, vanishes_with_zero_slope_at_the_cut_and_is_positive_before) {
    EXPECT_EQ(gaussian_weight(9.0), 0.0);
    EXPECT_EQ(gaussian_weight(9.1), 0.0);
    EXPECT_NEAR(slope(gaussian_weight, 9.0, 1e-4), 0.0, 1e-6);
    EXPECT_NEAR(gaussian_weight(9.0 - 1e-3), 0.125 * std::exp(-4.5) * 1e-6, 1e-11);
    for (double q = 0.0; q < 8.99; q += 0.01) EXPECT_GT(gaussian_weight(q), gaussian_weight(q + 0.01));
}

TEST(Quadratic, is_r_squared_up_to_two_widths) {
    for (const double q : {0.0, 0.25, 1.0, 3.9, 4.0}) EXPECT_EQ(quadratic_weight(q), q);
}

TEST(Quadratic, is_smooth_where_the_fade_starts_and_at_the_cut) {
    EXPECT_NEAR(slope(quadratic_weight, 4.0, 1e-5), 1.0, 1e-4);
    EXPECT_NEAR(slope(quadratic_weight, 9.0, 1e-5), 0.0, 1e-4);
    EXPECT_EQ(quadratic_weight(9.0), 0.0);
    for (double q = 0.01; q < 9.0; q += 0.01) EXPECT_GT(quadratic_weight(q), 0.0);
}

/// Height that a weight sees of a wave of wave number k / sigma, over its true height: the weight's Fourier transform, by its integral over
/// spherical shells.
template <class Weight>
double seen_height(const Weight& weight, double k) {
    double seen = 0.0, all = 0.0;
    const double step = 1e-3;
    for (double r = 0.5 * step; r < k_kernel_reach; r += step) {
        seen += weight(r * r) * r * std::sin(k * r) / k * step;
        all += weight(r * r) * r * r * step;
    }
    return seen / all;
}

TEST(Sampling, integrals_are_those_of_the_weights) {
    double gaussian = 0.0, quadratic = 0.0, near = 0.0;
    const double step = 1e-3;
    for (double r = 0.5 * step; r < k_kernel_reach; r += step) {
        gaussian += 4.0 * k_pi * gaussian_weight(r * r) * r * r * step;
        quadratic += 4.0 * k_pi * quadratic_weight(r * r) * r * r * step;
        near += 4.0 * k_pi * near_weight(r * r) * r * r * step;
    }
    EXPECT_NEAR(gaussian, k_gaussian_integral, 1e-5 * gaussian);
    EXPECT_NEAR(quadratic, k_quadratic_integral, 1e-5 * quadratic);
    EXPECT_NEAR(near, k_near_integral, 1e-5 * near);
}

TEST(Sampling, nearby_is_half_as_wide_as_the_deposit) {
    EXPECT_EQ(near_weight(1.0), gaussian_weight(4.0));
    EXPECT_EQ(near_weight(2.25), 0.0);
}

TEST(Sampling, is_the_resolved_weight_for_rock_of_a_cell_and_above_and_the_gaussian_for_half_a_cell_and_below) {
    EXPECT_EQ(resolved_share(1.0), 1.0);
    EXPECT_EQ(resolved_share(2.0 / 3.0), 1.0);
    EXPECT_EQ(resolved_share(1.0 / 3.0), 0.0);
    EXPECT_EQ(resolved_share(0.1), 0.0);
    EXPECT_NEAR(resolved_share(0.5), 0.5, 1e-12);
    EXPECT_DOUBLE_EQ(sampling_weight(0.3, gaussian_weight(3.0), 1.0), 0.3);
    EXPECT_DOUBLE_EQ(sampling_weight(0.3, gaussian_weight(3.0), 0.0), gaussian_weight(3.0) / k_gaussian_integral);
}

TEST(Sampling, of_small_rock_sees_no_wave_with_the_wrong_sign) {
    // Drag on what is seen with the wrong sign feeds the wave instead of damping it.
    EXPECT_LT(seen_height(quadratic_weight, 2.0), -0.14);
    for (const double own_width : {0.1, 0.3, 0.45}) {
        const auto weight = [share = resolved_share(own_width)](double q) {
            return sampling_weight(quadratic_weight(q) / k_quadratic_integral, gaussian_weight(q), share);
        };
        for (double k = 0.1; k < 4.0; k += 0.1)
            EXPECT_GT(seen_height(weight, k), 0.0) << "wave number " << k << ", own width " << own_width;
    }
    for (double k = 0.1; k < 4.0; k += 0.1) EXPECT_GT(seen_height(near_weight, k), 0.0) << "wave number " << k;
}

}  // namespace
}  // namespace cutterflow::physics
