#include "solver/liggghts/contacts/contact_law.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "geometry/base/axis_frame.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::liggghts {
namespace {

Contact rock_on_steel() {
    Contact contact;
    contact.normal = Vec3(0, 0, 1);
    contact.overlap = 1e-4;
    contact.radius = 0.01;
    contact.mass = 0.0132;
    contact.elastic = elastic_pair(1.1e8, 0.24, 0.27);
    contact.friction = 0.15;
    return contact;
}

TEST(ContactLaw, elastic_constants_of_equal_materials_have_their_closed_form) {
    const ElasticPair pair = elastic_pair(1.1e8, 0.24, 0.24);
    EXPECT_NEAR(pair.youngs, 1.1e8 / (2.0 * (1.0 - 0.24 * 0.24)), 1e-6);
    const double shear_modulus = 1.1e8 / (2.0 * 1.24);
    EXPECT_NEAR(pair.shear, shear_modulus / (2.0 * (2.0 - 0.24)), 1e-6);
}

double normal_force_of(const Contact& contact) {
    return 4.0 / 3.0 * contact.elastic.youngs * std::sqrt(contact.radius) * std::pow(contact.overlap, 1.5);
}

double contact_radius_of(const Contact& contact) {
    return std::sqrt(contact.radius * contact.overlap);
}

/// Speed with which an impact reaches the contact's overlap.
double speed_for(const Contact& contact) {
    return std::sqrt(16.0 / 15.0 * contact.elastic.youngs * std::sqrt(contact.radius) * std::pow(contact.overlap, 2.5) / contact.mass);
}

/// Moves the surfaces by `way` along x in one step and returns the force.
Vec3 slip_by(double way, Contact contact, SlipMemory& memory) {
    constexpr double step = 1e-6;
    contact.slip_velocity = Vec3(way / step, 0, 0);
    return contact_force(contact, step, memory);
}

TEST(ContactLaw, the_elastic_force_is_that_of_hertz) {
    const Contact contact = rock_on_steel();
    SlipMemory memory;
    const Vec3 force = contact_force(contact, 1e-5, memory);
    EXPECT_NEAR(force.z(), normal_force_of(contact), 1e-12);
    EXPECT_EQ(force.head<2>().norm(), 0.0);
}

/// Before anything is stretched the damper alone resists.
TEST(ContactLaw, slip_is_damped_no_more_than_a_step_resolves) {
    Contact contact = rock_on_steel();
    contact.damping_factor = 2.0;
    contact.friction = 1e6;
    contact.slip_velocity = Vec3(0.1, 0, 0);
    const auto resistance = [&] {
        SlipMemory memory;
        return -contact_force(contact, 0.0, memory).x() / contact.slip_velocity.x();
    };
    const double whole = contact.damping_factor * std::sqrt(contact.mass * 4.0 / 3.0 * contact.elastic.youngs * contact_radius_of(contact));
    EXPECT_NEAR(resistance(), whole, 1e-9 * whole);
    contact.most_slip_damping = resolved_slip_damping(contact.mass, 1e-4);
    ASSERT_LT(contact.most_slip_damping, whole);
    EXPECT_NEAR(resistance(), contact.mass / 2e-3, 1e-9 * whole);
}

TEST(ContactLaw, damping_resists_approach_and_separation_and_never_pulls) {
    Contact contact = rock_on_steel();
    contact.damping_factor = physics::hertz_damping_factor(0.3);
    SlipMemory memory;
    const double elastic = contact_force(contact, 0.0, memory).z();
    contact.normal_speed = -0.01;
    const double approaching = contact_force(contact, 0.0, memory).z();
    contact.normal_speed = 0.01;
    const double separating = contact_force(contact, 0.0, memory).z();
    EXPECT_GT(approaching, elastic);
    EXPECT_NEAR(approaching + separating, 2.0 * elastic, 1e-12 * elastic);
    contact.normal_speed = 1.0;
    contact.slip_velocity = Vec3(1.0, 0, 0);
    EXPECT_EQ(contact_force(contact, 1e-5, memory), Vec3(Vec3::Zero()));
}

// Integrated without LIGGGHTS: the law returns the restitution that its damping factor was made for.
TEST(ContactLaw, a_normal_impact_returns_the_restitution) {
    for (const double restitution : {0.14, 0.3, 0.6, 0.9, 1.0}) {
        Contact contact = rock_on_steel();
        contact.damping_factor = physics::hertz_damping_factor(restitution);
        double overlap = 0.0, speed = 1.0;  // into the wall
        const double step = 1e-8;
        SlipMemory memory;
        do {
            overlap += step * speed;
            contact.overlap = std::max(overlap, 0.0);
            contact.normal_speed = -speed;
            speed -= step * contact_force(contact, 0.0, memory).z() / contact.mass;
        } while (overlap > 0.0);
        EXPECT_NEAR(-speed, restitution, 1e-3) << "e = " << restitution;
    }
}

/// Ratio of speeds of a sphere of mass `contact.mass` that falls on a wall with `speed`, in steps as RockMotion's.
/// \param before  part of a step before the touch [0, 1) \param force  of the law
template <typename Force>
double bounce(Contact contact, double speed, double step, double before, const Force& force) {
    SlipMemory memory;
    double overlap = -before * speed * step, velocity = -speed, acceleration = 0.0;
    bool touched = false;
    do {
        overlap -= step * (velocity + 0.5 * step * acceleration);
        const double predicted = velocity + step * acceleration;
        double next = 0.0;
        if (overlap > 0.0) {
            contact.overlap = overlap;
            contact.normal_speed = predicted;
            contact.begins = !touched;
            next = force(contact, step, memory).z() / contact.mass;
            touched = true;
        }
        velocity = predicted + 0.5 * step * (next - acceleration);
        acceleration = next;
    } while (!touched || overlap > 0.0);
    return velocity / speed;
}

constexpr int k_beginnings = 100;

double beginning(int n) {
    return (n + 0.5) / k_beginnings;
}

// Steps of a tenth of the Rayleigh time, as shipped. Counted whole, damping in the step of the first touch puts 0.5 off by up to 0.0037.
TEST(ContactLaw, an_impact_returns_the_same_wherever_in_a_step_it_begins) {
    constexpr double density = 3150.0;  // of a sphere of 20 mm and the contact's mass
    for (const double restitution : {0.3, 0.5, 0.9}) {
        Contact contact = rock_on_steel();
        contact.friction = 0.0;
        contact.damping_factor = physics::hertz_damping_factor(restitution);
        const double step = 0.1 * physics::rayleigh_time(contact.radius, density, 1.1e8, 0.24);
        for (int n = 0; n < k_beginnings; ++n) EXPECT_NEAR(bounce(contact, 1.0, step, beginning(n), contact_force), restitution, 2e-3) << n;
    }
}

// Under a constant normal force: s = 3 mu F_n / (16 G* a) (1 - (1 - F_t / (mu F_n))^(2/3)) until all slips. Four springs are a chain of
// straight lines beside that curve, 2.1 % of the limit apart at most, and twice as much where the way back has twice the size.
TEST(ContactLaw, slip_begins_at_the_edge_as_cattaneo_and_mindlin_have_it) {
    Contact contact = rock_on_steel();
    contact.impact_radius = impact_radius(contact.elastic, contact.radius, contact.mass, speed_for(contact));
    const double limit = 0.15 * normal_force_of(contact);
    const double full_slip = 3.0 * limit / (16.0 * contact.elastic.shear * contact_radius_of(contact));
    SlipMemory memory;
    slip_by(0.0, contact, memory);
    for (int k = 1; k <= 20; ++k) {
        const double found = -slip_by(0.05 * full_slip, contact, memory).x();
        EXPECT_NEAR(found, limit * (1.0 - std::pow(1.0 - 0.05 * k, 1.5)), 0.021 * limit) << "at " << 5 * k << " %";
    }
    // Back again: Mindlin and Deresiewicz' loop, twice the way for twice the force.
    for (int k = 1; k <= 20; ++k) {
        const double found = -slip_by(-0.1 * full_slip, contact, memory).x();
        EXPECT_NEAR(found, limit * (1.0 - 2.0 * (1.0 - std::pow(1.0 - 0.05 * k, 1.5))), 0.042 * limit) << "back at " << 5 * k << " %";
    }
}

// Without an impact speed one spring takes all: Mindlin's stiffness up to Coulomb's limit.
TEST(ContactLaw, a_contact_without_impact_sticks_with_mindlins_stiffness) {
    const Contact contact = rock_on_steel();
    const double stiffness = 8.0 * contact.elastic.shear * contact_radius_of(contact), limit = 0.15 * normal_force_of(contact);
    SlipMemory memory;
    slip_by(0.0, contact, memory);
    EXPECT_NEAR(slip_by(0.9 * limit / stiffness, contact, memory).x(), -0.9 * limit, 1e-9 * limit);
    EXPECT_NEAR(slip_by(0.2 * limit / stiffness, contact, memory).x(), -limit, 1e-9 * limit);
    EXPECT_NEAR(slip_by(-0.5 * limit / stiffness, contact, memory).x(), -0.5 * limit, 1e-9 * limit);
}

// Area that touches later has not been stretched, and area that parts takes its force along: here within the third spring alone.
TEST(ContactLaw, a_growing_contact_keeps_its_tangential_force_and_a_shrinking_one_loses_some) {
    Contact contact = rock_on_steel();
    contact.friction = 10.0;
    const double before = contact_radius_of(contact), width = before / 2.2, after = 2.8 * width;
    contact.overlap = std::pow(k_springs * width, 2) / contact.radius;  // what the impact reaches
    contact.impact_radius = impact_radius(contact.elastic, contact.radius, contact.mass, speed_for(contact));
    contact.overlap = before * before / contact.radius;
    SlipMemory memory;
    slip_by(0.0, contact, memory);
    const double held = slip_by(1e-7, contact, memory).x();
    contact.overlap = after * after / contact.radius;
    EXPECT_NEAR(slip_by(0.0, contact, memory).x(), held, 1e-9 * std::abs(held));
    contact.overlap = before * before / contact.radius;
    // The third spring's 0.2 widths of force were spread over 0.8 and three quarters of them part.
    EXPECT_NEAR(slip_by(0.0, contact, memory).x(), held * (2.0 + 0.2 * 0.25) / 2.2, 1e-9 * std::abs(held));
}

TEST(ContactLaw, what_slides_carries_coulombs_limit) {
    Contact contact = rock_on_steel();
    contact.impact_radius = impact_radius(contact.elastic, contact.radius, contact.mass, speed_for(contact));
    SlipMemory memory;
    Vec3 force = Vec3::Zero();
    for (int k = 0; k < 100; ++k) force = slip_by(1e-5, contact, memory);
    EXPECT_NEAR(force.x(), -0.15 * force.z(), 1e-12 * force.z());
}

TEST(ContactLaw, the_springs_stay_in_the_plane) {
    Contact contact = rock_on_steel();
    SlipMemory memory;
    memory.contact_radius = contact_radius_of(contact);
    memory.stretch[2][k_springs - 1] = 5e-5;  // from a plane that has turned since
    slip_by(0.0, contact, memory);
    EXPECT_EQ(memory.stretch[2][k_springs - 1], 0.0);
}

TEST(ContactLaw, no_step_leaves_the_memory) {
    Contact contact = rock_on_steel();
    contact.slip_velocity = Vec3(1.0, 0, 0);
    SlipMemory memory;
    memory.stretch[0][0] = 1e-7;
    contact_force(contact, 0.0, memory);
    EXPECT_EQ(memory.stretch[0][0], 1e-7);
    EXPECT_EQ(memory.contact_radius, 0.0);
}

Contact rolling_rock() {
    Contact contact = rock_on_steel();
    contact.rolling_friction = 0.2;
    return contact;
}

double rolling_stiffness_of(const Contact& contact) {
    return 8.0 * contact.elastic.shear * contact_radius_of(contact) * contact.radius * contact.radius;
}

Rolling rolling_with(const Vec3& spin, double twist = 0.0) {
    return {spin, twist, 1.4 * 0.0132 * 1e-4};
}

constexpr double k_step = 1e-6;

/// Rolls by `angle` about y in one step without damping.
Vec3 roll_by(double angle, const Contact& contact, RollMemory& memory) {
    Rolling rolling = rolling_with(Vec3(0, angle / k_step, 0));
    rolling.inertia = 0.0;
    return rolling_couple(RollingLaw::spring, contact, rolling, normal_force_of(contact), k_step, memory);
}

TEST(RollingFriction, is_a_spring_up_to_the_largest_couple) {
    const Contact contact = rolling_rock();
    const double stiffness = rolling_stiffness_of(contact), limit = 0.2 * normal_force_of(contact) * contact.radius;
    RollMemory memory;
    EXPECT_NEAR(roll_by(0.9 * limit / stiffness, contact, memory).y(), -0.9 * limit, 1e-9 * limit);
    EXPECT_NEAR(roll_by(0.2 * limit / stiffness, contact, memory).y(), -limit, 1e-9 * limit);
    EXPECT_NEAR(roll_by(-0.5 * limit / stiffness, contact, memory).y(), -0.5 * limit, 1e-9 * limit);
}

TEST(RollingFriction, is_damped_below_the_largest_couple_alone) {
    const Contact contact = rolling_rock();
    const double force = normal_force_of(contact), limit = 0.2 * force * contact.radius, stiffness = rolling_stiffness_of(contact);
    const Rolling slow = rolling_with(Vec3(0, 1e-3, 0));
    RollMemory none;
    const double damping = 0.6 * std::sqrt(slow.inertia * stiffness);
    EXPECT_NEAR(rolling_couple(RollingLaw::spring, contact, slow, force, 0.0, none).y(), -damping * 1e-3, 1e-9 * damping * 1e-3);
    Rolling limited = slow;
    limited.most_damping = 0.3 * damping;
    EXPECT_NEAR(rolling_couple(RollingLaw::spring, contact, limited, force, 0.0, none).y(), -0.3e-3 * damping, 1e-9 * damping * 1e-3);
    RollMemory rolled;
    roll_by(2.0 * limit / stiffness, contact, rolled);
    EXPECT_NEAR(rolling_couple(RollingLaw::spring, contact, rolling_with(Vec3(0, 10, 0)), force, k_step, rolled).y(), -limit,
                1e-12 * limit);
}

TEST(RollingFriction, of_constant_couple_opposes_any_rolling) {
    const Contact contact = rolling_rock();
    const double limit = 0.2 * normal_force_of(contact) * contact.radius;
    RollMemory memory;
    const auto couple = [&](const Vec3& spin) {
        return rolling_couple(RollingLaw::constant, contact, rolling_with(spin), normal_force_of(contact), k_step, memory);
    };
    EXPECT_NEAR((couple(Vec3(3e-9, 4e-9, 1.0)) + limit * Vec3(0.6, 0.8, 0.0)).norm(), 0.0, 1e-9 * limit);
    EXPECT_EQ(couple(Vec3(0, 0, 1.0)), Vec3(Vec3::Zero())) << "what turns about the normal does not roll";
}

TEST(RollingFriction, grows_with_the_contact_without_more_couple_and_shrinks_with_less) {
    Contact contact = rolling_rock();
    const Contact large = [&] {
        Contact grown = contact;
        grown.overlap *= 4.0;
        return grown;
    }();
    const double limit = 0.2 * normal_force_of(contact) * contact.radius;
    RollMemory memory;
    const double held = roll_by(0.2 * limit / rolling_stiffness_of(contact), contact, memory).y();
    EXPECT_NEAR(roll_by(0.0, large, memory).y(), held, 1e-9 * std::abs(held));
    EXPECT_NEAR(roll_by(0.0, contact, memory).y(), 0.5 * held, 1e-9 * std::abs(held));
}

// Work done on the contact, less what its spring holds, never falls: over any way of rolling and loading.
TEST(RollingFriction, never_gives_energy_back_that_it_did_not_get) {
    Contact contact = rolling_rock();
    const double overlap = contact.overlap;
    RollMemory memory;
    double work = 0.0, least = 0.0;
    for (int k = 0; k < 20000; ++k) {
        contact.overlap = overlap * (1.0 + 0.9 * std::sin(0.003 * k) * std::cos(0.0007 * k));
        const Vec3 spin(20.0 * std::sin(0.011 * k), 30.0 * std::cos(0.017 * k), 5.0);
        const Vec3 before = Vec3(memory.angle) * std::min(1.0, memory.contact_radius / contact_radius_of(contact));
        const Vec3 couple = rolling_couple(RollingLaw::spring, contact, rolling_with(spin), normal_force_of(contact), k_step, memory);
        // The spring is taken at the step's end; its mean over the step is less by half its growth.
        const Vec3 mean = couple + 0.5 * rolling_stiffness_of(contact) * (Vec3(memory.angle) - before);
        work -= mean.dot(spin) * k_step;
        const double held = 0.5 * rolling_stiffness_of(contact) * Vec3(memory.angle).squaredNorm();
        least = std::min(least, work - held);
    }
    EXPECT_GT(work, 0.0);
    EXPECT_GT(least, -1e-6 * work);
}

// The same way of rolling, seen from a frame that turns, gives the same couple, turned.
TEST(RollingFriction, does_not_depend_on_the_frame) {
    const Contact still = rolling_rock();
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(Vec3(1, 2, 2) / 3.0)}) {
        RollMemory in_still, in_turning;
        const double rate = 0.5 * k_pi / (20000 * k_step);
        Vec3 couple, turned;
        for (int k = 0; k < 20000; ++k) {
            const Eigen::AngleAxisd turn(rate * k_step * k, axis);
            const Vec3 spin(0.02 * std::cos(2e-4 * k), 0.04, 0.0);  // the couple stays below its limit: all of it is remembered
            Contact turning = still;
            turning.normal = turn * still.normal;
            couple = rolling_couple(RollingLaw::spring, still, rolling_with(spin), normal_force_of(still), k_step, in_still);
            turned = rolling_couple(RollingLaw::spring, turning, rolling_with(turn * spin, rate * axis.dot(turning.normal)),
                                    normal_force_of(still), k_step, in_turning);
            turned = turn.inverse() * turned;
        }
        EXPECT_LT((turned - couple).norm(), 5e-4 * couple.norm()) << axis.transpose();
    }
}

