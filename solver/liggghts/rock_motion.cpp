#include "solver/liggghts/rock_motion.hpp"

#include <algorithm>

#include "atom.h"
#include "update.h"

#include "geometry/base/sphere.hpp"
#include "solver/liggghts/contacts/wall_contacts.hpp"

namespace cutterflow::liggghts {

RockMotion::RockMotion(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg, ContactContext& context, std::vector<SteelWall>& walls,
                       RigidBodies& bodies, const Vec3& gravity)
    : Fix(lammps, narg, arg), context_(context), walls_(walls), bodies_(bodies), gravity_(gravity) {
    time_integrate = 1;
    create_attribute = 1;
    grow_arrays(atom->nmax);
    atom->add_callback(0);
}

RockMotion::~RockMotion() {
    atom->delete_callback(id, 0);
}

int RockMotion::setmask() {
    namespace when = LAMMPS_NS::FixConst;
    return when::INITIAL_INTEGRATE | when::PRE_FORCE | when::POST_FORCE | when::FINAL_INTEGRATE;
}

void RockMotion::begin(const coupling::Rocks& rocks, const coupling::HydrodynamicForce& law) {
    rocks_ = &rocks;
    force_ = &law;
    angular_impulse_ = 0.0;
    wall_impulse_.assign(context_.tally.force_on_body.size(), Vec3::Zero());
    bodies_.begin(rocks, law, *atom, world);
    for (int i = 0; i < atom->nlocal; ++i) {
        if (bodies_.hold(atom->tag[i])) continue;
        const auto of_this_rock = std::lower_bound(rocks.id.begin(), rocks.id.end(), context_.rock_of(atom->tag[i]));
        states_[i].index = static_cast<std::size_t>(of_this_rock - rocks.id.begin());
        states_[i].hydrodynamic = law(states_[i].index, Vec3(atom->v[i]));
        states_[i].impulse = states_[i].contact_impulse = Vec3::Zero();
    }
}

bool RockMotion::is_frozen(int rock) const {
    return atom->type[rock] == k_frozen;
}

/// Less buoyancy [N].
Vec3 RockMotion::weight(int rock) const {
    return (atom->rmass[rock] - context_.fluid.density * sphere_volume(2.0 * atom->radius[rock])) * gravity_;
}

/// From contact (LIGGGHTS' force), hydrodynamic force and submerged weight.
Vec3 RockMotion::acceleration(int rock) const {
    return (Vec3(atom->f[rock]) + states_[rock].hydrodynamic + weight(rock)) /
           context_.mass_with_added_mass(atom->rmass[rock], atom->radius[rock], atom->density[rock]);
}

/// Half a step's.
void RockMotion::add_impulses(int rock) {
    State& state = states_[rock];
    const Vec3 other = is_frozen(rock) ? Vec3(-state.hydrodynamic - weight(rock)) : Vec3(atom->f[rock]);
    state.impulse += 0.5 * update->dt * state.hydrodynamic;
    state.contact_impulse += 0.5 * update->dt * other;
}

/// Half a step's.
void RockMotion::add_impulses_of_walls() {
    angular_impulse_ += 0.5 * update->dt * context_.tally.torque;
    for (std::size_t body = 0; body < wall_impulse_.size(); ++body)
        wall_impulse_[body] += 0.5 * update->dt * context_.tally.force_on_body[body];
}

/// By the forces of all ranks on each wall that presses.
void RockMotion::press_walls() {
    for (std::size_t body = 0; body < walls_.size(); ++body) {
        if (!walls_[body].presses()) continue;
        Vec3 of_all_ranks = context_.tally.force_on_body[body];
        MPI_Allreduce(MPI_IN_PLACE, of_all_ranks.data(), 3, MPI_DOUBLE, MPI_SUM, world);
        walls_[body].press(of_all_ranks, update->dt);
    }
}

Vec3 RockMotion::spin_acceleration(int rock) const {
    return Vec3(atom->torque[rock]) / context_.inertia_of(atom->rmass[rock], context_.radius_of(atom->radius[rock]));
}

/// Runs after the planes' post_force, because the planes were declared before.
void RockMotion::post_force(int) {
    for (SteelWall& wall : walls_) wall.find_touches(*atom, context_.time, *context_.wall_contacts);
    context_.wall_contacts->resolve();
}

void RockMotion::initial_integrate(int) {
    const double step = update->dt;
    bodies_.add_impulses(0.5 * step, gravity_);
    bodies_.start_step(step, gravity_, *atom);
    for (int i = 0; i < atom->nlocal; ++i) {
        if (bodies_.hold(atom->tag[i])) continue;
        add_impulses(i);
        if (is_frozen(i)) continue;
        State& state = states_[i];
        Eigen::Map<Vec3> position(atom->x[i]), velocity(atom->v[i]), spin(atom->omega[i]);
        state.acceleration = acceleration(i);
        state.spin_acceleration = spin_acceleration(i);
        position += step * (velocity + 0.5 * step * state.acceleration);
        velocity += step * state.acceleration;
        spin += step * state.spin_acceleration;
    }
    add_impulses_of_walls();
    press_walls();
    context_.time += step;
}

void RockMotion::final_integrate() {
    const double step = update->dt;
    bodies_.end_step(step, gravity_, *force_, *atom, world);
    bodies_.add_impulses(0.5 * step, gravity_);
    for (int i = 0; i < atom->nlocal; ++i) {
        if (bodies_.hold(atom->tag[i])) continue;
        State& state = states_[i];
        Eigen::Map<Vec3> velocity(atom->v[i]), spin(atom->omega[i]);
        state.hydrodynamic = (*force_)(state.index, velocity);
        add_impulses(i);
        if (is_frozen(i)) continue;
        velocity += 0.5 * step * (acceleration(i) - state.acceleration);
        spin += 0.5 * step * (spin_acceleration(i) - state.spin_acceleration);
    }
    add_impulses_of_walls();
}

void RockMotion::grow_arrays(int capacity) {
    states_.resize(static_cast<std::size_t>(capacity));
}
void RockMotion::copy_arrays(int from, int to, int) {
    states_[to] = states_[from];
}
void RockMotion::set_arrays(int rock) {
    states_[rock] = State{};
}

int RockMotion::pack_exchange(int rock, double* buffer) {
    std::copy_n(states_[rock].hydrodynamic.data(), 3, buffer);
    std::copy_n(states_[rock].acceleration.data(), 3, buffer + 3);
    std::copy_n(states_[rock].spin_acceleration.data(), 3, buffer + 6);
    std::copy_n(states_[rock].impulse.data(), 3, buffer + 9);
    std::copy_n(states_[rock].contact_impulse.data(), 3, buffer + 12);
    buffer[15] = static_cast<double>(states_[rock].index);
    return 16;
}

int RockMotion::unpack_exchange(int rock, double* buffer) {
    std::copy_n(buffer, 3, states_[rock].hydrodynamic.data());
    std::copy_n(buffer + 3, 3, states_[rock].acceleration.data());
    std::copy_n(buffer + 6, 3, states_[rock].spin_acceleration.data());
    std::copy_n(buffer + 9, 3, states_[rock].impulse.data());
    std::copy_n(buffer + 12, 3, states_[rock].contact_impulse.data());
    states_[rock].index = static_cast<std::size_t>(buffer[15]);
    return 16;
}

}  // namespace cutterflow::liggghts
