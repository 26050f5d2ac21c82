#include "solver/liggghts/contacts/wall_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "atom.h"
#include "fix_property_atom.h"
#include "lammps.h"
#include "update.h"

namespace cutterflow::liggghts {

namespace {

constexpr double k_same_contact = 0.93969262078590838;   // cos 20 degrees
constexpr double k_other_contact = 0.81915204428899179;  // cos 35 degrees
constexpr double k_continues = 0.70710678118654752;      // cos 45 degrees

/// Remaining share of a touch beside a deeper one, by the cosine of the angle between their normals.
double share_beside(double cosine) {
    return std::clamp((k_same_contact - cosine) / (k_same_contact - k_other_contact), 0.0, 1.0);
}

bool is_live(const WallContactRecord& record, double step) {
    return record.impact_radius > 0.0 && record.last_touch >= step - 1.0;
}

using Records = std::array<WallContactRecord*, WallContacts::max_contacts>;

/// The record of the previous step that a touch continues, else null.
WallContactRecord* continued(const Records& records, const Records& taken, const WallTouch& touch, double step) {
    WallContactRecord* best = nullptr;
    double nearest = k_continues;
    for (WallContactRecord* record : records) {
        if (!is_live(*record, step) || static_cast<int>(record->body) != touch.body) continue;
        if (std::find(taken.begin(), taken.end(), record) != taken.end()) continue;
        const double cosine = touch.normal.dot(Vec3(record->normal));
        if (cosine <= nearest) continue;
        nearest = cosine;
        best = record;
    }
    return best;
}

/// A record for a new contact: one whose contact has ended, else one that no touch continues.
WallContactRecord* unused(const Records& records, const Records& taken, double step) {
    const auto is_free = [&](const WallContactRecord* record) { return std::find(taken.begin(), taken.end(), record) == taken.end(); };
    const auto has_ended = [&](const WallContactRecord* record) { return is_free(record) && !is_live(*record, step); };
    const auto ended = std::find_if(records.begin(), records.end(), has_ended);
    return ended != records.end() ? *ended : *std::find_if(records.begin(), records.end(), is_free);
}

/// An existing contact between the body and this rock, else null.
const WallContactRecord* known(const Records& records, int body, double step) {
    const auto is_on_body = [&](const WallContactRecord* record) {
        return is_live(*record, step) && static_cast<int>(record->body) == body;
    };
    const auto found = std::find_if(records.begin(), records.end(), is_on_body);
    return found == records.end() ? nullptr : *found;
}

}  // namespace

void WallContacts::resolve() {
    order_.clear();
    for (const WallTouch& touch : touches_) order_.push_back(&touch);
    std::stable_sort(order_.begin(), order_.end(), [](const WallTouch* a, const WallTouch* b) {
        return a->rock != b->rock ? a->rock < b->rock : a->overlap > b->overlap;
    });
    for (auto first = order_.begin(); first != order_.end();) {
        const auto last = std::find_if(first, order_.end(), [&](const WallTouch* touch) { return touch->rock != (*first)->rock; });
        merge({first, last});
        apply_merged();
        first = last;
    }
    touches_.clear();
}

/// \param touches  of one rock, the deepest first
void WallContacts::merge(const Touches& touches) {
    merged_.clear();
    for (auto touch = touches.first; touch != touches.last; ++touch) {
        double weight = 1.0;
        for (const Weighted& deeper : merged_) weight *= share_beside((*touch)->normal.dot(deeper.touch->normal));
        if (weight > 0.0 && merged_.size() < max_contacts) merged_.push_back({*touch, weight});
    }
}

/// Of one rock.
void WallContacts::apply_merged() {
    const double step = static_cast<double>(lammps_->update->ntimestep);
    const int rock = merged_.front().touch->rock;
    auto* row = reinterpret_cast<WallContactRecord*>(records_->array_atom[rock]);
    auto* rolling_row = rolling_ ? reinterpret_cast<RollMemory*>(rolling_->array_atom[rock]) : nullptr;
    const auto roll_of = [&](const WallContactRecord* record) { return rolling_row ? rolling_row + (record - row) : nullptr; };
    Records records{}, taken{};
    std::array<bool, max_contacts> begins{};
    for (int k = 0; k < max_contacts; ++k) records[k] = row + k;

    for (std::size_t k = 0; k < merged_.size(); ++k) taken[k] = continued(records, taken, *merged_[k].touch, step);
    for (std::size_t k = 0; k < merged_.size(); ++k) {
        if (taken[k]) continue;
        const WallTouch& touch = *merged_[k].touch;
        const WallContactRecord begun = begin(touch, known(records, touch.body, step));
        taken[k] = unused(records, taken, step);
        *taken[k] = begun;
        begins[k] = true;
        if (rolling_row) *roll_of(taken[k]) = {};
    }
    for (std::size_t k = 0; k < merged_.size(); ++k) apply(merged_[k], begins[k], *taken[k], roll_of(taken[k]));
}

/// \param known  an existing contact between the touched body and the rock, whose impact counts; null without one
WallContactRecord WallContacts::begin(const WallTouch& touch, const WallContactRecord* known) const {
    const LAMMPS_NS::Atom& atom = *lammps_->atom;
    WallContactRecord record;
    record.body = touch.body;
    if (known) {
        record.impact_radius = known->impact_radius;
        record.damping_factor = known->damping_factor;
        return record;
    }
    const double mass = atom.rmass[touch.rock], radius = atom.radius[touch.rock], density = atom.density[touch.rock];
    const double speed = std::max(touch.normal.dot(touch.wall_velocity - Vec3(atom.v[touch.rock])), k_smallest_impact_speed);
    const PairLaw& law = context_.law_on(touch.body);
    record.impact_radius = impact_radius(law.elastic, radius, context_.mass_with_added_mass(mass, radius, density), speed);
    record.damping_factor = context_.damping_factor(law, speed, context_.impact_diameter(mass, radius, density), density);
    return record;
}

Rolling WallContacts::rolling_of(const WallTouch& touch) const {
    const LAMMPS_NS::Atom& atom = *lammps_->atom;
    const Vec3 of_rock(atom.omega[touch.rock]), of_wall = touch.wall_spin;
    const double inertia = context_.rolling_inertia(atom.rmass[touch.rock], atom.radius[touch.rock], atom.density[touch.rock]);
    return {of_rock - of_wall, 0.5 * touch.normal.dot(of_rock + of_wall), inertia, resolved_roll_damping(inertia, lammps_->update->dt)};
}

/// See TriangleWork. \param force  of the whole contact, before its weight [N]
void WallContacts::add_work(const Weighted& weighted, const Contact& contact, const Vec3& force, double time_step) {
    const WallTouch& touch = *weighted.touch;
    std::vector<TriangleWork>& work = context_.work[static_cast<std::size_t>(touch.body)];
    if (touch.triangle < 0 || work.empty()) return;
    TriangleWork& of_triangle = work[static_cast<std::size_t>(touch.triangle)];
    const double duration = weighted.weight * time_step;
    of_triangle.impact += duration * std::max(0.0, contact.normal.dot(force)) * std::max(0.0, -contact.normal_speed);
    of_triangle.sliding -= duration * force.dot(contact.slip_velocity);
}

/// \param begins  whether rock and body first touch here \param roll  null when nothing resists rolling
void WallContacts::apply(const Weighted& weighted, bool begins, WallContactRecord& record, RollMemory* roll) {
    const LAMMPS_NS::Atom& atom = *lammps_->atom;
    const WallTouch& touch = *weighted.touch;
    const int rock = touch.rock;
    const double radius = atom.radius[rock];
    const double lever = context_.half_gap > 0.0 ? context_.radius_of(radius) : radius - 0.5 * touch.overlap;
    const Vec3 arm = -lever * touch.normal;
    const Vec3 centre_velocity = Vec3(atom.v[rock]) - touch.wall_velocity;
    const Vec3 surface_velocity = centre_velocity + Vec3(atom.omega[rock]).cross(arm);

    const PairLaw& law = context_.law_on(touch.body);
    Contact contact;
    contact.normal = touch.normal;
    contact.overlap = touch.overlap;
    contact.normal_speed = touch.normal.dot(centre_velocity);
    contact.impact_radius = record.impact_radius;
    contact.slip_velocity = surface_velocity - touch.normal * touch.normal.dot(surface_velocity);
    contact.radius = radius;
    contact.mass = context_.mass_with_added_mass(atom.rmass[rock], radius, atom.density[rock]);
    contact.elastic = law.elastic;
    contact.begins = begins;
    contact.damping_factor = record.damping_factor;
    contact.friction = law.settings.friction;
    contact.rolling_friction = law.settings.rolling_friction;
    contact.most_slip_damping = resolved_slip_damping(contact.mass, lammps_->update->dt);

    const bool setting_up = lammps_->update->setupflag != 0;
    const double time_step = setting_up ? 0.0 : lammps_->update->dt;
    const Vec3 whole = context_.force(contact, time_step, record.slip), force = weighted.weight * whole;
    add_work(weighted, contact, whole, time_step);
    Vec3 torque = arm.cross(force);
    if (roll)
        torque +=
            weighted.weight * rolling_couple(context_.rolling_law, contact, rolling_of(touch), touch.normal.dot(whole), time_step, *roll);
    std::copy_n(touch.normal.data(), 3, record.normal);
    if (!setting_up) record.last_touch = static_cast<double>(lammps_->update->ntimestep);

    Eigen::Map<Vec3>(atom.f[rock]) += force;
    Eigen::Map<Vec3>(atom.torque[rock]) += torque;
    context_.tally.add(1.0, touch.overlap / radius);
    context_.tally.force_on_body[static_cast<std::size_t>(touch.body)] -= force;
    if (touch.rotating) {
        const Vec3 from_axis = Vec3(atom.x[rock]) - context_.axis.origin;
        context_.tally.torque -= context_.axis.direction.dot(from_axis.cross(force) + torque);
    }
}

}  // namespace cutterflow::liggghts
