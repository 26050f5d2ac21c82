#include "solver/liggghts/rigid_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "atom.h"

#include "geometry/base/sphere.hpp"
#include "solver/physics/impact_mass.hpp"

namespace cutterflow::liggghts {

namespace {

/// Turns about the principal axes 1, 2, 3, 2, 1, each by what the axis' share of the angular momentum makes of it.
void turn_about_axes(Eigen::Quaterniond& principal, Vec3& momentum, const Vec3& moments, double step) {
    const auto turn_about = [&](int axis, double time) {
        const Eigen::AngleAxisd turn(time * momentum[axis] / moments[axis], Vec3::Unit(axis));
        principal = principal * turn;
        momentum = turn.inverse() * momentum;
    };
    turn_about(0, 0.5 * step);
    turn_about(1, 0.5 * step);
    turn_about(2, step);
    turn_about(1, 0.5 * step);
    turn_about(0, 0.5 * step);
}

}  // namespace

Eigen::Quaterniond turned_freely(Eigen::Quaterniond principal, const Vec3& angular_momentum, const Vec3& moments, double step) {
    const double outer = 1.0 / (2.0 - std::cbrt(2.0)), inner = 1.0 - 2.0 * outer;
    Vec3 momentum = principal.conjugate() * angular_momentum;
    for (const double share : {outer, inner, outer}) turn_about_axes(principal, momentum, moments, share * step);
    return principal.normalized();
}

/// With the angular momentum of its spin.
RigidBody RigidBodies::new_body(const coupling::Rock& rock) const {
    RigidBody body;
    body.state = rock;
    body.mass = sphere_mass(rock.diameter, rock.density);
    const geometry::UnitClump& clump = shapes_[static_cast<std::size_t>(rock.shape)].clump;
    body.moments = rock.density * std::pow(rock.diameter, 5) * clump.moments;
    const Eigen::Quaterniond turn = principal(body);
    body.angular_momentum = turn * Vec3(body.moments.cwiseProduct(turn.conjugate() * rock.angular_velocity));
    body.shortest = shortest_time(body);
    return body;
}

void RigidBodies::add(const std::vector<coupling::Rock>& rocks, const std::vector<Vec3>& angular_momenta) {
    for (std::size_t k = 0; k < rocks.size(); ++k) {
        RigidBody body = new_body(rocks[k]);
        if (!angular_momenta.empty()) body.angular_momentum = angular_momenta[k];
        update_spin(body);
        bodies_.push_back(body);
    }
    std::sort(bodies_.begin(), bodies_.end(), [](const RigidBody& a, const RigidBody& b) { return a.state.id < b.state.id; });
    number_bodies();
}

void RigidBodies::remove(const std::vector<int>& sorted_ids) {
    const auto goes = [&](const RigidBody& body) { return std::binary_search(sorted_ids.begin(), sorted_ids.end(), body.state.id); };
    bodies_.erase(std::remove_if(bodies_.begin(), bodies_.end(), goes), bodies_.end());
    number_bodies();
}

void RigidBodies::set_frozen(const std::vector<int>& sorted_ids, bool frozen) {
    for (RigidBody& body : bodies_) {
        if (!std::binary_search(sorted_ids.begin(), sorted_ids.end(), body.state.id)) continue;
        body.frozen = frozen;
        if (!frozen) continue;
        body.state.velocity.setZero();
        body.state.angular_velocity.setZero();
        body.angular_momentum.setZero();
    }
}

void RigidBodies::clear() {
    bodies_.clear();
    number_bodies();
}

void RigidBodies::number_bodies() {
    by_id_.assign(bodies_.empty() ? 0 : static_cast<std::size_t>(bodies_.back().state.id) + 1, -1);
    for (std::size_t b = 0; b < bodies_.size(); ++b) by_id_[static_cast<std::size_t>(bodies_[b].state.id)] = static_cast<int>(b);
}

std::size_t RigidBodies::spheres() const {
    std::size_t sum = 0;
    for (const RigidBody& body : bodies_) sum += shapes_[static_cast<std::size_t>(body.state.shape)].clump.balls.size();
    return sum;
}

std::vector<geometry::Ball> RigidBodies::balls_of(const coupling::Rock& rock) const {
    if (rock.shape == coupling::k_sphere_shape) return {{rock.position, 0.5 * rock.diameter}};
    std::vector<geometry::Ball> balls = shapes_[static_cast<std::size_t>(rock.shape)].clump.balls;
    for (geometry::Ball& ball : balls)
        ball = {rock.position + rock.orientation * Vec3(rock.diameter * ball.centre), rock.diameter * ball.radius};
    return balls;
}

double RigidBodies::reach_of(const coupling::Rock& rock) const {
    if (rock.shape == coupling::k_sphere_shape) return 0.5 * rock.diameter;
    return rock.diameter * shapes_[static_cast<std::size_t>(rock.shape)].clump.reach();
}

Eigen::Quaterniond RigidBodies::principal(const RigidBody& body) const {
    return body.state.orientation * Eigen::Quaterniond(shapes_[static_cast<std::size_t>(body.state.shape)].clump.axes);
}

void RigidBodies::update_spin(RigidBody& body) const {
    const Eigen::Quaterniond turn = principal(body);
    body.state.angular_velocity = turn * Vec3((turn.conjugate() * body.angular_momentum).cwiseQuotient(body.moments));
}

/// The rules for spheres hold with the least mass that a push through a sphere's centre meets, and the sphere's radius.
double RigidBodies::shortest_time(const RigidBody& body) const {
    const geometry::UnitClump& clump = shapes_[static_cast<std::size_t>(body.state.shape)].clump;
    double shortest = std::numeric_limits<double>::infinity();
    for (const geometry::Ball& ball : clump.balls) {
        const double radius = body.state.diameter * ball.radius, arm = body.state.diameter * ball.centre.norm();
        const double mass = physics::impact_mass(body.mass, arm, body.moments.minCoeff());
        shortest = std::min(shortest, context_.shortest_contact_time(radius, mass, mass / sphere_volume(2.0 * radius)));
    }
    return shortest;
}

Vec3 RigidBodies::weight(const RigidBody& body, const Vec3& gravity) const {
    return (body.mass - context_.fluid.density * sphere_volume(body.state.diameter)) * gravity;
}

/// From contacts, hydrodynamic force and submerged weight.
Vec3 RigidBodies::acceleration(const RigidBody& body, const Vec3& gravity) const {
    const double displaced = context_.fluid.density * sphere_volume(body.state.diameter);
    return (body.force + body.hydrodynamic + weight(body, gravity)) / (body.mass + context_.added_mass * displaced);
}

void RigidBodies::begin(const coupling::Rocks& rocks, const coupling::HydrodynamicForce& law, const LAMMPS_NS::Atom& atom, MPI_Comm world) {
    if (empty()) return;
    sum_forces(atom, world);
    for (RigidBody& body : bodies_) {
        body.index = static_cast<std::size_t>(std::lower_bound(rocks.id.begin(), rocks.id.end(), body.state.id) - rocks.id.begin());
        body.hydrodynamic = law(body.index, body.state.velocity);
        body.impulse = body.contact_impulse = Vec3::Zero();
    }
}

void RigidBodies::add_impulses(double duration, const Vec3& gravity) {
    for (RigidBody& body : bodies_) {
        body.impulse += duration * body.hydrodynamic;
        body.contact_impulse += duration * (body.frozen ? Vec3(-body.hydrodynamic - weight(body, gravity)) : body.force);
    }
}

void RigidBodies::start_step(double step, const Vec3& gravity, LAMMPS_NS::Atom& atom) {
    if (empty()) return;
    for (RigidBody& body : bodies_) {
        if (body.frozen) continue;
        coupling::Rock& state = body.state;
        body.acceleration = acceleration(body, gravity);
        body.torque_before = body.torque;
        state.position += step * (state.velocity + 0.5 * step * body.acceleration);
        state.velocity += step * body.acceleration;
        const Eigen::Quaterniond before = principal(body);
        const Eigen::Quaterniond after = turned_freely(before, body.angular_momentum + 0.5 * step * body.torque, body.moments, step);
        state.orientation = (after * before.conjugate() * state.orientation).normalized();
        body.angular_momentum += step * body.torque;
        update_spin(body);
    }
    place_spheres(atom);
}

void RigidBodies::end_step(double step, const Vec3& gravity, const coupling::HydrodynamicForce& law, LAMMPS_NS::Atom& atom,
                           MPI_Comm world) {
    if (empty()) return;
    sum_forces(atom, world);
    for (RigidBody& body : bodies_) {
        body.hydrodynamic = law(body.index, body.state.velocity);
        if (body.frozen) continue;
        body.state.velocity += 0.5 * step * (acceleration(body, gravity) - body.acceleration);
        body.angular_momentum += 0.5 * step * (body.torque - body.torque_before);
        update_spin(body);
    }
    place_spheres(atom);
}

/// Of the contacts of each body's spheres, from all ranks.
void RigidBodies::sum_forces(const LAMMPS_NS::Atom& atom, MPI_Comm world) {
    std::vector<double> sums(6 * bodies_.size(), 0.0);
    for (int i = 0; i < atom.nlocal; ++i) {
        const int b = body_of(atom.tag[i]);
        if (b < 0) continue;
        const Vec3 force(atom.f[i]), arm = Vec3(atom.x[i]) - bodies_[static_cast<std::size_t>(b)].state.position;
        Eigen::Map<Vec3>(&sums[6 * static_cast<std::size_t>(b)]) += force;
        Eigen::Map<Vec3>(&sums[6 * static_cast<std::size_t>(b) + 3]) += arm.cross(force) + Vec3(atom.torque[i]);
    }
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, world);
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        bodies_[b].force = Eigen::Map<const Vec3>(&sums[6 * b]);
        bodies_[b].torque = Eigen::Map<const Vec3>(&sums[6 * b + 3]);
    }
}

void RigidBodies::place_spheres(LAMMPS_NS::Atom& atom) const {
    std::vector<Eigen::Matrix3d> turn;
    for (const RigidBody& body : bodies_) turn.emplace_back(body.state.diameter * body.state.orientation.toRotationMatrix());
    for (int i = 0; i < atom.nlocal; ++i) {
        const int b = body_of(atom.tag[i]);
        if (b < 0) continue;
        const coupling::Rock& state = bodies_[static_cast<std::size_t>(b)].state;
        const geometry::UnitClump& clump = shapes_[static_cast<std::size_t>(state.shape)].clump;
        const Vec3 arm = turn[static_cast<std::size_t>(b)] * clump.balls[static_cast<std::size_t>(context_.sphere_of(atom.tag[i]))].centre;
        Eigen::Map<Vec3>(atom.x[i]) = state.position + arm;
        Eigen::Map<Vec3>(atom.v[i]) = state.velocity + state.angular_velocity.cross(arm);
        Eigen::Map<Vec3>(atom.omega[i]) = state.angular_velocity;
    }
}

}  // namespace cutterflow::liggghts
