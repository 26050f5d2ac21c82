#pragma once
/// \file Shared data of the contact models of one engine. LIGGGHTS creates the models; they find this object by their LIGGGHTS instance.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/liggghts/contacts/contact_law.hpp"
#include "solver/ports/dem_settings.hpp"
#include "solver/ports/fluid_engine.hpp"

namespace LAMMPS_NS {
class LAMMPS;
class FixPropertyAtom;
}  // namespace LAMMPS_NS

namespace cutterflow::liggghts {

/// Impact speed of a contact that begins without approach; its damping is that of the smallest restitution.
inline constexpr double k_smallest_impact_speed = 1e-12;  // [m/s]

/// LIGGGHTS' types of particles. Walls have the second one too, which says nothing there.
inline constexpr int k_moving = 1, k_frozen = 2;

/// Sums over the contacts of one force evaluation, this rank's share.
struct ContactTally {
    std::vector<Vec3> force_on_body;  ///< of rock on each wall [N]
    double torque = 0.0;              ///< of the rock on the rotating steel about the axis [N m]
    double contacts = 0.0;            ///< a rock pair across two ranks counts half on each
    double overlap_ratio = 0.0;       ///< largest overlap over rock radius

    void clear() {
        torque = contacts = overlap_ratio = 0.0;
        std::fill(force_on_body.begin(), force_on_body.end(), Vec3(Vec3::Zero()));
    }
    void add(double count, double ratio) {
        contacts += count;
        overlap_ratio = std::max(overlap_ratio, ratio);
    }
};

/// Work of rock on one triangle of a wall, both relative to the wall as it moves:
///
///   impact   int F_n max(0, -u_n) dt,   sliding   -int F_t . u_t dt
///
/// The first is what rock spends on coming closer: of an impact on its own 1/2 m* u_n^2 at the first touch, m* with added mass, and
/// where a rock meets several triangles at once, or a clump does with several of its spheres, the parts of that energy. The second is
/// what friction takes, and springs that a contact loses with its area.
struct TriangleWork {
    double impact = 0.0;   ///< [J]
    double sliding = 0.0;  ///< [J]
};

class WallContacts;

/// What the law needs to know of a pair of materials.
struct PairLaw {
    coupling::PairSettings settings;
    ElasticPair elastic;
    double dry_damping_factor = 0.0;

    bool resists_rolling() const { return settings.rolling_friction > 0.0; }
};

/// The law for rock on rock and on walls with one Young's modulus.
struct ContactContext {
    bool wet_restitution = true;
    coupling::FluidProperties fluid;
    double added_mass = 0.0;
    RotationAxis axis;
    PairLaw rock_rock;
    std::vector<PairLaw> rock_on_body;  ///< by the number of the body: walls in the order of the settings, then sides that are walls
    RollingLaw rolling_law = RollingLaw::spring;
    std::optional<LinearLaw> linear;  ///< in place of Hertz'
    coupling::RockShape shape = coupling::RockShape::sphere;
    double cylinder_length = 0.0;
    bool has_clumps = false;
    int spheres_per_rock = 1;  ///< tags that LIGGGHTS' particles have for each rock: the most spheres of a shape
    double youngs_modulus = 0.0, poisson_rock = 0.0, max_speed = 0.0;
    ElasticPair steel;                               ///< of rock on steel
    double half_gap = 0.0;                           ///< by which LIGGGHTS' radii are larger than the rocks' [m]
    std::map<std::string, int, std::less<>> planes;  ///< number of each plane among the bodies of steel, by the id of its fix
    WallContacts* wall_contacts = nullptr;
    double time = 0.0;  ///< at which forces are evaluated [s]
    ContactTally tally;
    std::vector<std::vector<TriangleWork>> work;  ///< by body and triangle, since time 0, this rank's share; none of soil and planes

    ContactContext(const coupling::DemSettings& settings, const coupling::ZoneMotion& rotor);