TEST(RollingFriction, leaves_its_memory_without_a_step) {
    RollMemory memory;
    memory.angle[0] = 1e-6;
    rolling_couple(RollingLaw::spring, rolling_rock(), rolling_with(Vec3(1, 0, 0)), 1.0, 0.0, memory);
    EXPECT_EQ(memory.angle[0], 1e-6);
    EXPECT_EQ(memory.contact_radius, 0.0);
}

Contact linear_touch() {
    Contact contact;
    contact.normal = Vec3(0, 0, 1);
    contact.overlap = 1e-4;
    contact.mass = 2.0;
    contact.friction = 0.3;
    return contact;
}

const LinearLaw k_linear{1e6, 0.4, 0.5 / 1.3, true, false};

TEST(LinearContactLaw, is_spring_and_dashpot_that_does_not_pull) {
    Contact contact = linear_touch();
    SlipMemory memory;
    EXPECT_NEAR(linear_contact_force(k_linear, contact, 1e-5, memory).z(), 2e6 * 1e-4, 1e-9);
    contact.normal_speed = -0.1;
    EXPECT_NEAR(linear_contact_force(k_linear, contact, 1e-5, memory).z(), 200.0 + 0.8 * 2.0 * 1e3 * 0.1, 1e-9);
    contact.normal_speed = 10.0;
    EXPECT_EQ(linear_contact_force(k_linear, contact, 1e-5, memory).z(), 0.0);
    LinearLaw pulling = k_linear;
    pulling.may_pull = true;
    EXPECT_LT(linear_contact_force(pulling, contact, 1e-5, memory).z(), 0.0);
}

