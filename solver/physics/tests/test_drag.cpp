// Drag and hindrance against values computed independently from the published formulas.
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/physics/catalogue.hpp"

namespace cutterflow::physics {
namespace {

struct DragPoint {
    double reynolds, cd, tolerance;
};

class BrownLawler : public ::testing::TestWithParam<DragPoint> {};

TEST_P(BrownLawler, has_the_published_value) {
    EXPECT_NEAR(find_drag_law("brown_lawler")({GetParam().reynolds}), GetParam().cd, GetParam().tolerance);
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
    EXPECT_NEAR(drag_coefficient_per_slip(rock, 0.0, find_drag_law("brown_lawler"), di_felice_factor), stokes, 1e-6 * stokes);
}

TEST(Drag, is_half_rho_cd_area_speed_in_pure_fluid) {
    const RockInFluid rock{0.02, 998.2, 1.0034e-6, 1.0};
    const double speed = 0.7;
    const double cd = find_drag_law("brown_lawler")({speed * 0.02 / 1.0034e-6});
    const double expected = 0.5 * 998.2 * cd * k_pi / 4.0 * 4e-4 * speed;
    EXPECT_NEAR(drag_coefficient_per_slip(rock, speed, find_drag_law("brown_lawler"), di_felice_factor), expected, 1e-12 * expected);
    EXPECT_NEAR(drag_coefficient_per_slip(rock, speed, find_drag_law("brown_lawler"), di_felice_factor, 3.0), 3.0 * expected,
                1e-12 * expected);
}

TEST(Drag, hindrance_sees_the_void_fraction_in_its_reynolds_number) {
    const RockInFluid rock{0.02, 998.2, 1.0034e-6, 0.7};
    RockInFluid free = rock;
    free.void_fraction = 1.0;
    const double speed = 0.002;  // Re about 40, where the exponent varies
    const double ratio = drag_coefficient_per_slip(rock, speed, find_drag_law("brown_lawler"), di_felice_factor) /
                         drag_coefficient_per_slip(free, speed, find_drag_law("brown_lawler"), di_felice_factor);
    EXPECT_NEAR(ratio, di_felice_factor(0.7, 0.7 * speed * 0.02 / 1.0034e-6), 1e-12);
}

TEST(SchillerNaumann, has_the_published_values) {
    for (const auto& [re, cd] :
         {std::pair(0.1, 247.4012061), std::pair(100.0, 1.091731091), std::pair(500.0, 0.5626653016), std::pair(5e3, 0.44)})
        EXPECT_NEAR(find_drag_law("schiller_naumann")({re}), cd, 1e-9 * cd);
}

TEST(HaiderLevenspiel, has_the_published_values) {
    struct Point {
        double reynolds, sphericity, cd;
    };
    for (const Point& p : {Point{0.1, 1.0, 247.481611}, Point{100, 1.0, 0.936848167}, Point{1e4, 1.0, 0.503243506},
                           Point{100, 0.8, 1.304186524}, Point{1e4, 0.67, 2.476264965}})
        EXPECT_NEAR(find_drag_law("haider_levenspiel")({p.reynolds, 1.0, p.sphericity}), p.cd, 1e-8 * p.cd);
}

TEST(HaiderLevenspiel, takes_the_drag_modifier) {
    const RockInFluid gravel{0.02, 998.2, 1.0034e-6, 1.0, 0.8};
    const double cd = find_drag_law("haider_levenspiel")({0.5 * 0.02 / 1.0034e-6, 1.0, 0.8});
    EXPECT_NEAR(drag_coefficient_per_slip(gravel, 0.5, find_drag_law("haider_levenspiel"), no_hindrance, 3.0),
                3.0 * 0.5 * 998.2 * cd * k_pi / 4.0 * 4e-4 * 0.5, 1e-12);
}

/// Force [N] on one rock of 2 mm in water from the published exchange coefficients beta of model A, V beta w / (1 - a).
struct ModelAForce {
    double void_fraction, slip, force;
};

void expect_model_b_form(DragLaw drag, const ModelAForce& published) {
    const RockInFluid rock{0.002, 998.2, 1.0034e-6, published.void_fraction};
    const double expected = published.force / published.void_fraction;
    EXPECT_NEAR(drag_coefficient_per_slip(rock, published.slip, drag, no_hindrance) * published.slip, expected, 1e-8 * expected);
}

TEST(Gidaspow, is_the_published_force_over_the_void_fraction) {
    for (const ModelAForce& f :
         {ModelAForce{0.45, 0.01, 2.288781616e-06}, ModelAForce{0.45, 0.3, 0.0003869611338}, ModelAForce{0.8, 0.1, 4.051919082e-05},
          ModelAForce{0.9, 0.1, 1.573032966e-05}, ModelAForce{0.9, 0.8, 0.0005253756647}})
        expect_model_b_form(find_drag_law("gidaspow"), f);
}

TEST(Gidaspow, gives_a_fixed_bed_the_pressure_drop_of_ergun) {
    // The solver's fluid feels the full pressure gradient: dp/dz = number of rocks per volume times force on each.
    const double a = 0.45, d = 0.002, mu = 998.2 * 1.0034e-6, superficial = 0.02, slip = superficial / a;
    const double ergun = 150.0 * mu * (1 - a) * (1 - a) / (a * a * a * d * d) * superficial +
                         1.75 * 998.2 * (1 - a) / (a * a * a * d) * superficial * superficial;
    const double force = drag_coefficient_per_slip({d, 998.2, 1.0034e-6, a}, slip, find_drag_law("gidaspow"), no_hindrance) * slip;
    EXPECT_NEAR((1.0 - a) / sphere_volume(d) * force, ergun, 1e-12 * ergun);
}

TEST(Gidaspow, jumps_where_ergun_and_wen_yu_meet) {
    const auto ratio = [](double re) { return find_drag_law("gidaspow")({re, 0.8}) / find_drag_law("gidaspow")({re, 0.8 + 1e-12}); };
    EXPECT_NEAR(ratio(1e-6), 62.5 / (24.0 * std::pow(0.8, -3.65)), 1e-4);
    EXPECT_NEAR(ratio(1e7), 4.0 / 3.0 * 1.75 / 0.8 / (0.44 * std::pow(0.8, -2.65)), 1e-4);
}

TEST(KochHill, is_the_published_force_over_the_void_fraction) {
    for (const ModelAForce& f : {ModelAForce{0.45, 0.01, 2.554604351e-06}, ModelAForce{0.6, 0.05, 1.087000916e-05},
                                 ModelAForce{0.7, 0.02, 2.440350152e-06}, ModelAForce{0.95, 0.05, 6.002408262e-06}})
        expect_model_b_form(find_drag_law("koch_hill"), f);
}

TEST(KochHill, tends_to_stokes_for_a_rock_alone) {
    EXPECT_NEAR(find_drag_law("koch_hill")({1e-6, 1.0}) * 1e-6, 24.0, 1e-5);
}

// A decaying vortex array of Taylor and Green, u = e^(-2 nu k^2 t) (sin kx cos ky, -cos kx sin ky, 0), with pressure
// p/rho = e^(-4 nu k^2 t)/4 (cos 2kx + cos 2ky), solves Navier-Stokes.
TEST(ViscousForce, is_the_fluid_acceleration_force_less_that_of_the_pressure_gradient) {
    const double nu = 0.1, k = 2.0, x = 0.3, y = 0.7, t = 0.2, e = std::exp(-2.0 * nu * k * k * t), volume = 1e-6, rho = 1000.0;
    const Vec3 u = e * Vec3(std::sin(k * x) * std::cos(k * y), -std::cos(k * x) * std::sin(k * y), 0.0);
    const Vec3 convection = 0.5 * k * e * e * Vec3(std::sin(2 * k * x), std::sin(2 * k * y), 0.0);
    const Vec3 acceleration = -2.0 * nu * k * k * u + convection;
    const Vec3 pressure_gradient = -0.5 * k * e * e * Vec3(std::sin(2 * k * x), std::sin(2 * k * y), 0.0);
    const Vec3 stress_divergence = -2.0 * nu * k * k * u;
    const Vec3 rest = fluid_acceleration_force(volume, rho, 0.0, acceleration) - viscous_force(volume, rho, stress_divergence);
    EXPECT_LE((rest + volume * rho * pressure_gradient).norm(), 1e-12 * rest.norm());
}

TEST(FluidAcceleration, carries_the_displaced_fluid_and_its_added_mass) {
    const Vec3 force = fluid_acceleration_force(2e-6, 1000.0, 0.5, Vec3(1.0, -2.0, 4.0));
    EXPECT_NEAR((force - Vec3(3e-3, -6e-3, 12e-3)).norm(), 0.0, 1e-15);
}

}  // namespace
}  // namespace cutterflow::physics
