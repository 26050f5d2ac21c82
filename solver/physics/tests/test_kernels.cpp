// The kernels' value and slope at the cut, and what they are near the rock.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace cutterflow::physics
