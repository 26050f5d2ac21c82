#include "solver/liggghts/contacts/contact_context.hpp"

#include <algorithm>

#include "geometry/base/sphere.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::liggghts {

namespace {

std::map<const LAMMPS_NS::LAMMPS*, ContactContext*>& contexts() {
    static std::map<const LAMMPS_NS::LAMMPS*, ContactContext*> instances;
    return instances;
}

}  // namespace

ContactContext::ContactContext(const coupling::DemSettings& settings, const RotationAxis& rotor_axis)
    : contact(settings.contact),
      fluid(settings.fluid),
      added_mass(settings.added_mass),
      axis(rotor_axis),
      rock_rock(elastic_pair(contact.youngs_modulus, contact.poisson_rock, contact.poisson_rock)),
      rock_steel(elastic_pair(contact.youngs_modulus, contact.poisson_rock, contact.poisson_steel)),
      dry_damping_factor(physics::hertz_damping_factor(contact.restitution)),
      shape(settings.shape),
      cylinder_length(settings.cylinder_length),
      half_gap(0.5 * settings.contact_gap) {
    if (settings.law != coupling::ContactLaw::linear) return;
    const coupling::LinearContactSettings& law = settings.linear;
    linear = LinearLaw{law.gravity / (law.theta * law.reference_length), law.damping, 0.5 / (1.0 + law.poisson), law.accumulated_shear,
                       law.may_pull};
}

double ContactContext::mass_of(double radius, double density) const {
    return shape == coupling::RockShape::cylinder ? density * k_pi * radius * radius * cylinder_length : sphere_mass(2.0 * radius, density);
}

double ContactContext::inertia_of(double mass, double radius) const {
    return shape == coupling::RockShape::cylinder ? 0.5 * mass * radius * radius : sphere_inertia(2.0 * radius, mass);
}

double ContactContext::mass_with_added_mass(double mass, double radius) const {
    return mass + added_mass * fluid.density * sphere_volume(2.0 * radius);
}

double ContactContext::damping_factor(double impact_speed, double diameter, double density) const {
    if (!contact.wet_restitution) return dry_damping_factor;
    const double stokes = physics::impact_stokes(density / fluid.density, added_mass, impact_speed, diameter, fluid.kinematic_viscosity);
    return physics::hertz_damping_factor(std::max(physics::wet_restitution(contact.restitution, stokes), physics::k_smallest_restitution));
}

ContactContext& ContactContext::of(const LAMMPS_NS::LAMMPS* lammps) {
    return *contexts().at(lammps);
}
void ContactContext::set(const LAMMPS_NS::LAMMPS* lammps, ContactContext* context) {
    contexts()[lammps] = context;
}
void ContactContext::clear(const LAMMPS_NS::LAMMPS* lammps) {
    contexts().erase(lammps);
}

}  // namespace cutterflow::liggghts
