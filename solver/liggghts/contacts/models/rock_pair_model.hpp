/// \file Contact of two rocks as a LIGGGHTS model: normal and tangential force of contact_law.hpp.
#ifdef NORMAL_MODEL
NORMAL_MODEL(ROCK_PAIR, rock, 40)
#else
#ifndef CUTTERFLOW_ROCK_PAIR_MODEL
#define CUTTERFLOW_ROCK_PAIR_MODEL

#include <algorithm>
#include <limits>
#include <string>

#include <Eigen/Geometry>

#include "atom.h"
#include "normal_model_base.h"
#include "update.h"

#include "solver/liggghts/contacts/contact_context.hpp"

namespace LIGGGHTS {
namespace ContactModels {

/// The pair's history from the first touch until the rocks separate, in the order in which the model declares it.
struct RockPairRecord {
    double impact_radius = 0.0;  ///< [m], see Contact; 0: never used
    double last_touch = 0.0;     ///< step
    double damping_factor = 0.0;
    cutterflow::liggghts::SlipMemory slip;
    cutterflow::liggghts::RollMemory roll;  ///< there only when something resists rolling
};

/// The restitution follows from the impact speed.
template <>
class NormalModel<ROCK_PAIR> : public NormalModelBase {
public:
    NormalModel(LAMMPS* lammps, IContactHistorySetup* history, ContactModelBase* model)
        : NormalModelBase(lammps, history, model),
          context_(cutterflow::liggghts::ContactContext::of(lammps)),
          offset_(history->add_history_value("impact_radius", "0")) {
        history->add_history_value("last_touch", "0");
        history->add_history_value("damping_factor", "0");
        history->add_history_value("contact_radius", "0");
        for (const char axis : {'x', 'y', 'z'})
            for (int k = 0; k < cutterflow::liggghts::k_springs; ++k)
                history->add_history_value(std::string("stretch_") + axis + std::to_string(k), "1");
        if (!context_.rock_rock.resists_rolling()) return;
        history->add_history_value("rolling_radius", "0");
        for (const char axis : {'x', 'y', 'z'}) history->add_history_value(std::string("rolling_angle_") + axis, "1");
    }

    void registerSettings(Settings&) override {}
    void postSettings(IContactHistorySetup*, ContactModelBase*) override {}
    void connectToProperties(PropertyRegistry&) override {}
    double stressStrainExponent() override { return 1.5; }
    void surfacesClose(SurfacesCloseData&, ForceData&, ForceData&) override {}
    void beginPass(SurfacesIntersectData&, ForceData&, ForceData&) override {}
    void endPass(SurfacesIntersectData&, ForceData&, ForceData&) override {}

    void surfacesIntersect(SurfacesIntersectData& pair, ForceData& on_i, ForceData& on_j) override {
        using cutterflow::Vec3;
        if (context_.same_rock(atom->tag[pair.i], atom->tag[pair.j])) return;
        if (pair.contact_flags) *pair.contact_flags |= CONTACT_NORMAL_MODEL;
        const double mass_i = is_frozen(pair.i) ? k_infinite : context_.mass_with_added_mass(pair.mi, pair.radi, atom->density[pair.i]);
        const double mass_j = is_frozen(pair.j) ? k_infinite : context_.mass_with_added_mass(pair.mj, pair.radj, atom->density[pair.j]);
        const bool keep = pair.computeflag && pair.shearupdate;
        auto& record = *reinterpret_cast<RockPairRecord*>(pair.contact_history + offset_);

        cutterflow::liggghts::Contact contact;
        contact.normal = Vec3(pair.en);
        contact.overlap = pair.deltan;
        contact.normal_speed = pair.vn;
        contact.slip_velocity = Vec3(pair.vtr1, pair.vtr2, pair.vtr3);
        contact.radius = pair.radi * pair.radj / (pair.radi + pair.radj);
        contact.mass = context_.pair_mass(mass_i, mass_j);
        contact.elastic = context_.rock_rock.elastic;
        contact.begins = update_record(record, pair, contact, keep);
        contact.impact_radius = record.impact_radius;
        contact.damping_factor = record.damping_factor;
        contact.friction = context_.rock_rock.settings.friction;
        contact.rolling_friction = context_.rock_rock.settings.rolling_friction;
        contact.most_slip_damping = cutterflow::liggghts::resolved_slip_damping(contact.mass, update->dt);
        const double time_step = keep ? update->dt : 0.0;
        const Vec3 force = context_.force(contact, time_step, record.slip);
        Vec3 couple = Vec3::Zero();
        if (context_.rock_rock.resists_rolling())
            couple = cutterflow::liggghts::rolling_couple(context_.rolling_law, contact, rolling_of(pair, contact.normal),
                                                          contact.normal.dot(force), time_step, record.roll);

        // Across a gap the lever ends on the rock's own surface.
        const double arm_i = context_.half_gap > 0.0 ? context_.radius_of(pair.radi) : pair.cri;
        const double arm_j = context_.half_gap > 0.0 ? context_.radius_of(pair.radj) : pair.crj;
        const Vec3 moment = -contact.normal.cross(force);  // per unit of lever arm, the same on both
        for (int k = 0; k < 3; ++k) {
            on_i.delta_F[k] += force[k];
            on_j.delta_F[k] -= force[k];
            on_i.delta_torque[k] += arm_i * moment[k] + couple[k];
            on_j.delta_torque[k] += arm_j * moment[k] - couple[k];
        }
        const bool shared = pair.j >= atom->nlocal;
        context_.tally.add(shared ? 0.5 : 1.0, pair.deltan / std::min(pair.radi, pair.radj));
    }

private:
    static constexpr double k_infinite = std::numeric_limits<double>::infinity();

