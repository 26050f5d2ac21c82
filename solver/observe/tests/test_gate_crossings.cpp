// Crossings of gates by straight ways of centres.
#include <gtest/gtest.h>

#include "solver/observe/gate_crossings.hpp"

namespace cutterflow::coupling {
namespace {

std::vector<GateSettings> disc_and_rectangle() {
    GateSettings disc;
    disc.name = "disc";
    disc.centre = Vec3(0, 0, 1);
    disc.normal = Vec3(0, 0, -2);
    disc.radius = 0.1;
    GateSettings rectangle;
    rectangle.name = "rectangle";
    rectangle.rectangle = BoxRegion{Vec3(0.5, -1, 0), Vec3(0.5, 1, 0.2)};
    rectangle.normal = Vec3(1, 0, 0);
    return {disc, rectangle};
}

TEST(GateCrossings, tell_gate_sense_and_place) {
    const auto gates = disc_and_rectangle();
    const auto down = crossings(gates, Vec3(0.05, 0, 1.1), Vec3(0.05, 0, 0.7));
    ASSERT_EQ(down.size(), 1u);
    EXPECT_EQ(down[0].gate, 0u);
    EXPECT_EQ(down[0].sense, 1);
    EXPECT_NEAR(down[0].share, 0.25, 1e-15);
    EXPECT_NEAR((down[0].place - Vec3(0.05, 0, 1)).norm(), 0.0, 1e-15);
    EXPECT_EQ(crossings(gates, Vec3(0.05, 0, 0.7), Vec3(0.05, 0, 1.1)).at(0).sense, -1);
    const auto through_both = crossings(gates, Vec3(0.4, 0, 0.1), Vec3(0.6, 0, 0.1));
    ASSERT_EQ(through_both.size(), 1u);
    EXPECT_EQ(through_both[0].gate, 1u);
    EXPECT_EQ(through_both[0].sense, 1);
}

TEST(GateCrossings, count_nothing_beside_a_gate) {
    const auto gates = disc_and_rectangle();
    EXPECT_TRUE(crossings(gates, Vec3(0.11, 0, 1.1), Vec3(0.11, 0, 0.9)).empty());
    EXPECT_TRUE(crossings(gates, Vec3(0, 0, 1.3), Vec3(0, 0, 1.1)).empty());
    EXPECT_TRUE(crossings(gates, Vec3(0.4, 0, 0.3), Vec3(0.6, 0, 0.3)).empty());
    // The way begins beside the disc and goes through it, and the other way round.
    EXPECT_EQ(crossings(gates, Vec3(0.3, 0, 1.1), Vec3(-0.3, 0, 0.9)).size(), 1u);
    EXPECT_TRUE(crossings(gates, Vec3(0.0, 0, 1.1), Vec3(0.6, 0, 0.9)).empty());
}

// However a way is cut into steps, also on the plane itself, every crossing counts once.
TEST(GateCrossings, count_once_when_a_step_ends_on_the_plane) {
    const auto gates = disc_and_rectangle();
    const std::vector<double> heights{1.2, 1.0, 0.9, 1.0, 0.8, 1.0, 1.0, 1.3};
    int sum = 0, number = 0;
    for (std::size_t k = 1; k < heights.size(); ++k)
        for (const GateCrossing& crossing : crossings(gates, Vec3(0, 0, heights[k - 1]), Vec3(0, 0, heights[k]))) {
            sum += crossing.sense;
            ++number;
        }
    EXPECT_EQ(sum, 0) << "it is above again";
    EXPECT_EQ(number % 2, 0);
    EXPECT_GE(number, 2);
}

}  // namespace
}  // namespace cutterflow::coupling
