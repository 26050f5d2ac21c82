// What a rock sees of itself: the constants from the kernel, and the limits.
#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/physics/kernels.hpp"
#include "solver/physics/own_trace.hpp"

namespace cutterflow::physics {
namespace {

constexpr double k_water_viscosity = 1e-6, k_width = 0.02, k_overlap = 4000.0;

/// Deposit and sampling weight of sigma = 1, normalised.
struct Weights {
    const char* name;
    OwnResponse response;
    double (*sample)(double r);
};

double deposit(double r) {
    return gaussian_weight(r * r) / k_gaussian_integral;
}

double near(double r) {
    return near_weight(r * r) / k_near_integral;
}

class Response : public ::testing::TestWithParam<Weights> {};
INSTANTIATE_TEST_SUITE_P(OwnTrace, Response,
                         ::testing::Values(Weights{"deposit", k_deposit_response, deposit}, Weights{"near", k_near_response, near}),
                         [](const auto& info) { return info.param.name; });

double projected(double (*weight)(double), double across) {
    const double step = 0.005;
    double sum = 0.0;
    for (double along = 0.5 * step; along < k_kernel_reach; along += step) sum += 2.0 * weight(std::hypot(across, along)) * step;
    return sum;
}

TEST_P(Response, in_a_wake_is_half_of_the_product_of_the_projected_kernels) {
    // Without viscosity the fluid of a stream tube has all the force that it has passed: half of it on average over a symmetric kernel.
    const double step = 0.005;
    double velocity = 0.0;
    for (double across = 0.5 * step; across < k_kernel_reach; across += step)
        velocity += 0.5 * 2.0 * k_pi * across * projected(deposit, across) * projected(GetParam().sample, across) * step;
    EXPECT_NEAR(GetParam().response.wake, velocity, 1e-4 * velocity);
}

TEST_P(Response, in_slow_flow_is_the_mean_of_stokeslets) {
    // The mean over directions of a Stokeslet is 1 / (6 pi mu r): what a shell does inside of another is that of the larger radius.
    const double step = 5e-4;
    double force = 0.0, sampled = 0.0, velocity = 0.0;
    for (double r = 0.5 * step; r < k_kernel_reach; r += step) {
        const double shell = 4.0 * k_pi * r * r * step, of_force = shell * deposit(r), of_sample = shell * GetParam().sample(r);
        velocity += (of_force * (sampled + 0.5 * of_sample) + of_sample * (force + 0.5 * of_force)) / r;
        force += of_force;
        sampled += of_sample;
    }
    velocity /= 6.0 * k_pi;
    EXPECT_NEAR(GetParam().response.stokes, velocity, 1e-4 * velocity);
}

TEST_P(Response, bends_as_the_gradients_of_the_kernels) {
    const double step = 5e-4, h = 1e-5;
    const auto slope = [h](double (*weight)(double), double r) { return (weight(r + h) - weight(r - h)) / (2.0 * h); };
    double overlap = 0.0, of_slopes = 0.0;
    for (double r = 0.5 * step; r < k_kernel_reach; r += step) {
        overlap += r * r * deposit(r) * GetParam().sample(r);
        of_slopes += r * r * slope(deposit, r) * slope(GetParam().sample, r);
    }
    EXPECT_NEAR(GetParam().response.bend, of_slopes / overlap, 1e-4 * GetParam().response.bend);
}

TEST(OwnTrace, of_a_fast_rock_does_not_depend_on_viscosity_and_follows_drag) {
    const OwnTrace trace = own_trace(Vec3(0.0, 0.0, 0.7), 1e-5, {0.0, k_overlap, k_width, 1.0}, k_water_viscosity, 0.0);
    EXPECT_NEAR(trace.velocity.z(), k_near_response.wake * 1e-5 / (k_width * k_width), 1e-3 * trace.velocity.z());
    EXPECT_NEAR(trace.acceleration.z(), 2.0 / 3.0 * k_overlap * 1e-5 * 0.7, 1e-3 * trace.acceleration.z());
    EXPECT_EQ(trace.velocity.x(), 0.0);
}

TEST(OwnTrace, of_a_slow_rock_is_stokes) {
    const double diameter = 0.001, rate = 3.0 * k_pi * k_water_viscosity * diameter, speed = 1e-7;
    const OwnTrace trace = own_trace(Vec3(speed, 0.0, 0.0), rate, {0.0, k_overlap, k_width, 0.0}, k_water_viscosity, 0.0);
    const double expected = k_deposit_response.stokes * 3.0 * k_pi * diameter / k_width;
    EXPECT_NEAR(trace.velocity.x() / speed, expected, 2e-3 * expected);
    EXPECT_LT(trace.acceleration.x(), 0.01 * 2.0 / 3.0 * k_overlap * rate * speed);
}

TEST(OwnTrace, of_making_way_is_a_third_of_the_own_solid_fraction) {
    const OwnTrace trace = own_trace(Vec3(0.3, 0.0, 0.0), 0.0, {3e-6, k_overlap, k_width, 1.0}, k_water_viscosity, 0.0);
    EXPECT_NEAR(trace.velocity.x(), -0.3 * 3e-6 * k_overlap / 3.0, 1e-15);
    EXPECT_EQ(trace.acceleration.x(), 0.0);
}

TEST(OwnTrace, follows_the_step_by_which_the_fluid_is_advanced) {
    // The flow that makes way moves with the rock by slip times step; the difference of two steps sees its bend.
    const double step = 1e-3, speed = 0.3, own = 3e-6 * k_overlap;
    const OwnTrace still = own_trace(Vec3(speed, 0.0, 0.0), 0.0, {3e-6, k_overlap, k_width, 1.0}, k_water_viscosity, step);
    EXPECT_NEAR(still.acceleration.x(), -0.2 * own * speed * speed * speed * step * k_near_response.bend / (k_width * k_width), 1e-12);
    const Sampler massless{0.0, k_overlap, k_width, 1.0};
    const OwnTrace pushed = own_trace(Vec3(speed, 0.0, 0.0), 1e-5, massless, k_water_viscosity, step);
    const OwnTrace at_once = own_trace(Vec3(speed, 0.0, 0.0), 1e-5, massless, k_water_viscosity, 0.0);
    EXPECT_NEAR(pushed.velocity.x() - at_once.velocity.x(), 0.5 * step * pushed.acceleration.x(), 1e-12);
}

TEST(OwnTrace, does_not_move_rock_that_moves_with_the_water) {
    const OwnTrace trace = own_trace(Vec3::Zero(), 1e-5, {3e-6, k_overlap, k_width, 1.0}, k_water_viscosity, 1e-3);
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