    bool is_frozen(int rock) const { return atom->type[rock] == cutterflow::liggghts::k_frozen; }

    /// A first touch stores what follows from the approach speed and clears all slip. LIGGGHTS clears the history of a separated pair only
    /// while the pair is in its neighbour list, therefore the step of the last touch decides. \return whether the rocks first touch
    bool update_record(RockPairRecord& record, const SurfacesIntersectData& pair, const cutterflow::liggghts::Contact& contact,
                       bool keep) const {
        const double step = static_cast<double>(update->ntimestep);
        const bool first_touch = record.impact_radius == 0.0 || record.last_touch < step - 1.0;
        if (first_touch) {
            const double speed = std::max(-pair.vn, cutterflow::liggghts::k_smallest_impact_speed);
            record.impact_radius = cutterflow::liggghts::impact_radius(contact.elastic, contact.radius, contact.mass, speed);
            record.damping_factor = damping_factor(pair, speed);
            record.slip = {};
            if (context_.rock_rock.resists_rolling()) record.roll = {};
        }
        if (keep) record.last_touch = step;
        return first_touch;
    }

    cutterflow::liggghts::Rolling rolling_of(const SurfacesIntersectData& pair, const cutterflow::Vec3& normal) const {
        const cutterflow::Vec3 spin_i(atom->omega[pair.i]), spin_j(atom->omega[pair.j]);
        const double inertia_i = context_.rolling_inertia(pair.mi, pair.radi, atom->density[pair.i]);
        const double inertia_j = context_.rolling_inertia(pair.mj, pair.radj, atom->density[pair.j]);
        const double of_both = inertia_i * inertia_j / (inertia_i + inertia_j);
        const double inertia = is_frozen(pair.i) ? inertia_j : is_frozen(pair.j) ? inertia_i : of_both;
        return {spin_i - spin_j, 0.5 * normal.dot(spin_i + spin_j), inertia,
                cutterflow::liggghts::resolved_roll_damping(inertia, update->dt)};
    }

    /// Harmonic mean of the diameters, mean of the densities: for equal rocks the rock's own, as on a wall.
    double damping_factor(const SurfacesIntersectData& pair, double impact_speed) const {
        const double density_i = atom->density[pair.i], density_j = atom->density[pair.j];
        const double diameter_i = context_.impact_diameter(pair.mi, pair.radi, density_i);
        const double diameter_j = context_.impact_diameter(pair.mj, pair.radj, density_j);
        const double diameter = 2.0 * diameter_i * diameter_j / (diameter_i + diameter_j);
        return context_.damping_factor(context_.rock_rock, impact_speed, diameter, 0.5 * (density_i + density_j));
    }

    cutterflow::liggghts::ContactContext& context_;
    int offset_;
};

}  // namespace ContactModels
}  // namespace LIGGGHTS

#endif
#endif
