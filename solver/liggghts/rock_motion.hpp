#pragma once
/// \file Motion of the rocks: a LIGGGHTS fix of our own that integrates them under contact, hydrodynamic force and weight.
#include <vector>

#include "fix.h"

#include "solver/liggghts/contacts/contact_context.hpp"
#include "solver/liggghts/rigid_bodies.hpp"
#include "solver/liggghts/steel_wall.hpp"
#include "solver/ports/dem_engine.hpp"

namespace cutterflow::liggghts {

/// Velocity Verlet for spheres with added mass (clumps: RigidBodies):
///
///   (m + C_AM rho_c V) dv/dt = F_contact + F_hydro(v) + (m - rho_c V) g,   2/5 m R^2 d(omega)/dt = T_contact
///
/// Forces that depend on velocity (drag, damping) are evaluated once per step for the velocity at its end as the step's first acceleration
/// predicts it, which keeps the order of two: during the evaluation LIGGGHTS' velocities are the predicted ones, on ghosts too. At the
/// start of a call of advance the hydrodynamic force is evaluated again, so that no half kick uses an old law. LIGGGHTS' own fix nve/sphere
/// has one added-mass ratio for all rocks, lags half a step in the velocity and writes to a screen that other ranks than 0 do not have.
/// Frozen rock is not integrated: what holds it takes up all forces on it.
class RockMotion final : public LAMMPS_NS::Fix {
public:
    /// \param walls   of triangles; they turn and travel with the context's time
    /// \param bodies  the clumps, whose spheres they move
    RockMotion(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg, ContactContext& context, std::vector<SteelWall>& walls, RigidBodies& bodies,
               const Vec3& gravity);
    ~RockMotion() override;

    /// Starts a call of advance: the rocks present (sorted by id) and their force law.
    void begin(const coupling::Rocks& rocks, const coupling::HydrodynamicForce& law);

    /// Impulses [N s] of the fluid and of contacts since begin(). \param rock  of this rank, in LIGGGHTS' order; no sphere of a clump
    const Vec3& impulse(int rock) const { return states_[static_cast<std::size_t>(rock)].impulse; }
    const Vec3& contact_impulse(int rock) const { return states_[static_cast<std::size_t>(rock)].contact_impulse; }
    /// This rank's share of the time integral [N m s] of the torque on rotating steel since begin().
    double angular_impulse() const { return angular_impulse_; }
    /// The same of the forces on the walls [N s], by their numbers.
    const std::vector<Vec3>& wall_impulse() const { return wall_impulse_; }
    /// Largest overlap over the rock's radius at the end of any step since begin(), of this rank.
    double largest_overlap_ratio() const { return largest_overlap_ratio_; }

    int setmask() override;
    void setup(int) override { post_force(0); }
    void setup_pre_force(int) override { pre_force(0); }
    void pre_force(int) override { context_.tally.clear(); }
    void post_force(int) override;
    void initial_integrate(int) override;
    void final_integrate() override;

    void grow_arrays(int capacity) override;
    void copy_arrays(int from, int to, int) override;
    void set_arrays(int rock) override;
    int pack_exchange(int rock, double* buffer) override;
    int unpack_exchange(int rock, double* buffer) override;

private:
    struct Accelerations {
        Vec3 centre = Vec3::Zero();  ///< [m/s2]
        Vec3 spin = Vec3::Zero();    ///< [rad/s2]
    };

    /// Of one rock of this rank; follows it to other ranks. What does not change is of begin().
    struct State {
        std::size_t index = 0;             ///< in rocks_
        double mass = 0.0;                 ///< with added mass [kg]
        double submerged_mass = 0.0;       ///< less that of the fluid in its place [kg]
        double inertia = 0.0;              ///< [kg m2]
        Vec3 hydrodynamic = Vec3::Zero();  ///< force [N]
        Accelerations accelerations;       ///< at the step's start
        Vec3 impulse = Vec3::Zero();       ///< since begin() [N s]
        Vec3 contact_impulse = Vec3::Zero();
    };

    bool is_frozen(int rock) const;
    Vec3 weight(const State& state) const { return state.submerged_mass * gravity_; }
    Accelerations accelerations(int rock) const;
    void add_impulses(int rock);
    void add_impulses_of_walls();
    void press_walls();

    ContactContext& context_;
    std::vector<SteelWall>& walls_;
    RigidBodies& bodies_;
    Vec3 gravity_;
    const coupling::Rocks* rocks_ = nullptr;
    const coupling::HydrodynamicForce* force_ = nullptr;
    std::vector<State> states_;  // in LIGGGHTS' order
    double angular_impulse_ = 0.0;
    double largest_overlap_ratio_ = 0.0;
    std::vector<Vec3> wall_impulse_;
};

}  // namespace cutterflow::liggghts
