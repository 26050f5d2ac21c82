// Drag and hindrance against values computed independently from the published formulas.
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/physics/drag.hpp"

namespace cutterflow::physics {
namespace {

struct DragPoint {
    double reynolds, cd, tolerance;
};

class BrownLawler : public ::testing::TestWithParam<DragPoint> {};

TEST_P(BrownLawler, has_the_published_value) {
    EXPECT_NEAR(brown_lawler_drag_coefficient(GetParam().reynolds), GetParam().cd, GetParam().tolerance);
}

INSTANTIATE_TEST_SUITE_P(FourDecimals, BrownLawler,
                         ::testing::Values(DragPoint{1.5, 19.1633, 5e-5}, DragPoint{4.1, 8.1491, 5e-5}, DragPoint{11.6, 3.7167, 5e-5},
                                           DragPoint{31.9, 1.9467, 5e-5}, DragPoint{19832, 0.4373, 5e-5}, DragPoint{0.1, 247.50, 5e-3},
                                           DragPoint{1, 27.60, 5e-3}, DragPoint{100, 1.073, 5e-4}, DragPoint{1e3, 0.463, 5e-4},
                                           DragPoint{1e5, 0.466, 5e-4}, DragPoint{2e5, 0.4635, 5e-5}));

TEST(DiFelice, exponent_is_least_where_log_re_is_1_5_and_tends_to_3_7) {
    EXPECT_NEAR(di_felice_exponent(std::pow(10.0, 1.5)), 3.05, 1e-14);
    EXPECT_NEAR(di_felice_exponent(19832.0), 3.687, 5e-4);
    EXPECT_NEAR(di_felice_exponent(1e-6), 3.7, 1e-9);
}

TEST(DiFelice, factor_is_one_in_pure_fluid_and_grows_with_solids) {
    EXPECT_DOUBLE_EQ(di_felice_factor(1.0, 123.0), 1.0);
    EXPECT_NEAR(di_felice_factor(0.5, std::pow(10.0, 1.5)), std::pow(0.5, -2.05), 1e-13);
}

TEST(Drag, tends_to_stokes_law_without_slip) {
    const RockInFluid rock{0.001, 998.2, 1.0034e-6, 1.0};
    const double stokes = 3.0 * k_pi * 998.2 * 1.0034e-6 * 0.001;
    EXPECT_NEAR(drag_coefficient_per_slip(rock, 0.0, brown_lawler_drag_coefficient, di_felice_factor), stokes, 1e-6 * stokes);
}

TEST(Drag, is_half_rho_cd_area_speed_in_pure_fluid) {
    const RockInFluid rock{0.02, 998.2, 1.0034e-6, 1.0};
    const double speed = 0.7;
    const double cd = brown_lawler_drag_coefficient(speed * 0.02 / 1.0034e-6);
    const double expected = 0.5 * 998.2 * cd * k_pi / 4.0 * 4e-4 * speed;
    EXPECT_NEAR(drag_coefficient_per_slip(rock, speed, brown_lawler_drag_coefficient, di_felice_factor), expected, 1e-12 * expected);
    EXPECT_NEAR(drag_coefficient_per_slip(rock, speed, brown_lawler_drag_coefficient, di_felice_factor, 3.0), 3.0 * expected,
                1e-12 * expected);
}

TEST(Drag, hindrance_sees_the_void_fraction_in_its_reynolds_number) {
    const RockInFluid rock{0.02, 998.2, 1.0034e-6, 0.7};
    RockInFluid free = rock;
    free.void_fraction = 1.0;
    const double speed = 0.002;  // Re about 40, where the exponent varies
    const double ratio = drag_coefficient_per_slip(rock, speed, brown_lawler_drag_coefficient, di_felice_factor) /
                         drag_coefficient_per_slip(free, speed, brown_lawler_drag_coefficient, di_felice_factor);
    EXPECT_NEAR(ratio, di_felice_factor(0.7, 0.7 * speed * 0.02 / 1.0034e-6), 1e-12);
}

TEST(FluidAcceleration, carries_the_displaced_fluid_and_its_added_mass) {
    const Vec3 force = fluid_acceleration_force(2e-6, 1000.0, 0.5, Vec3(1.0, -2.0, 4.0));
    EXPECT_NEAR((force - Vec3(3e-3, -6e-3, 12e-3)).norm(), 0.0, 1e-15);
}

}  // namespace
}  // namespace cutterflow::physics
