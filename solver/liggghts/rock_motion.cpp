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
    largest_overlap_ratio_ = 0.0;
    wall_impulse_.assign(context_.tally.force_on_body.size(), Vec3::Zero());
    bodies_.begin(rocks, law, *atom, world);
    for (int i = 0; i < atom->nlocal; ++i) {
        if (bodies_.hold(atom->tag[i])) continue;
        const auto of_this_rock = std::lower_bound(rocks.id.begin(), rocks.id.end(), context_.rock_of(atom->tag[i]));
        const double mass = atom->rmass[i], radius = atom->radius[i];
        State& state = states_[i];
        state.index = static_cast<std::size_t>(of_this_rock - rocks.id.begin());
        state.mass = context_.mass_with_added_mass(mass, radius, atom->density[i]);
        state.submerged_mass = mass - context_.fluid.density * sphere_volume(2.0 * radius);
        state.inertia = context_.inertia_of(mass, context_.radius_of(radius));
        state.hydrodynamic = law(state.index, Vec3(atom->v[i]));
        state.accelerations = accelerations(i);
        state.impulse = state.contact_impulse = Vec3::Zero();
    }
}

bool RockMotion::is_frozen(int rock) const {
    return atom->type[rock] == k_frozen;
}

/// From contact (LIGGGHTS' force), hydrodynamic force and submerged weight.
RockMotion::Accelerations RockMotion::accelerations(int rock) const {
    const State& state = states_[rock];
    return {(Vec3(atom->f[rock]) + state.hydrodynamic + weight(state)) / state.mass, Vec3(atom->torque[rock]) / state.inertia};
}

/// Half a step's.
void RockMotion::add_impulses(int rock) {
    State& state = states_[rock];
    const Vec3 other = is_frozen(rock) ? Vec3(-state.hydrodynamic - weight(state)) : Vec3(atom->f[rock]);
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
        const Accelerations& present = states_[i].accelerations;
        Eigen::Map<Vec3> position(atom->x[i]), velocity(atom->v[i]), spin(atom->omega[i]);
        position += step * (velocity + 0.5 * step * present.centre);
        velocity += step * present.centre;
        spin += step * present.spin;
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
        const Accelerations at_end = accelerations(i);
        velocity += 0.5 * step * (at_end.centre - state.accelerations.centre);
        spin += 0.5 * step * (at_end.spin - state.accelerations.spin);
        state.accelerations = at_end;
    }
    add_impulses_of_walls();
    largest_overlap_ratio_ = std::max(largest_overlap_ratio_, context_.tally.overlap_ratio);
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
    const State& state = states_[rock];
    double* end = buffer;
    for (const Vec3* vector :
         {&state.hydrodynamic, &state.accelerations.centre, &state.accelerations.spin, &state.impulse, &state.contact_impulse})
        end = std::copy_n(vector->data(), 3, end);
    for (const double number : {static_cast<double>(state.index), state.mass, state.submerged_mass, state.inertia}) *end++ = number;
    return static_cast<int>(end - buffer);
}

int RockMotion::unpack_exchange(int rock, double* buffer) {
    State& state = states_[rock];
    const double* next = buffer;
    for (Vec3* vector :
         {&state.hydrodynamic, &state.accelerations.centre, &state.accelerations.spin, &state.impulse, &state.contact_impulse}) {
        std::copy_n(next, 3, vector->data());
        next += 3;
    }
    state.index = static_cast<std::size_t>(*next++);
    for (double* number : {&state.mass, &state.submerged_mass, &state.inertia}) *number = *next++;
    return static_cast<int>(next - buffer);
}

}  // namespace cutterflow::liggghts
