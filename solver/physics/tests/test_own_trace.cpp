// What a rock sees of itself: the constants from the kernel, and the limits.
#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/physics/kernels.hpp"
#include "solver/physics/own_trace.hpp"

namespace cutterflow::physics {
namespace {

constexpr double k_water_density = 998.2, k_water_viscosity = 1e-6, k_width = 0.02, k_overlap = 4000.0;

/// g of sigma = 1.
double kernel_at(double r) {
    return gaussian_weight(r * r) / k_gaussian_integral;
}

TEST(OwnTrace, wake_is_half_of_the_squared_projection_of_the_kernel) {
    // Without viscosity the fluid of a stream tube has all the force that it has passed: half of it on average over a symmetric kernel.
    const double step = 0.005;
    double velocity = 0.0;
    for (double across = 0.5 * step; across < k_kernel_reach; across += step) {
        double projected = 0.0;
        for (double along = 0.5 * step; along < k_kernel_reach; along += step)
            projected += 2.0 * kernel_at(std::hypot(across, along)) * step;
        velocity += 0.5 * 2.0 * k_pi * across * projected * projected * step;
    }
    EXPECT_NEAR(k_own_wake_velocity, velocity, 1e-4 * velocity);
}

TEST(OwnTrace, of_slow_flow_is_the_mean_of_stokeslets) {
    // The mean over directions of a Stokeslet is 1 / (6 pi mu r): what a shell does inside of another is that of the larger radius.
    const double step = 5e-4;
    double enclosed = 0.0, velocity = 0.0;
    for (double r = 0.5 * step; r < k_kernel_reach; r += step) {
        const double shell = 4.0 * k_pi * r * r * kernel_at(r) * step;
        velocity += 2.0 * shell * (enclosed + 0.5 * shell) / r;
        enclosed += shell;
    }
    velocity /= 6.0 * k_pi;
    EXPECT_NEAR(k_own_stokes_velocity, velocity, 1e-4 * velocity);
}

TEST(OwnTrace, of_a_fast_rock_does_not_depend_on_viscosity_and_follows_drag) {
    const Vec3 slip(0.0, 0.0, 0.7);
    const OwnTrace trace = own_trace(slip, 0.01, 0.0, k_overlap, k_width, k_water_density, k_water_viscosity);
    EXPECT_NEAR(trace.velocity.z(), k_own_wake_velocity * 0.01 / (k_water_density * k_width * k_width), 1e-3 * trace.velocity.z());
    EXPECT_NEAR(trace.acceleration.z(), 2.0 / 3.0 * k_overlap * 0.01 * 0.7 / k_water_density, 1e-3 * trace.acceleration.z());
    EXPECT_EQ(trace.velocity.x(), 0.0);
}

TEST(OwnTrace, of_a_slow_rock_is_stokes) {
    const double drag = 3.0 * k_pi * k_water_density * k_water_viscosity * 0.001, speed = 1e-7;
    const OwnTrace trace = own_trace(Vec3(speed, 0.0, 0.0), drag, 0.0, k_overlap, k_width, k_water_density, k_water_viscosity);
    EXPECT_NEAR(trace.velocity.x() / speed, k_own_stokes_velocity * 3.0 * k_pi * 0.001 / k_width, 1e-4 * trace.velocity.x() / speed + 1e-5);
    EXPECT_LT(trace.acceleration.x(), 0.01 * 2.0 / 3.0 * k_overlap * drag * speed / k_water_density);
}

TEST(OwnTrace, of_making_way_is_a_third_of_the_own_solid_fraction) {
    const OwnTrace trace = own_trace(Vec3(0.3, 0.0, 0.0), 0.0, 3e-6, k_overlap, k_width, k_water_density, k_water_viscosity);
    EXPECT_NEAR(trace.velocity.x(), -0.3 * 3e-6 * k_overlap / 3.0, 1e-15);
}

TEST(OwnTrace, does_not_move_rock_that_moves_with_the_water) {
    const OwnTrace trace = own_trace(Vec3::Zero(), 0.01, 3e-6, k_overlap, k_width, k_water_density, k_water_viscosity);
    EXPECT_EQ(trace.velocity, Vec3(Vec3::Zero()));
    EXPECT_EQ(trace.acceleration, Vec3(Vec3::Zero()));
}

TEST(OwnTrace, is_seen_whole_in_a_bed_and_not_at_all_alone) {
    EXPECT_EQ(own_trace_share(0.0), 1.0);
    EXPECT_NEAR(own_trace_share(0.1), 0.6561 / 1.44, 1e-12);
    EXPECT_LT(own_trace_share(0.6), 0.006);
    for (double solid = 0.0; solid < 0.9; solid += 0.05) EXPECT_GT(own_trace_share(solid), own_trace_share(solid + 0.05));
}

}  // namespace
}  // namespace cutterflow::physics