    const PairLaw& law_on(int body) const { return rock_on_body[static_cast<std::size_t>(body)]; }
    bool some_body_resists_rolling() const {
        return std::any_of(rock_on_body.begin(), rock_on_body.end(), [](const PairLaw& law) { return law.resists_rolling(); });
    }
    /// Radius [m] of a rock whose radius in LIGGGHTS is `contact_radius`.
    double radius_of(double contact_radius) const { return contact_radius - half_gap; }
    /// Mass [kg] of a rock of this radius [m].
    double mass_of(double radius, double density) const;
    /// Of inertia about its centre, along a cylinder about its axis [kg m2].
    double inertia_of(double mass, double radius) const {
        return shape == coupling::RockShape::cylinder ? 0.5 * mass * radius * radius : sphere_inertia(2.0 * radius, mass);
    }
    /// Force of the law in use. `mass` of a pair: see pair_mass.
    Vec3 force(const Contact& touch, double time_step, SlipMemory& memory) const {
        return linear ? linear_contact_force(*linear, touch, time_step, memory) : contact_force(touch, time_step, memory);
    }

    /// Mass [kg] of a contact of two rocks: Hertz' effective one, or the linear law's mean.
    double pair_mass(double a, double b) const {
        if (std::isinf(a)) return b;
        if (std::isinf(b)) return a;
        return linear ? 0.5 * (a + b) : a * b / (a + b);
    }

    /// Rock to which the LIGGGHTS particle of a tag belongs, and which of its spheres the particle is. A sphere is its own only one.
    int rock_of(int tag) const { return (tag - 1) / spheres_per_rock + 1; }
    int sphere_of(int tag) const { return (tag - 1) % spheres_per_rock; }
    int tag_of(int rock, int sphere) const { return (rock - 1) * spheres_per_rock + sphere + 1; }
    /// Whether two particles are of one rock, which does not touch itself.
    bool same_rock(int tag, int other) const { return has_clumps && rock_of(tag) == rock_of(other); }

    /// Volume [m3] of the rock to which a particle belongs. The particles of a clump have the mass of the whole.
    double volume_of(double mass, double radius, double density) const { return has_clumps ? mass / density : sphere_volume(2.0 * radius); }

    /// Mass [kg] with added mass of a rock, by mass [kg], radius [m] and density [kg/m3] of its particle.
    double mass_with_added_mass(double mass, double radius, double density) const {
        return mass + added_mass * fluid.density * volume_of(mass, radius, density);
    }

    /// Inertia [kg m2] of a rock about a point of its surface, with the added mass; a clump's as of the sphere of its volume.
    double rolling_inertia(double mass, double radius, double density) const {
        const double equivalent = has_clumps ? std::cbrt(0.75 / k_pi * volume_of(mass, radius, density)) : radius;
        return inertia_of(mass, equivalent) + mass_with_added_mass(mass, radius, density) * radius * radius;
    }

    /// Diameter [m] in the Stokes number of an impact, which is M v / (6 pi mu R^2): of a sphere its own, of a clump's sphere of diameter
    /// d_s d^3/d_s^2 with the equivalent diameter d of the whole.
    double impact_diameter(double mass, double radius, double density) const {
        return has_clumps ? volume_of(mass, radius, density) / (k_pi / 6.0 * 4.0 * radius * radius) : 2.0 * radius;
    }

    /// Smallest of Rayleigh and Hertz times [s] of a sphere of this radius [m], mass [kg] and density [kg/m3].
    double shortest_contact_time(double radius, double mass, double density) const;

    /// Damping factor of a contact that began with the normal speed `impact_speed` [m/s]: rock of diameter `diameter` [m] and density
    /// `density` [kg/m3].
    double damping_factor(const PairLaw& pair, double impact_speed, double diameter, double density) const;

    /// The context of a LIGGGHTS instance; it must have been set.
    static ContactContext& of(const LAMMPS_NS::LAMMPS* lammps);
    static void set(const LAMMPS_NS::LAMMPS* lammps, ContactContext* context);
    static void clear(const LAMMPS_NS::LAMMPS* lammps);
};

}  // namespace cutterflow::liggghts
