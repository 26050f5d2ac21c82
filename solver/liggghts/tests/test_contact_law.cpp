#include "solver/liggghts/contact_law.hpp"

#include <cmath>

#include <gtest/gtest.h>

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

TEST(ContactLaw, the_elastic_force_is_that_of_hertz) {
    const Contact contact = rock_on_steel();
    Vec3 spring = Vec3::Zero();
    const Vec3 force = contact_force(contact, 1e-5, spring);
    EXPECT_NEAR(force.z(), 4.0 / 3.0 * contact.elastic.youngs * std::sqrt(0.01) * std::pow(1e-4, 1.5), 1e-12);
    EXPECT_EQ(force.head<2>().norm(), 0.0);
}

TEST(ContactLaw, damping_resists_approach_and_separation_and_may_pull) {
    Contact contact = rock_on_steel();
    contact.damping_factor = physics::hertz_damping_factor(0.3);
    Vec3 spring = Vec3::Zero();
    const double elastic = contact_force(contact, 0.0, spring).z();
    contact.normal_speed = -1.0;
    const double approaching = contact_force(contact, 0.0, spring).z();
    contact.normal_speed = 1.0;
    const double separating = contact_force(contact, 0.0, spring).z();
    EXPECT_GT(approaching, elastic);
    EXPECT_NEAR(approaching + separating, 2.0 * elastic, 1e-12 * elastic);
    EXPECT_LT(separating, 0.0);
}

// Integrated without LIGGGHTS: the law returns the restitution that its damping factor was made for.
TEST(ContactLaw, a_normal_impact_returns_the_restitution) {
    for (const double restitution : {0.1, 0.3, 0.6, 0.9, 1.0}) {
        Contact contact = rock_on_steel();
        contact.damping_factor = physics::hertz_damping_factor(restitution);
        double overlap = 0.0, speed = 1.0;  // into the wall
        const double step = 1e-8;
        Vec3 spring = Vec3::Zero();
        do {
            overlap += step * speed;
            contact.overlap = std::max(overlap, 0.0);
            contact.normal_speed = -speed;
            speed -= step * contact_force(contact, 0.0, spring).z() / contact.mass;
        } while (overlap > 0.0);
        EXPECT_NEAR(-speed, restitution, 1e-3) << "e = " << restitution;
    }
}

TEST(ContactLaw, the_spring_stays_in_the_plane_and_carries_coulombs_limit_when_sliding) {
    Contact contact = rock_on_steel();
    contact.slip_velocity = Vec3(1.0, 0, 0);
    Vec3 spring(0, 0, 5e-5);  // from a plane that has turned since
    const Vec3 sticking = contact_force(contact, 1e-9, spring);
    EXPECT_EQ(spring.z(), 0.0);
    EXPECT_NEAR(spring.x(), 1e-9, 1e-20);
    EXPECT_NEAR(sticking.x(), -8.0 * contact.elastic.shear * std::sqrt(0.01 * 1e-4) * 1e-9, 1e-12);

    for (int k = 0; k < 100; ++k) contact_force(contact, 1e-5, spring);
    const Vec3 sliding = contact_force(contact, 1e-5, spring);
    EXPECT_NEAR(sliding.x(), -0.15 * sliding.z(), 1e-12 * sliding.z());
    EXPECT_NEAR(8.0 * contact.elastic.shear * std::sqrt(0.01 * 1e-4) * spring.x(), 0.15 * sliding.z(), 1e-12 * sliding.z());
}

TEST(ContactLaw, no_step_leaves_the_spring) {
    Contact contact = rock_on_steel();
    contact.slip_velocity = Vec3(1.0, 0, 0);
    Vec3 spring(1e-7, 0, 0);
    contact_force(contact, 0.0, spring);
    EXPECT_EQ(spring, Vec3(1e-7, 0, 0));
}

}  // namespace
}  // namespace cutterflow::liggghts
