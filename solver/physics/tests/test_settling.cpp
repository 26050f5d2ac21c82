// Terminal speeds and the fall from rest of rock in water at 20 degrees, against values computed independently.
#include <algorithm>

#include <gtest/gtest.h>

#include "solver/physics/testing/fall_from_rest.hpp"

namespace cutterflow::physics {
namespace {

SettlingRock rock_in_water(double diameter, double solid_fraction = 0.0) {
    return {{diameter, 998.2, 1.0034e-6, 1.0 - solid_fraction}, 2650.0, 9.81};
}

TEST(TerminalSpeed, of_single_rocks) {
    const double reference[][3] = {{63e-6, 0.00339, 5e-6}, {1e-3, 0.1569, 5e-5},  {5e-3, 0.5229, 5e-5},
                                   {10e-3, 0.7358, 5e-5},  {20e-3, 0.9950, 5e-5}, {50e-3, 1.5251, 5e-5}};
    for (const auto& [diameter, speed, tolerance] : reference) EXPECT_NEAR(terminal_slip_speed(rock_in_water(diameter)), speed, tolerance);
}

TEST(TerminalSpeed, of_hindered_rock) {
    const double reference[][2] = {{0.02, 0.9694}, {0.05, 0.9314}, {0.10, 0.8689}, {0.155, 0.8015}, {0.20, 0.7475}, {0.30, 0.6312}};
    for (const auto& [solid_fraction, slip] : reference)
        EXPECT_NEAR(terminal_slip_speed(rock_in_water(0.02, solid_fraction)), slip, 5e-5) << solid_fraction;
}

TEST(TerminalSpeed, refuses_rock_that_floats) {
    SettlingRock cork = rock_in_water(0.01);
    cork.density = 200.0;
    EXPECT_THROW(terminal_slip_speed(cork), std::invalid_argument);
}

struct Milestone {
    double share, time, distance;
};

TEST(FallFromRest, passes_the_milestones_of_a_20_mm_rock) {
    const SettlingRock rock = rock_in_water(0.02);
    const double terminal = terminal_slip_speed(rock);
    const auto states = testing::fall_from_rest(rock, 0.5, 0.6, 1e-4);
    for (const Milestone& m : {Milestone{0.5, 0.1053, 0.0273}, {0.9, 0.2783, 0.155}, {0.95, 0.3452, 0.217}, {0.99, 0.4966, 0.364}}) {
        const auto passed =
            std::find_if(states.begin(), states.end(), [&](const testing::FallState& s) { return s.speed >= m.share * terminal; });
        ASSERT_NE(passed, states.end());
        EXPECT_NEAR(passed->time, m.time, 2e-4);
        EXPECT_NEAR(passed->distance, m.distance, 6e-4);
    }
}

}  // namespace
}  // namespace cutterflow::physics
