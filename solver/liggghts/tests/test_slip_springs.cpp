#include "solver/liggghts/contacts/slip_springs.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace cutterflow::liggghts {
namespace {

/// The part of the contact's radius from `inner` to `outer` [m] that a spring covers.
struct Part {
    double inner = 0.0, outer = 0.0;
    double length() const { return outer - inner; }
};

Part part_of(int spring, double width, double contact_radius) {
    const double inner = std::min(spring * width, contact_radius);
    return {inner, spring + 1 < k_springs ? std::min((spring + 1) * width, contact_radius) : contact_radius};
}

double bounded(Vec3& vector, double limit) {
    const double squared = vector.squaredNorm();
    const double share = squared > limit * limit ? limit / std::sqrt(squared) : 1.0;
    vector *= share;
    return share;
}

/// As add_slip_force, one spring after the other.
void add_one_by_one(const SlipSprings& springs, const Vec3& normal, const Vec3& slip_velocity, double time_step, SlipMemory& memory,
                    Vec3& force) {
    const double per_radius = 1.0 / springs.contact_radius;
    SlipMemory now;
    now.contact_radius = springs.contact_radius;
    for (int spring = 0; spring < k_springs; ++spring) {
        const Part part = part_of(spring, springs.width, springs.contact_radius);
        if (part.length() <= 0.0) continue;
        const double kept = std::min(1.0, part_of(spring, springs.width, memory.contact_radius).length() / part.length());
        Vec3 stretch = kept * memory.stretch_of(spring) + slip_velocity * time_step;
        stretch -= normal * normal.dot(stretch);
        const double x = part.inner * per_radius, y = part.outer * per_radius;
        const double limit = springs.limit * (1.5 * (y - x) - 0.5 * (y * y * y - x * x * x));
        Vec3 of_spring = -(springs.stiffness * part.length()) * stretch;
        const double share = bounded(of_spring, limit);
        stretch *= share;
        if (share == 1.0) {
            of_spring -= springs.damping * per_radius * part.length() * slip_velocity;
            bounded(of_spring, limit);
        }
        force += of_spring;
        now.set_stretch(spring, stretch);
    }
    if (time_step > 0.0) memory = now;
}

/// A contact that grows, shrinks and turns while its surfaces slip to and fro.
class Slipping {
public:
    explicit Slipping(unsigned seed) : random_(seed) {}

    void step(double speed) {
        springs.width = 1e-4;
        springs.contact_radius = std::clamp(springs.contact_radius + 2e-5 * normal_(random_), 1e-5, 6e-4);
        springs.stiffness = 3e6;
        springs.damping = 20.0 * springs.contact_radius;
        springs.limit = 0.3 * springs.contact_radius / 1e-4;
        normal = (normal + 0.02 * vector()).normalized();
        slip_velocity = speed * vector();
        slip_velocity -= normal * normal.dot(slip_velocity);
    }

    SlipSprings springs{2e-4, 0.0, 0.0, 0.0, 0.0};
    Vec3 normal = Vec3::UnitZ(), slip_velocity = Vec3::Zero();

private:
    Vec3 vector() { return {normal_(random_), normal_(random_), normal_(random_)}; }

    std::mt19937 random_;
    std::normal_distribution<double> normal_;
};

/// \param speed  [m/s]: what sticks, what slips in part, what slips
class SlipSpringsAt : public testing::TestWithParam<double> {};

TEST_P(SlipSpringsAt, side_by_side_give_what_they_give_one_by_one) {
    constexpr double step = 1e-5;
    Slipping contact(7);
    SlipMemory together, one_by_one;
    for (int k = 0; k < 2000; ++k) {
        contact.step(GetParam());
        Vec3 force(1, 2, 3), expected = force;
        add_slip_force(contact.springs, contact.normal, contact.slip_velocity, step, together, force);
        add_one_by_one(contact.springs, contact.normal, contact.slip_velocity, step, one_by_one, expected);
        const double size = expected.norm();
        ASSERT_NEAR((force - expected).norm(), 0.0, 1e-13 * size) << "step " << k;
        for (int spring = 0; spring < k_springs; ++spring)
            ASSERT_NEAR((together.stretch_of(spring) - one_by_one.stretch_of(spring)).norm(), 0.0, 1e-18) << "step " << k;
    }
}

INSTANTIATE_TEST_SUITE_P(Speeds, SlipSpringsAt, testing::Values(1e-4, 1e-2, 1.0));

TEST(SlipSprings, without_a_step_the_memory_stays) {
    Slipping contact(3);
    SlipMemory memory;
    contact.step(0.01);
    Vec3 force = Vec3::Zero();
    add_slip_force(contact.springs, contact.normal, contact.slip_velocity, 1e-5, memory, force);
    const SlipMemory before = memory;
    contact.step(0.01);
    add_slip_force(contact.springs, contact.normal, contact.slip_velocity, 0.0, memory, force);
    EXPECT_EQ(memory.contact_radius, before.contact_radius);
    for (int spring = 0; spring < k_springs; ++spring) EXPECT_EQ(memory.stretch_of(spring), before.stretch_of(spring));
}

}  // namespace
}  // namespace cutterflow::liggghts
