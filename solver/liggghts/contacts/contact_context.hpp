#pragma once
/// \file Shared data of the contact models of one engine. LIGGGHTS creates the models; they find this object by their LIGGGHTS instance.
#include <algorithm>
#include <functional>
#include <map>
#include <string>

#include "geometry/base/axis_frame.hpp"
#include "solver/liggghts/contacts/contact_law.hpp"
#include "solver/ports/dem_settings.hpp"

namespace LAMMPS_NS {
class LAMMPS;
class FixPropertyAtom;
}  // namespace LAMMPS_NS

namespace cutterflow::liggghts {

/// Impact speed of a contact that begins without approach; its damping is that of the smallest restitution.
inline constexpr double k_smallest_impact_speed = 1e-12;  // [m/s]

/// A body of steel: all triangles of one STL, or one plane.
struct WallBody {
    int index = 0;
    bool rotating = false;
};

/// Sums over the contacts of one force evaluation, this rank's share.
struct ContactTally {
    double torque = 0.0;         ///< of the rock on the rotating steel about the axis [N m]
    double contacts = 0.0;       ///< a rock pair across two ranks counts half on each
    double overlap_ratio = 0.0;  ///< largest overlap over rock radius

    void add(double count, double ratio) {
        contacts += count;
        overlap_ratio = std::max(overlap_ratio, ratio);
    }
};

class WallContacts;

/// The law for rock on rock and rock on steel with one Young's modulus, one friction and one dry restitution; different materials per
/// pair would become a table here.
struct ContactContext {
    coupling::ContactSettings contact;
    coupling::FluidProperties fluid;
    double added_mass = 0.0;
    RotationAxis axis;
    ElasticPair rock_rock;
    ElasticPair rock_steel;
    double dry_damping_factor = 0.0;
    std::map<std::string, WallBody, std::less<>> bodies;  ///< by the id of the STL's or plane's fix
    WallContacts* wall_contacts = nullptr;
    ContactTally tally;

    ContactContext(const coupling::DemSettings& settings, const RotationAxis& rotor_axis);

    /// Mass [kg] with added mass of a rock of the given mass [kg] and radius [m].
    double mass_with_added_mass(double mass, double radius) const;

    /// Damping factor of a contact that began with the normal speed `impact_speed` [m/s]: rock of diameter `diameter` [m] and density
    /// `density` [kg/m3].
    double damping_factor(double impact_speed, double diameter, double density) const;

    /// The context of a LIGGGHTS instance; it must have been set.
    static ContactContext& of(const LAMMPS_NS::LAMMPS* lammps);
    static void set(const LAMMPS_NS::LAMMPS* lammps, ContactContext* context);
    static void clear(const LAMMPS_NS::LAMMPS* lammps);
};

}  // namespace cutterflow::liggghts
