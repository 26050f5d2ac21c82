#pragma once
/// \file Contacts of rocks with walls: SteelWall finds the triangles that a rock touches, LIGGGHTS the planes; this class merges
/// them into contacts and applies the law.
#include <vector>

#include "solver/liggghts/contacts/contact_context.hpp"

namespace cutterflow::liggghts {

/// A rock's sphere reaches through a triangle or plane of a body.
struct WallTouch {
    int rock = 0;  ///< LIGGGHTS' number on this rank
    int body = 0;
    int triangle = -1;                  ///< its place in the wall's file; -1: a plane
    bool rotating = false;              ///< with the rotor, whose torque it adds to
    Vec3 normal = Vec3::Zero();         ///< unit, from the touched point to the rock's centre
    double overlap = 0.0;               ///< [m]
    Vec3 wall_velocity = Vec3::Zero();  ///< of the steel at the touched point [m/s]
    Vec3 wall_spin = Vec3::Zero();      ///< [rad/s]
};

/// A contact of a rock with a body, kept from step to step in a row of LIGGGHTS' property per rock.
struct WallContactRecord {
    double body = 0.0;
    double last_touch = 0.0;     ///< step
    double impact_radius = 0.0;  ///< [m], see Contact; 0: never used
    double damping_factor = 0.0;
    double normal[3] = {0.0, 0.0, 0.0};
    SlipMemory slip;
};

/// One contact of every touched triangle, with a history per triangle, is LIGGGHTS' own way. On a curved blade, whose facets are
/// often smaller than the region that touches, stiffness then jumps with the number of touched triangles (a rock at 1 m/s on facets of 1 to
/// 3 mm returned 0.80 to 1.14 of its speed where 0.90 was set), and spring and impact speed are lost at every edge. Here
///
/// * a touch counts as a separate contact when its normal differs from that of a deeper one by more than 35 degrees, and not at all below
///   20, with a smooth transition: on a smooth surface the nearest point of the steel alone makes the force, which then has a potential;
/// * a contact of the previous step is continued by the touch of the same body with the nearest normal;
/// * what follows from the impact speed belongs to rock and body and lasts until no triangle of the body touches the rock.
class WallContacts {
public:
    static constexpr int max_contacts = 6;  ///< of one rock; the deepest ones count
    static constexpr int columns = max_contacts * static_cast<int>(sizeof(WallContactRecord) / sizeof(double));
    static constexpr int rolling_columns = max_contacts * static_cast<int>(sizeof(RollMemory) / sizeof(double));

    /// \param rolling  beside each record its RollMemory; null when nothing resists rolling
    WallContacts(LAMMPS_NS::LAMMPS* lammps, ContactContext& context, LAMMPS_NS::FixPropertyAtom* records,
                 LAMMPS_NS::FixPropertyAtom* rolling)
        : lammps_(lammps), context_(context), records_(records), rolling_(rolling) {}

    void add(const WallTouch& touch) { touches_.push_back(touch); }

    /// Applies the forces of all touches added since the last call to LIGGGHTS' forces and torques, and tallies them.
    void resolve();

private:
    struct Weighted {
        const WallTouch* touch;
        double weight;
    };
    struct Touches {
        std::vector<const WallTouch*>::const_iterator first, last;
    };

    void merge(const Touches& touches);
    void apply_merged();
    void add_work(const Weighted& weighted, const Contact& contact, const Vec3& force, double time_step);
    void apply(const Weighted& contact, bool begins, WallContactRecord& record, RollMemory* roll);
    WallContactRecord begin(const WallTouch& touch, const WallContactRecord* known) const;
    Rolling rolling_of(const WallTouch& touch) const;

    LAMMPS_NS::LAMMPS* lammps_;
    ContactContext& context_;
    LAMMPS_NS::FixPropertyAtom* records_;
    LAMMPS_NS::FixPropertyAtom* rolling_;
    std::vector<WallTouch> touches_;
    std::vector<const WallTouch*> order_;  ///< by rock and depth
    std::vector<Weighted> merged_;         ///< of one rock
};

}  // namespace cutterflow::liggghts
