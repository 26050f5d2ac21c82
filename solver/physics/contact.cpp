#include "solver/physics/contact.hpp"

#include <cmath>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::physics {

double impact_stokes(double density_ratio, double added_mass_coefficient, double impact_speed, double diameter,
                     double kinematic_viscosity) {
    return (density_ratio + added_mass_coefficient) * impact_speed * diameter / (9.0 * kinematic_viscosity);
}

double wet_restitution(double dry_restitution, double stokes) {
    return stokes > 0.0 ? dry_restitution * std::exp(-35.0 / stokes) : 0.0;
}

double hertz_damping_factor(double restitution) {
    constexpr double close_enough = 1e-10;
    const double loss = -std::log(restitution);
    double ratio = loss / k_pi, change = ratio;  // Newton's method; the loss is concave, so that it comes from below
    while (change > close_enough * ratio) {
        const double square = 1.0 - ratio * ratio, arc = std::acos(ratio) / std::sqrt(square);
        change = 0.5 * (loss - 2.0 * ratio * arc) / (arc + ratio * (ratio * arc - 1.0) / square);
        ratio += change;
    }
    return std::sqrt(5.0) * ratio;
}

double hertz_largest_overlap(const Impact& impact) {
    return std::pow(15.0 * impact.mass * impact.speed * impact.speed / (16.0 * impact.modulus * std::sqrt(impact.radius)), 0.4);
}

double hertz_time(const Impact& impact) {
    constexpr double compression_and_restitution = 2.9432750914577;  // 2 times the integral of dx / sqrt(1 - x^(5/2)) over (0, 1)
    return compression_and_restitution * hertz_largest_overlap(impact) / impact.speed;
}

double rayleigh_time(double radius, double density, double youngs_modulus, double poisson_ratio) {
    const double shear_modulus = youngs_modulus / (2.0 * (1.0 + poisson_ratio));
    return k_pi * radius * std::sqrt(density / shear_modulus) / (0.1631 * poisson_ratio + 0.8766);
}

double youngs_modulus_for_overlap(double inertia_density, double speed, double overlap_ratio, double compliance) {
    return 1.25 * k_pi * inertia_density * speed * speed * compliance / std::pow(overlap_ratio, 2.5);
}

double linear_contact_step(double theta, double reference_length, double gravity, double steps_per_period) {
    return 2.0 * k_pi / steps_per_period * std::sqrt(theta * reference_length / gravity);
}

double linear_restitution(double damping_ratio, bool may_pull) {
    const double decay = damping_ratio / std::sqrt(1.0 - damping_ratio * damping_ratio);
    return std::exp(-decay * (may_pull ? k_pi : 2.0 * std::acos(damping_ratio)));
}

}  // namespace cutterflow::physics
