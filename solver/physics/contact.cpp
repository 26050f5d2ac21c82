#include "solver/physics/contact.hpp"

#include <cmath>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::physics {

namespace {

constexpr double k_series = 1e-4;  // distance from 1 below which a series is more exact

/// F(x) = acos(x) / sqrt(1 - x^2), beyond 1 acosh(x) / sqrt(x^2 - 1), one smooth function.
double arc_over_sine(double x) {
    const double below = 1.0 - x;
    if (std::abs(below) < k_series) return 1.0 + below / 3.0 + 2.0 / 15.0 * below * below;
    const double square = below * (1.0 + x);
    return square > 0.0 ? std::acos(x) / std::sqrt(square) : std::acosh(x) / std::sqrt(-square);
}

/// F' at x with f = F(x).
double arc_over_sine_slope(double x, double f) {
    const double below = 1.0 - x;
    return std::abs(below) < k_series ? -1.0 / 3.0 - 4.0 / 15.0 * below : (x * f - 1.0) / (below * (1.0 + x));
}

}  // namespace

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
        const double f = arc_over_sine(ratio), slope = 2.0 * (f + ratio * arc_over_sine_slope(ratio, f));
        change = (loss - 2.0 * ratio * f) / slope;
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

}  // namespace cutterflow::physics
