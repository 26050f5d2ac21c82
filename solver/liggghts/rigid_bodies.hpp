#pragma once
/// \file Clumps as rigid bodies. LIGGGHTS knows their spheres, which touch other rock and walls; it does not know that they belong
/// together.
#include <utility>
#include <vector>

#include <mpi.h>
#include <gsl/span>

#include "solver/liggghts/contacts/contact_context.hpp"
#include "solver/ports/dem_engine.hpp"

namespace LAMMPS_NS {
class Atom;
}  // namespace LAMMPS_NS

namespace cutterflow::liggghts {

/// Turns a body on which no torque acts over `step` [s]. The angular momentum L [kg m2/s] in the absolute frame stays; Euler's equation
/// I omega' + omega x I omega = 0 is split into turns about the principal axes, each of which is exact [DullweberLeimkuhlerMcLachlan1997],
/// in Yoshida's composition of order 4 [Yoshida1990]. So |L| is kept to rounding, and the energy swings by (omega step)^4 without a drift.
/// \param principal  turns the principal axes into the absolute ones
/// \param moments    principal ones [kg m2]
Eigen::Quaterniond turned_freely(Eigen::Quaterniond principal, const Vec3& angular_momentum, const Vec3& moments, double step);

/// One clump of the run.
struct RigidBody {
    coupling::Rock state;
    double mass = 0.0;                     ///< [kg]
    Vec3 moments = Vec3::Zero();           ///< principal ones [kg m2]
    Vec3 angular_momentum = Vec3::Zero();  ///< about the centre of mass, absolute frame [kg m2/s]
    double shortest = 0.0;                 ///< of Rayleigh and Hertz times of its spheres [s]
    bool frozen = false;
    std::size_t index = 0;                             ///< in the rocks of a call of advance
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< of contacts, about the centre of mass [N, N m]
    Vec3 hydrodynamic = Vec3::Zero();                  ///< force [N]
    Vec3 acceleration = Vec3::Zero();                  ///< at a step's start [m/s2]
    Vec3 torque_before = Vec3::Zero();                 ///< at a step's start [N m]
    Vec3 impulse = Vec3::Zero();                       ///< of the fluid since begin() [N s]
    Vec3 contact_impulse = Vec3::Zero();               ///< of contacts, and of what holds a frozen one [N s]
};

/// All clumps of the run, the same on every rank: every rank integrates all of them, from forces that are summed over the ranks in every
/// DEM step (6 numbers a body). That suits some thousand bodies on a few ranks. The scheme is RockMotion's: velocity Verlet with the
/// velocities at a step's end predicted by its first accelerations, for L as for v.
class RigidBodies {
public:
    RigidBodies(const std::vector<coupling::ClumpShape>& shapes, const ContactContext& context) : shapes_(shapes), context_(context) {}

    bool empty() const { return bodies_.empty(); }
    const std::vector<RigidBody>& all() const { return bodies_; }
    /// Whether the LIGGGHTS particle of this tag is a sphere of a clump.
    bool hold(int tag) const { return !bodies_.empty() && body_of(tag) >= 0; }

    /// \param angular_momenta  [kg m2/s]; empty: those of the rocks' spins
    void add(const std::vector<coupling::Rock>& rocks, const std::vector<Vec3>& angular_momenta = {});
    void remove(const std::vector<int>& sorted_ids);
    /// A frozen body has a velocity of exactly 0 and stays exactly where it is.
    void set_frozen(const std::vector<int>& sorted_ids, bool frozen);
    void clear();

    /// Number of spheres of all bodies.
    std::size_t spheres() const;
    /// Spheres of a rock of any shape.
    std::vector<geometry::Ball> balls_of(const coupling::Rock& rock) const;
    /// Distance [m] from the rock's centre of mass that its spheres reach.
    double reach_of(const coupling::Rock& rock) const;

    /// Less buoyancy [N].
    Vec3 weight(const RigidBody& body, const Vec3& gravity) const;

    /// Starts a call of advance, as RockMotion::begin.
    void begin(const coupling::Rocks& rocks, const coupling::HydrodynamicForce& law, const LAMMPS_NS::Atom& atom, MPI_Comm world);
    /// Of the present forces, over a time [s].
    void add_impulses(double duration, const Vec3& gravity);
    /// Moves the bodies and their spheres, with the velocities predicted for the step's end.
    void start_step(double step, const Vec3& gravity, LAMMPS_NS::Atom& atom);
    /// Corrects the velocities by the forces at the step's end.
    void end_step(double step, const Vec3& gravity, const coupling::HydrodynamicForce& law, LAMMPS_NS::Atom& atom, MPI_Comm world);

private:
    int body_of(int tag) const {
        const auto id = static_cast<std::size_t>(context_.rock_of(tag));
        return id < by_id_.size() ? by_id_[id] : -1;
    }
    RigidBody new_body(const coupling::Rock& rock) const;
    void number_bodies();
    Vec3 acceleration(const RigidBody& body, const Vec3& gravity) const;
    Eigen::Quaterniond principal(const RigidBody& body) const;
    void update_spin(RigidBody& body) const;
    double shortest_time(const RigidBody& body) const;
    void sum_forces(const LAMMPS_NS::Atom& atom, MPI_Comm world);
    void place_spheres(LAMMPS_NS::Atom& atom) const;

    const std::vector<coupling::ClumpShape>& shapes_;
    const ContactContext& context_;
    std::vector<RigidBody> bodies_;  // by id
    std::vector<int> by_id_;         // place in bodies_, or -1
};

}  // namespace cutterflow::liggghts
