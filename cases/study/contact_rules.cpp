#include "cases/study/contact_rules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/sphere.hpp"
#include "solver/physics/contact.hpp"
#include "solver/physics/impact_mass.hpp"

namespace cutterflow::cases {

double contact_step(const coupling::ContactSettings& contact, double diameter, double density) {
    const double modulus = contact.youngs_modulus / (1.0 - contact.poisson_rock * contact.poisson_rock);
    const physics::Impact impact{0.5 * sphere_mass(diameter, density), 0.25 * diameter, 0.5 * modulus, contact.max_speed};
    const double rayleigh = physics::rayleigh_time(0.5 * diameter, density, contact.youngs_modulus, contact.poisson_rock);
    return contact.time_step_fraction * std::min(rayleigh, physics::hertz_time(impact));
}

double contact_step(const coupling::ContactSettings& contact, const geometry::UnitClump& clump, double diameter, double density) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const geometry::Ball& ball : clump.balls) {
        const double of_ball = 2.0 * ball.radius * diameter, moment = density * std::pow(diameter, 5) * clump.moments.minCoeff();
        const double mass = physics::impact_mass(sphere_mass(diameter, density), diameter * ball.centre.norm(), moment);
        shortest = std::min(shortest, contact_step(contact, of_ball, mass / sphere_volume(of_ball)));
    }
    return shortest;
}

double impact_overlap(const coupling::ContactSettings& contact, double inertia_density, double speed) {
    const double compliance = 2.0 - contact.poisson_rock * contact.poisson_rock - contact.poisson_steel * contact.poisson_steel;
    // Hertz' largest overlap goes with E^(-2/5).
    return std::pow(physics::youngs_modulus_for_overlap(inertia_density, speed, 1.0, compliance) / contact.youngs_modulus, 0.4);
}

}  // namespace cutterflow::cases