/// Part of the beginnings at which a pair's restitution is within 0.001 of `expected`, at 150 steps a period.
double share_of_true_bounces(const LinearLaw& law, double expected) {
    Contact contact = linear_touch();
    contact.friction = 0.0;
    const double step = 2.0 * k_pi / std::sqrt(law.stiffness) / 150.0;
    const auto force = [&](const Contact& touch, double time_step, SlipMemory& memory) {
        return linear_contact_force(law, touch, time_step, memory);
    };
    int within = 0;
    for (int n = 0; n < k_beginnings; ++n)
        if (std::abs(bounce(contact, 0.5, step, beginning(n), force) - expected) < 1e-3) ++within;
    return static_cast<double>(within) / k_beginnings;
}

// With beta = a and omega = sqrt(1 - a^2): exp(-beta/omega (pi - atan(2 beta omega/(omega^2 - beta^2)))), and with pull exp(-pi
// beta/omega). Where a pull ends close to the end of a step, which step is its last is open: some beginnings in a hundred are off.
TEST(LinearContactLaw, an_impact_returns_the_same_wherever_in_a_step_it_begins) {
    const double beta = 0.2, omega = std::sqrt(1.0 - beta * beta);
    LinearLaw law{1e6, beta, 0.5 / 1.3, true, false};
    const double end = k_pi - std::atan(2.0 * beta * omega / (omega * omega - beta * beta));
    EXPECT_EQ(share_of_true_bounces(law, std::exp(-beta / omega * end)), 1.0);
    law.may_pull = true;
    EXPECT_GE(share_of_true_bounces(law, std::exp(-beta / omega * k_pi)), 0.95);
}

TEST(LinearContactLaw, accumulates_slip_up_to_coulombs_limit) {
    Contact contact = linear_touch();
    contact.slip_velocity = Vec3(1e-4, 0, 0);
    SlipMemory memory;
    double last = 0.0;
    for (int n = 0; n < 20; ++n) {
        const double force = -linear_contact_force(k_linear, contact, 1e-3, memory).x();
        EXPECT_GE(force, last);
        last = force;
    }
    for (int n = 0; n < 5000; ++n) last = -linear_contact_force(k_linear, contact, 1e-3, memory).x();
    EXPECT_NEAR(last, 0.3 * 200.0, 1e-9);
    LinearLaw one_step = k_linear;
    one_step.accumulated_shear = false;
    SlipMemory none;
    const double first = linear_contact_force(one_step, contact, 1e-5, none).x();
    EXPECT_EQ(linear_contact_force(one_step, contact, 1e-5, none).x(), first);
}

}  // namespace
}  // namespace cutterflow::liggghts
