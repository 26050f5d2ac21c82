// Shear lift against McLaughlin's values and Saffman's limit.
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/physics/lift.hpp"

namespace cutterflow::physics {
namespace {

TEST(ShearLift, has_the_published_ratios) {
    EXPECT_NEAR(shear_lift_ratio(1.0), 0.722, 5e-4);
    EXPECT_NEAR(shear_lift_ratio(5.0), 0.989, 5e-4);
    EXPECT_NEAR(shear_lift_ratio(0.05), -140.0 * std::pow(0.05, 5) * std::log(400.0), 1e-12);
    EXPECT_NEAR(shear_lift_ratio(100.0), 1.0 - 0.287e-4, 1e-12);
}

TEST(ShearLift, is_continuous_but_for_the_known_misses) {
    EXPECT_NEAR(shear_lift_ratio(0.1 - 1e-9) - shear_lift_ratio(0.1 + 1e-9), -0.0044, 2e-4);
    EXPECT_NEAR(shear_lift_ratio(20.0 - 1e-9) - shear_lift_ratio(20.0 + 1e-9), 0.0004, 2e-4);
}

TEST(MeiLift, is_the_ratio_times_saffmans_force) {
    // Saffman: 1.615 rho nu d |w| sqrt(Re_G) across slip and vorticity.
    const RockInFluid grain{1e-4, 998.2, 1.0034e-6};
    const Vec3 slip(1e-3, 0.0, 0.0), vorticity(0.0, 0.0, 50.0);
    const Vec3 force = lift_force(grain, slip, vorticity, mei_lift_coefficient);
    const double shear_reynolds = 50.0 * 1e-8 / 1.0034e-6, eps = std::sqrt(shear_reynolds) / (1e-3 * 1e-4 / 1.0034e-6);
    const double saffman = k_pi / 8.0 * 4.11 * 998.2 * 1.0034e-6 * 1e-4 * 1e-3 * std::sqrt(shear_reynolds);
    EXPECT_NEAR(saffman, 1.614 * 998.2 * 1.0034e-6 * 1e-4 * 1e-3 * std::sqrt(shear_reynolds), 1e-4 * saffman);
    // Fluid ahead of the rock, turning about z: the rock is pushed to -y.
    EXPECT_NEAR((force - Vec3(0.0, -saffman * shear_lift_ratio(eps), 0.0)).norm(), 0.0, 1e-12 * saffman);
}

TEST(MeiLift, vanishes_without_slip_or_vorticity) {
    const RockInFluid rock{0.02, 998.2, 1.0034e-6};
    EXPECT_EQ(lift_force(rock, Vec3::Zero(), Vec3(0, 0, 5), mei_lift_coefficient), Vec3::Zero());
    EXPECT_EQ(lift_force(rock, Vec3(0.5, 0, 0), Vec3::Zero(), mei_lift_coefficient), Vec3::Zero());
    EXPECT_EQ(lift_force(rock, Vec3(0, 0, 0.5), Vec3(0, 0, 5), mei_lift_coefficient), Vec3::Zero());
}

}  // namespace
}  // namespace cutterflow::physics
