#include "cases/study/contact_rules.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/base/sphere.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::cases {

double contact_step(const coupling::ContactSettings& contact, double diameter, double density) {
    const double modulus = contact.youngs_modulus / (1.0 - contact.poisson_rock * contact.poisson_rock);
    const physics::Impact impact{0.5 * sphere_mass(diameter, density), 0.25 * diameter, 0.5 * modulus, contact.max_speed};
    const double rayleigh = physics::rayleigh_time(0.5 * diameter, density, contact.youngs_modulus, contact.poisson_rock);
    return contact.time_step_fraction * std::min(rayleigh, physics::hertz_time(impact));
}

double impact_overlap(const coupling::ContactSettings& contact, double inertia_density, double speed) {
    const double compliance = 2.0 - contact.poisson_rock * contact.poisson_rock - contact.poisson_steel * contact.poisson_steel;
    // Hertz' largest overlap goes with E^(-2/5).
    return std::pow(physics::youngs_modulus_for_overlap(inertia_density, speed, 1.0, compliance) / contact.youngs_modulus, 0.4);
}

}  // namespace cutterflow::cases
