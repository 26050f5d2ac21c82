#include "solver/liggghts/contacts/contact_context.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/base/sphere.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::liggghts {

namespace {

std::map<const LAMMPS_NS::LAMMPS*, ContactContext*>& contexts() {
    static std::map<const LAMMPS_NS::LAMMPS*, ContactContext*> instances;
    return instances;
}

/// \param poisson  of what the rock touches
PairLaw law_of(const coupling::PairSettings& pair, const coupling::ContactSettings& contact, double poisson) {
    return {pair, elastic_pair(contact.youngs_modulus, contact.poisson_rock, poisson), physics::hertz_damping_factor(pair.restitution)};
}

/// Of a wall of that material.
PairLaw law_on(const std::string& material, const coupling::ContactSettings& contact) {
    const double poisson = material == coupling::k_soil ? contact.poisson_rock : contact.poisson_steel;
    return law_of(*contact.pair_on(material), contact, poisson);
}

std::vector<PairLaw> laws_on_bodies(const coupling::DemSettings& settings) {
    std::vector<PairLaw> laws;
    for (const coupling::WallSettings& wall : settings.walls) laws.push_back(law_on(wall.material, settings.contact));
    for (std::size_t side = 0; side < coupling::k_domain_sides.size(); ++side) {
        if (!settings.domain.side_is_wall[side]) continue;
        laws.push_back(law_on(settings.domain.material, settings.contact));
        if (settings.domain.side_is_frictionless[side]) laws.back().settings.friction = laws.back().settings.rolling_friction = 0.0;
    }
    return laws;
}

}  // namespace

ContactContext::ContactContext(const coupling::DemSettings& settings, const coupling::ZoneMotion& rotor)
    : wet_restitution(settings.contact.wet_restitution),
      fluid(settings.fluid),
      added_mass(settings.added_mass),
      axis(rotor.axis),
      rock_rock(law_of(settings.contact.rock_rock, settings.contact, settings.contact.poisson_rock)),
      rock_on_body(laws_on_bodies(settings)),
      rolling_law(settings.contact.rolling_law == "constant" ? RollingLaw::constant : RollingLaw::spring),
      shape(settings.shape),
      cylinder_length(settings.cylinder_length),
      has_clumps(!settings.shapes.empty()),
      youngs_modulus(settings.contact.youngs_modulus),
      poisson_rock(settings.contact.poisson_rock),
      max_speed(settings.contact.max_speed),
      steel(elastic_pair(settings.contact.youngs_modulus, settings.contact.poisson_rock, settings.contact.poisson_steel)),
      half_gap(0.5 * settings.contact_gap) {
    tally.force_on_body.assign(rock_on_body.size(), Vec3::Zero());
    work.resize(rock_on_body.size());
    for (const coupling::ClumpShape& clump_shape : settings.shapes)
        spheres_per_rock = std::max(spheres_per_rock, static_cast<int>(clump_shape.clump.balls.size()));
    if (settings.law != coupling::ContactLaw::linear) return;
    const coupling::LinearContactSettings& law = settings.linear;
    linear = LinearLaw{law.gravity / (law.theta * law.reference_length), law.damping, 0.5 / (1.0 + law.poisson), law.accumulated_shear,
                       law.may_pull};
}

double ContactContext::mass_of(double radius, double density) const {
    return shape == coupling::RockShape::cylinder ? density * k_pi * radius * radius * cylinder_length : sphere_mass(2.0 * radius, density);
}

double ContactContext::shortest_contact_time(double radius, double mass, double density) const {
    const physics::Impact on_rock{0.5 * mass, 0.5 * radius, rock_rock.elastic.youngs, max_speed};
    const physics::Impact on_steel{mass, radius, steel.youngs, max_speed};
    return std::min({physics::hertz_time(on_rock), physics::hertz_time(on_steel),
                     physics::rayleigh_time(radius, density, youngs_modulus, poisson_rock)});
}

double ContactContext::damping_factor(const PairLaw& pair, double impact_speed, double diameter, double density) const {
    if (!wet_restitution) return pair.dry_damping_factor;
    const double stokes = physics::impact_stokes(density / fluid.density, added_mass, impact_speed, diameter, fluid.kinematic_viscosity);
    return physics::hertz_damping_factor(
        std::max(physics::wet_restitution(pair.settings.restitution, stokes), physics::k_smallest_restitution));
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
