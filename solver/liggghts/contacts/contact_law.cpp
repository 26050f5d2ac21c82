#include "solver/liggghts/contacts/contact_law.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "solver/liggghts/contacts/slip_springs.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::liggghts {

namespace {

constexpr double k_rolling_damping = 0.3;  // zeta, share of critical

constexpr double k_hertz_onset = 0.8;  // integral of t^(1/4) from 0 to 1: Hertz' damping goes with the fourth root of the overlap

/// A vector of the tangent plane after a turn about the normal by `angle` [rad], its length unchanged.
Vec3 turned(const Vec3& vector, const Vec3& normal, double angle) {
    const double half = 0.5 * angle, share = 1.0 / (1.0 + half * half);
    return share * ((1.0 - half * half) * vector + 2.0 * half * normal.cross(vector));
}

/// Force [N] of one spring and its damper, at most `limit` [N]; of an angle and a spin the couple [N m]. What slips carries the limit in
/// the spring alone.
[[gnu::always_inline]] inline Vec3 spring_force(double stiffness, double damping, const Vec3& slip_velocity, double limit, Vec3& stretch) {
    const double limit_squared = limit * limit;  // roots are taken of what slips alone
    const Vec3 elastic = -stiffness * stretch;
    const double elastic_squared = elastic.squaredNorm();
    if (elastic_squared > limit_squared) {
        const double share = limit / std::sqrt(elastic_squared);
        stretch *= share;
        return share * elastic;
    }
    const Vec3 force = elastic - damping * slip_velocity;
    const double squared = force.squaredNorm();
    return squared > limit_squared ? Vec3(force * (limit / std::sqrt(squared))) : force;
}

/// Part of a step [0, 1] in which the bodies come to overlap, or cease to, as they do; 1 where they do not within a step.
double part_of_step(const Contact& contact, double time_step) {
    return std::min(1.0, contact.overlap / (std::abs(contact.normal_speed) * time_step));
}

/// What damping counts in the step of the first touch. \param onset  integral of damping over the part of the step after the touch, over
/// that part and the damping at its end
double share_after_touch(const Contact& contact, double time_step, double onset) {
    const bool began = contact.begins && time_step > 0.0 && contact.normal_speed < 0.0;
    return began ? 0.5 + onset * part_of_step(contact, time_step) : 1.0;
}

/// What damping that may pull counts in the last step of a touch.
double share_before_end(const Contact& contact, double time_step) {
    const bool ends = time_step > 0.0 && contact.normal_speed * time_step > contact.overlap;
    return ends ? 0.5 + part_of_step(contact, time_step) : 1.0;
}

}  // namespace

ElasticPair elastic_pair(double youngs_modulus, double poisson_a, double poisson_b) {
    const auto compliance = [&](double poisson) { return (1.0 - poisson * poisson) / youngs_modulus; };
    const auto shear_compliance = [&](double poisson) { return 2.0 * (2.0 - poisson) * (1.0 + poisson) / youngs_modulus; };
    return {1.0 / (compliance(poisson_a) + compliance(poisson_b)), 1.0 / (shear_compliance(poisson_a) + shear_compliance(poisson_b))};
}

double impact_radius(const ElasticPair& elastic, double radius, double mass, double speed) {
    return std::sqrt(radius * physics::hertz_largest_overlap({mass, radius, elastic.youngs, speed}));
}

Vec3 contact_force(const Contact& contact, double time_step, SlipMemory& memory) {
    const double contact_radius = std::sqrt(contact.radius * contact.overlap);
    const double normal_stiffness = 4.0 / 3.0 * contact.elastic.youngs * contact_radius;
    const double damping =
        share_after_touch(contact, time_step, k_hertz_onset) * contact.damping_factor * std::sqrt(contact.mass * normal_stiffness);
    const double normal_force = std::max(0.0, normal_stiffness * contact.overlap - damping * contact.normal_speed);

    if (contact_radius <= 0.0) {
        if (time_step > 0.0) memory = {};
        return Vec3::Zero();
    }
    SlipSprings springs;
    springs.contact_radius = contact_radius;
    springs.width = contact.impact_radius / k_springs;
    springs.stiffness = 8.0 * contact.elastic.shear;
    springs.damping = std::min(damping, contact.most_slip_damping);
    springs.limit = contact.friction * normal_force;
    Vec3 force = normal_force * contact.normal;
    add_slip_force(springs, contact.normal, contact.slip_velocity, time_step, memory, force);
    return force;
}

Vec3 rolling_couple(RollingLaw law, const Contact& contact, const Rolling& rolling, double normal_force, double time_step,
                    RollMemory& memory) {
    const double limit = contact.rolling_friction * normal_force * contact.radius;
    const Vec3 spin = rolling.spin - contact.normal * contact.normal.dot(rolling.spin);
    if (law == RollingLaw::constant) {
        const double speed = spin.norm();
        return speed > 0.0 ? Vec3(-limit / speed * spin) : Vec3(Vec3::Zero());
    }
    RollMemory now;
    now.contact_radius = std::sqrt(contact.radius * contact.overlap);
    const double kept = std::min(1.0, memory.contact_radius / now.contact_radius);
    Vec3 angle = kept * Vec3(memory.angle);
    angle -= contact.normal * contact.normal.dot(angle);
    angle = turned(angle, contact.normal, rolling.twist * time_step) + spin * time_step;
    const double stiffness = 8.0 * contact.elastic.shear * now.contact_radius * contact.radius * contact.radius;
    const double damping = std::min(2.0 * k_rolling_damping * std::sqrt(rolling.inertia * stiffness), rolling.most_damping);
    const Vec3 couple = spring_force(stiffness, damping, spin, limit, angle);
    std::copy_n(angle.data(), 3, now.angle);
    if (time_step > 0.0) memory = now;
    return couple;
}

Vec3 linear_contact_force(const LinearLaw& law, const Contact& contact, double time_step, SlipMemory& memory) {
    const double stiffness = law.stiffness * contact.mass;
    const double share = share_after_touch(contact, time_step, 1.0) * (law.may_pull ? share_before_end(contact, time_step) : 1.0);
    const double damping = share * 2.0 * law.damping * contact.mass * std::sqrt(law.stiffness);
    const double pull = stiffness * contact.overlap - damping * contact.normal_speed;
    const double normal_force = law.may_pull ? pull : std::max(0.0, pull);
    const Vec3 before = law.accumulated_shear ? memory.stretch_of(0) : Vec3(Vec3::Zero());
    Vec3 stretch = before + contact.slip_velocity * time_step;
    stretch -= contact.normal * contact.normal.dot(stretch);
    const Vec3 shear = spring_force(law.shear * stiffness, std::sqrt(law.shear) * damping, contact.slip_velocity,
                                    contact.friction * std::abs(normal_force), stretch);
    if (time_step > 0.0) memory.set_stretch(0, stretch);
    return normal_force * contact.normal + shear;
}

}  // namespace cutterflow::liggghts
