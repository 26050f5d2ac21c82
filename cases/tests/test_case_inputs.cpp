#include "cases/scenes/cutter/case_inputs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cases/testing/tiny_rotor_mesh.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::cases {
namespace {

/// The reference model: ring radius 0.40 m at 60 rpm, 0.12 m3/s through a mouth of 0.10 m radius.
CaseInputs model_cutter() {
    CaseInputs inputs(geometry::Contour({-0.485, -0.2, 0.0}, {0.15, 0.38, 0.40}, 0.40, 0.03));
    inputs.rotor.speed = rpm_to_rad_s(60.0);
    inputs.discharge = 0.12;
    inputs.fates.mouth.radius = 0.10;
    inputs.rock.emplace();
    fill_scaled_defaults(inputs);
    return inputs;
}

TEST(ScaledDefaults, match_the_reference_model) {
    const CaseInputs inputs = model_cutter();
    EXPECT_NEAR(inputs.fates.bin_width, 0.030, 1e-12);
    EXPECT_NEAR(inputs.outflow.offset, 0.015, 1e-12);
    EXPECT_NEAR(inputs.fates.mouth.depth, 0.20, 1e-12);
    EXPECT_NEAR(tip_speed(inputs), 2.0 * k_pi * 0.40, 1e-12);
    EXPECT_NEAR(mouth_speed(inputs), 0.12 / (k_pi * 0.01), 1e-12);
    EXPECT_NEAR(inputs.rock->contact.max_speed, 2.513274 + 3.819719, 1e-5);
}

TEST(ScaledDefaults, make_steel_and_rock_stiff_enough_for_the_tip_speed) {
    const CaseInputs inputs = model_cutter();
    const coupling::ContactSettings& contact = inputs.rock->contact;
    // A rock of 20 mm that hits a wall of the same modulus at the tip speed; added mass takes part.
    const double mass = (2650.0 + 0.5 * 998.2) * k_pi / 6.0 * std::pow(0.02, 3);
    const double modulus = contact.youngs_modulus / (2.0 - 0.24 * 0.24 - 0.27 * 0.27);
    EXPECT_NEAR(physics::hertz_largest_overlap({mass, 0.01, modulus, tip_speed(inputs)}) / 0.01, 0.05, 1e-9);
    EXPECT_NEAR(contact.youngs_modulus, 0.26e9, 0.005e9);
}

TEST(ScaledDefaults, make_stiffness_go_with_the_square_of_the_speed) {
    for (const double factor : {0.1, 10.0}) {
        CaseInputs inputs = model_cutter();
        inputs.rock->contact.youngs_modulus = 0.0;
        inputs.rotor.speed *= factor;
        fill_scaled_defaults(inputs);
        EXPECT_NEAR(inputs.rock->contact.youngs_modulus / model_cutter().rock->contact.youngs_modulus, factor * factor,
                    1e-9 * factor * factor);
    }
}

TEST(ScaledDefaults, keep_what_is_given) {
    CaseInputs inputs = model_cutter();
    inputs.fates.bin_width = 0.05;
    fill_scaled_defaults(inputs);
    EXPECT_EQ(inputs.fates.bin_width, 0.05);
}

TEST(ScaledDefaults, do_not_depend_on_the_sense_of_rotation) {
    CaseInputs backwards = model_cutter();
    backwards.rotor.speed = -backwards.rotor.speed;
    EXPECT_EQ(tip_speed(backwards), tip_speed(model_cutter()));
    EXPECT_NEAR(largest_time_step(backwards.rotor.speed) * std::abs(backwards.rotor.speed), k_pi / 180.0, 1e-15);
}

TEST(Gravity, stands_at_90_degrees_minus_inclination_from_the_axis) {
    const Vec3 g = gravity_of(30.0 * k_pi / 180.0);
    EXPECT_NEAR(g.norm(), 9.81, 1e-12);
    EXPECT_NEAR(std::acos(-g.z() / g.norm()) * 180.0 / k_pi, 60.0, 1e-9);
    EXPECT_GT(g.x(), 0.0);  // x is the lowest side
    EXPECT_EQ(g.y(), 0.0);  // the swing is horizontal
}

TEST(CaseInputs, of_the_test_rotor_are_right) {
    EXPECT_TRUE(check_case_inputs(test::tiny_inputs()).empty());
}

TEST(CaseInputs, report_every_broken_rule_at_once) {
    CaseInputs inputs = test::tiny_inputs();
    inputs.discharge = 0.0;
    inputs.rotor.speed = 0.0;
    inputs.tank.radius = 0.1;
    inputs.outflow.start_time = 5.0;
    inputs.rock.emplace();
    const std::vector<Mistake> mistakes = check_case_inputs(inputs);
    for (const char* name : {"discharge", "rotor speed", "tank radius", "outflow average", "youngsModulus", "maxSpeed", "DEM walls"}) {
        const bool told =
            std::any_of(mistakes.begin(), mistakes.end(), [&](const Mistake& m) { return m.what.find(name) != std::string::npos; });
        EXPECT_TRUE(told) << name;
    }
    EXPECT_EQ(mistakes.size(), 7u);
    for (const Mistake& mistake : mistakes) EXPECT_FALSE(mistake.rule.empty() || mistake.remedy.empty()) << mistake.what;
}

}  // namespace
}  // namespace cutterflow::cases
