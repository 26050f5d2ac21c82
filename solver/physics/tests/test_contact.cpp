// Hertz, Rayleigh and wet restitution against published and independently computed values.
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::physics {
namespace {

double sphere_mass(double radius, double density) {
    return 4.0 / 3.0 * k_pi * radius * radius * radius * density;
}

TEST(WetRestitution, follows_the_curve_of_legendre) {
    const double reference[][2] = {{10, 0.030}, {35, 0.368}, {100, 0.705}, {500, 0.932}, {2000, 0.983}};
    for (const auto& [stokes, ratio] : reference) EXPECT_NEAR(wet_restitution(1.0, stokes), ratio, 5e-4);
    EXPECT_EQ(wet_restitution(0.97, 0.0), 0.0);
}

TEST(WetRestitution, of_a_20_mm_rock_in_water) {
    const double reference[][2] = {{0.05, 0.878}, {0.1, 0.923}, {0.25, 0.951}, {1.0, 0.965}, {2.0, 0.968}};
    for (const auto& [speed, e] : reference)
        EXPECT_NEAR(wet_restitution(0.97, impact_stokes(2650.0 / 998.2, 0.5, speed, 0.02, 1.0034e-6)), e, 6e-4);
}

/// Restitution of delta'' = -max(0, delta^(3/2) + alpha delta^(1/4) delta'), integrated.
double integrated_restitution(double damping_factor) {
    double overlap = 0.0, speed = 1.0;  // into the wall
    const double step = 1e-5;
    do {
        overlap += 0.5 * step * speed;
        const double root = std::sqrt(overlap);
        speed -= step * std::max(0.0, root * overlap + damping_factor * std::sqrt(root) * speed);
        overlap += 0.5 * step * speed;
    } while (overlap > 0.0 && speed > -1.0);
    return -speed;
}

TEST(HertzDamping, returns_the_restitution_without_pulling) {
    for (const double e : {0.97, 0.9, 0.7, 0.5, 0.3, 0.2, 0.14})
        EXPECT_NEAR(integrated_restitution(hertz_damping_factor(e)), e, 1e-4) << "e = " << e;
    EXPECT_EQ(hertz_damping_factor(1.0), 0.0);
}

// Where hardly anything is lost, the pull at the end is negligible and Antypov and Elliott's factor is the same.
TEST(HertzDamping, nears_antypov_and_elliotts_for_little_loss) {
    const double log_e = std::log(0.999);
    EXPECT_NEAR(hertz_damping_factor(0.999), -std::sqrt(5.0) * log_e / k_pi, 1e-3 * hertz_damping_factor(0.999));
}

// Critical damping returns exp(-2) of the speed; close to it, d alpha / d ln e = -3/4 sqrt(5).
TEST(HertzDamping, of_the_smallest_restitution_is_below_critical) {
    const double expected = std::sqrt(5.0) * (1.0 - 0.75 * (std::log(k_smallest_restitution) + 2.0));
    EXPECT_NEAR(hertz_damping_factor(k_smallest_restitution), expected, 1e-3);
    EXPECT_LT(hertz_damping_factor(k_smallest_restitution), std::sqrt(5.0));
}

// Chung and Ooi's first benchmark: two equal limestone spheres, 10 mm, 20 m/s apart in all.
TEST(Hertz, meets_the_limestone_benchmark) {
    const double modulus = 20e9 / (2.0 * (1.0 - 0.25 * 0.25));
    const Impact impact{0.5 * sphere_mass(0.01, 2500.0), 0.005, modulus, 20.0};
    EXPECT_NEAR(hertz_largest_overlap(impact), 368.3e-6, 0.05e-6);
    EXPECT_NEAR(hertz_time(impact), 54.20e-6, 0.005e-6);
    const double force = 4.0 / 3.0 * modulus * std::sqrt(0.005) * std::pow(hertz_largest_overlap(impact), 1.5);
    EXPECT_NEAR(force, 7108.2, 0.1);
}

TEST(Rayleigh, of_soft_and_stiff_rock) {
    EXPECT_NEAR(rayleigh_time(0.01, 2650.0, 10e6, 0.24), 0.88e-3, 5e-6);
    EXPECT_NEAR(rayleigh_time(0.01, 2650.0, 60e9, 0.24), 11.4e-6, 5e-8);
}

TEST(YoungsModulus, for_five_percent_at_the_tip_of_the_model_cutter) {
    // 60 rpm at 0.4 m, dry rock on rigid steel: 0.11 GPa.
    EXPECT_NEAR(youngs_modulus_for_overlap(2650.0, 2.0 * k_pi * 0.4, 0.05, 1.0 - 0.24 * 0.24), 0.1108e9, 5e4);
}

TEST(YoungsModulus, inverts_the_largest_overlap_for_any_size) {
    for (const double radius : {0.001, 0.01, 0.5}) {
        const double compliance = (1.0 - 0.24 * 0.24) + (1.0 - 0.27 * 0.27);
        const double modulus = youngs_modulus_for_overlap(3149.1, 3.77, 0.05, compliance);
        const Impact impact{sphere_mass(radius, 3149.1), radius, modulus / compliance, 3.77};
        EXPECT_NEAR(hertz_largest_overlap(impact) / radius, 0.05, 1e-12);
    }
}

TEST(LinearContact, has_the_restitution_of_an_integrated_spring) {
    for (const double ratio : {0.2, 0.4, 0.566}) {
        for (const bool may_pull : {true, false}) {
            double place = 0.0, speed = 1.0;  // unit mass and stiffness, into the wall
            const double step = 1e-5;
            for (double force = 0.0;;) {
                force = -place - 2.0 * ratio * speed;
                if (place > 0.0 && (may_pull ? place + step * speed < 0.0 : force > 0.0)) break;
                speed += step * force;
                place += step * speed;
            }
            EXPECT_NEAR(-speed, linear_restitution(ratio, may_pull), 2e-4) << ratio << may_pull;
        }
    }
}

TEST(LinearContact, step_depends_on_the_reference_length_alone) {
    EXPECT_NEAR(linear_contact_step(0.01, 5e-4, 9.81, 150.0), 2.9905e-5, 3e-9);
}

}  // namespace
}  // namespace cutterflow::physics
