/// Damping of the water in gaps: a rate, relative to the contact, at everything that a body can touch.
#include <cmath>

#include <gtest/gtest.h>

#include "solver/free_surface/gap_damping.hpp"

namespace cutterflow::free_surface {
namespace {

constexpr double k_cell = 1e-3, k_radius = 5e-3, k_middle = 0.05;
const Vec3 k_drift(0.3, 0.0, -0.2);

StaggeredGrid tank() {
    return StaggeredGrid::plane(100, 100, k_cell, 0.1);
}

Body disc(double x, double z, const Vec3& velocity = Vec3::Zero()) {
    Body body;
    body.position = Vec3(x, k_middle, z);
    body.velocity = velocity;
    body.radius = k_radius;
    return body;
}

/// Particles everywhere, each with a velocity of its own around a drift.
WaterParticles water(const Vec3& drift, double spread, const StaggeredGrid& grid = tank()) {
    WaterParticles particles;
    fill_box(
        grid, Vec3::Constant(-1), Vec3::Constant(1), 0, [](const Vec3&) { return true; }, particles);
    for (std::size_t p = 0; p < particles.size(); ++p) {
        particles.velocity[0][p] = drift.x() + spread * std::sin(0.1 * static_cast<double>(p));
        particles.velocity[2][p] = drift.z() + spread * std::cos(0.3 * static_cast<double>(p));
    }
    return particles;
}

const GapDampingSettings k_half{0.5, 2.3e-4, 1e-3};

/// Momentum taken out of water that moves around resting solids.
double taken(const GapSolids& solids) {
    WaterParticles particles = water(k_drift, 0.0);
    return damp_gaps(k_half, tank(), solids, 1e-4, 1000.0, particles);
}

/// Two discs half a millimetre apart, far from the walls.
std::vector<Body> pair(const Vec3& velocity = Vec3::Zero()) {
    return {disc(0.04, 0.05, velocity), disc(0.0505, 0.05, velocity)};
}

TEST(GapDamping, two_half_steps_equal_one_step) {
    const std::vector<Body> bodies = pair(Vec3(0.1, 0.0, 0.0));
    const GapSolids solids{bodies, {}, {}, {}};
    WaterParticles once = water(k_drift, 0.1), twice = once;
    const double whole = damp_gaps(k_half, tank(), solids, 2e-4, 1000.0, once);
    double halves = 0.0;
    for (int n = 0; n < 2; ++n) halves += damp_gaps(k_half, tank(), solids, 1e-4, 1000.0, twice);
    EXPECT_GT(whole, 0.0);
    EXPECT_NEAR(halves, whole, 1e-12 * whole);
    for (std::size_t p = 0; p < once.size(); ++p) EXPECT_NEAR((once.speed(p) - twice.speed(p)).norm(), 0.0, 1e-14);
}

/// At the point beta is left of the velocity relative to the contact after the damping time, at two cells along the gap all of it.
TEST(GapDamping, leaves_beta_at_the_contact_and_all_at_two_cells) {
    const std::vector<Body> bodies = pair();
    WaterParticles particles = water(k_drift, 0.0);
    damp_gaps(k_half, tank(), {bodies, {}, {}, {}}, k_half.time, 1000.0, particles);
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const double across = std::abs(particles.position[0][p] - 0.04525), along = std::abs(particles.position[2][p] - 0.05);
        const bool in_band = across <= 1e-3 && along < 2e-3;
        const double share = in_band ? 0.5 + 0.5 * along / 2e-3 : 1.0;
        EXPECT_NEAR((particles.speed(p) - share * k_drift).norm(), 0.0, 1e-14);
    }
}

TEST(GapDamping, a_pile_that_moves_with_its_water_is_not_braked) {
    const std::vector<Body> bodies = pair(k_drift);
    WaterParticles particles = water(k_drift, 0.0);
    const WaterParticles before = particles;
    EXPECT_EQ(damp_gaps(k_half, tank(), {bodies, {}, {}, {}}, 1e-4, 1000.0, particles), 0.0);
    EXPECT_EQ(particles.velocity, before.velocity);
}

TEST(GapDamping, beta_1_changes_nothing) {
    const std::vector<Body> bodies = pair();
    WaterParticles particles = water(k_drift, 0.1);
    const WaterParticles before = particles;
    EXPECT_EQ(damp_gaps({1.0, 2.3e-4, 1e-3}, tank(), {bodies, {}, {}, {}}, 1e-4, 1000.0, particles), 0.0);
    EXPECT_EQ(particles.velocity, before.velocity);
}

/// A disc half a millimetre off the tank's wall, a box, a plate and a gate is braked there as at the tank's wall.
TEST(GapDamping, acts_at_walls_boxes_plates_and_gates_alike) {
    const std::vector<Body> at_wall{disc(k_radius + 0.5e-3, 0.05)}, inside{disc(0.0555, 0.05)};
    const double expected = taken({at_wall, {}, {}, {}}) * 2.0;  // of which the wall hides the half behind it
    const std::vector<StillSolid> box{SolidBox{Vec3(0.04, -1, 0.02), Vec3(0.05, 1, 0.08)}};
    const std::vector<StillSolid> upright{plate({0.05, 0.02}, {0.05, 0.08}, 0.01)};
    const std::vector<SolidBox> gate{{Vec3(0.04, -1, 0.02), Vec3(0.05, 1, 0.08)}};
    const std::vector<double> still{0.0}, rising{2.0 * k_drift.z()};
    EXPECT_GT(expected, 0.0);
    EXPECT_NEAR(taken({inside, box, {}, {}}), expected, 0.02 * expected);
    EXPECT_NEAR(taken({inside, upright, {}, {}}), expected, 0.02 * expected);
    EXPECT_NEAR(taken({inside, {}, gate, still}), expected, 0.02 * expected);
    EXPECT_LT(taken({inside, {}, gate, rising}), taken({inside, {}, gate, still}));  // the contact moves with its water
    EXPECT_EQ(taken({std::vector<Body>{disc(0.0565, 0.05)}, box, {}, {}}), 0.0);     // a gap and a half off
}

/// Across the tank nothing changes, as in a plane scene; at the walls at their ends cylinders have no gap.
TEST(GapDamping, of_cylinders_in_space_reaches_across_the_tank) {
    const StaggeredGrid space = StaggeredGrid::space(80, 12, 80, k_cell);
    const auto at = [](double x) {
        Body body = disc(x, 0.04);
        body.position.y() = 6e-3;
        return body;
    };
    const std::vector<Body> two{at(0.0301), at(0.0406)}, alone{at(0.03)}, plane{disc(0.0301, 0.04), disc(0.0406, 0.04)};
    WaterParticles particles = water(k_drift, 0.0, space);
    const double all = damp_gaps(k_half, space, {two, {}, {}, {}}, 1e-4, 1000.0, particles);
    std::array<int, 12> braked{};
    for (std::size_t p = 0; p < particles.size(); ++p)
        braked[static_cast<std::size_t>(particles.position[1][p] / k_cell)] += (particles.speed(p) - k_drift).norm() > 1e-9;
    for (const int count : braked) EXPECT_EQ(count, braked[0]);
    EXPECT_GT(braked[0], 0);
    EXPECT_NEAR(all / 0.012, taken({plane, {}, {}, {}}) / 0.1, 1e-9 * all / 0.012) << "of a length across";
    particles = water(k_drift, 0.0, space);
    EXPECT_EQ(damp_gaps(k_half, space, {alone, {}, {}, {}}, 1e-4, 1000.0, particles), 0.0);
}

}  // namespace
}  // namespace cutterflow::free_surface
