// What a rock sees of itself: the constants from the kernel, and the limits.
#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/physics/kernels.hpp"
#include "solver/physics/own_trace.hpp"

namespace cutterflow::physics {
namespace {

constexpr double k_water_viscosity = 1e-6, k_width = 0.02;

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

TEST_P(Response, overlaps_as_the_kernels) {
    const double step = 5e-4;
    double overlap = 0.0;
    for (double r = 0.5 * step; r < k_kernel_reach; r += step) overlap += 4.0 * k_pi * r * r * deposit(r) * GetParam().sample(r) * step;
    EXPECT_NEAR(GetParam().response.overlap, overlap, 1e-4 * overlap);
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

/// In open water, where nothing makes the overlap larger.
Sampler rock_of(double volume, double share) {
    const double overlap = share == 1.0 ? k_near_response.overlap : k_deposit_response.overlap;
    return {volume, overlap / (k_width * k_width * k_width), k_width, share};
}

TEST(OwnTrace, of_a_fast_rock_does_not_depend_on_viscosity_and_follows_drag) {
    const Sampler rock = rock_of(0.0, 1.0);
    const OwnTrace trace = own_trace(Vec3(0.0, 0.0, 0.7), Vec3::Zero(), 1e-5, rock, k_water_viscosity, 0.0);
    const double wake = k_near_response.wake * 1e-5 / (0.7 * k_width * k_width);
    EXPECT_NEAR(trace.velocity.z(), 0.7 * wake / (1.0 - wake), 1e-3 * trace.velocity.z());
    EXPECT_NEAR(trace.acceleration.z(), 2.0 / 3.0 * rock.overlap * 1e-5 * 0.7, 1e-3 * trace.acceleration.z());
    EXPECT_EQ(trace.velocity.x(), 0.0);
}

TEST(OwnTrace, of_a_slow_rock_is_stokes) {
    const double diameter = 0.001, rate = 3.0 * k_pi * k_water_viscosity * diameter, speed = 1e-7;
    const Sampler rock = rock_of(0.0, 0.0);
    const OwnTrace trace = own_trace(Vec3(speed, 0.0, 0.0), Vec3::Zero(), rate, rock, k_water_viscosity, 0.0);
    const double wake = k_deposit_response.stokes * 3.0 * k_pi * diameter / k_width;
    EXPECT_NEAR(trace.velocity.x() / speed, wake / (1.0 - wake), 2e-3 * wake);
    EXPECT_LT(trace.acceleration.x(), 0.01 * 2.0 / 3.0 * rock.overlap * rate * speed);
}

TEST(OwnTrace, of_making_way_is_a_third_of_the_own_solid_fraction) {
    const Sampler rock = rock_of(3e-6, 1.0);
    const OwnTrace trace = own_trace(Vec3(0.3, 0.0, 0.0), Vec3::Zero(), 0.0, rock, k_water_viscosity, 0.0);
    EXPECT_NEAR(trace.velocity.x(), -0.3 * 3e-6 * rock.overlap / 3.0, 1e-15);
    EXPECT_EQ(trace.acceleration.x(), 0.0);
}

TEST(OwnTrace, beside_a_wall_grows_with_the_overlap) {
    Sampler rock = rock_of(0.0, 1.0);
    const double open = own_trace(Vec3(0.5, 0.0, 0.0), Vec3::Zero(), 1e-6, rock, k_water_viscosity, 0.0).velocity.x();
    rock.overlap *= 2.0;
    EXPECT_NEAR(own_trace(Vec3(0.5, 0.0, 0.0), Vec3::Zero(), 1e-6, rock, k_water_viscosity, 0.0).velocity.x(), 2.0 * open, 0.02 * open);
}

TEST(OwnTrace, follows_the_step_by_which_rock_moves_through_the_cells) {
    // The flow that makes way moves with the rock; the difference of two steps sees its bend. Along: s v^2 + 2 v (v.s) = 3 s v^2.
    const double step = 1e-3, speed = 0.3;
    const Vec3 slip(speed, 0.0, 0.0);
    const Sampler rock = rock_of(3e-6, 1.0), massless = rock_of(0.0, 1.0);
    const auto acceleration = [&](const Vec3& velocity) {
        return own_trace(slip, velocity, 0.0, rock, k_water_viscosity, step).acceleration;
    };
    const double falling = -0.2 * 3e-6 * rock.overlap * speed * speed * speed * step * k_near_response.bend / (k_width * k_width);
    EXPECT_NEAR(acceleration(-slip).x(), falling, 1e-12);
    EXPECT_NEAR(acceleration(4.0 * slip).x(), 16.0 * falling, 1e-12);
    EXPECT_NEAR(acceleration(Vec3(0.0, speed, 0.0)).x(), falling / 3.0, 1e-12);
    EXPECT_EQ(acceleration(Vec3::Zero()).x(), 0.0);
    const auto velocity = [&](const Vec3& v, double dt) { return own_trace(slip, v, 1e-5, massless, k_water_viscosity, dt).velocity.x(); };
    const double push = own_trace(slip, Vec3::Zero(), 1e-5, massless, k_water_viscosity, step).acceleration.x();
    EXPECT_NEAR(velocity(-slip, step) - velocity(-slip, 0.0), 0.5 * step * push, 0.01 * 0.5 * step * push);
    EXPECT_EQ(velocity(Vec3::Zero(), step), velocity(Vec3::Zero(), 0.0));
    // As the integral over all waves has it: 7.7 where the square of v over s is 16, at v^2 dt of 4 |s| sigma.
    const double coarse = 0.25 * k_width / speed;
    EXPECT_NEAR((velocity(4.0 * slip, coarse) - velocity(4.0 * slip, 0.0)) / (0.5 * coarse * push), 7.7, 0.1 * 7.7);
}

TEST(OwnTrace, is_bounded_where_drag_is_stiff) {
    const OwnTrace trace = own_trace(Vec3(0.01, 0.0, 0.0), Vec3::Zero(), 1.0, rock_of(0.0, 1.0), k_water_viscosity, 0.0);
    EXPECT_NEAR(trace.velocity.x(), 0.005, 1e-15);
    EXPECT_TRUE(trace.is_limited);
    EXPECT_FALSE(own_trace(Vec3(0.01, 0.0, 0.0), Vec3::Zero(), 1e-7, rock_of(0.0, 1.0), k_water_viscosity, 0.0).is_limited);
}

TEST(OwnTrace, does_not_move_rock_that_moves_with_the_water) {
    const OwnTrace trace = own_trace(Vec3::Zero(), Vec3(1.0, 0.0, 0.0), 1e-5, rock_of(3e-6, 1.0), k_water_viscosity, 1e-3);
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
