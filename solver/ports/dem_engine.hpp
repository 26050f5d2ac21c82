#pragma once
/// \file Port to the DEM: rocks and their contacts. solver/liggghts implements it; tests use fakes. Every call is collective.
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gsl/span>

#include "geometry/base/vec3.hpp"
#include "solver/ports/fluid_engine.hpp"

namespace cutterflow::coupling {

inline constexpr int k_sphere_shape = -1;

/// One rock.
struct Rock {
    int id = 0;
    Vec3 position = Vec3::Zero();                                     ///< of its centre of mass [m], absolute frame
    Vec3 velocity = Vec3::Zero();                                     ///< [m/s]
    Vec3 angular_velocity = Vec3::Zero();                             ///< [rad/s], absolute frame
    double diameter = 0.0;                                            ///< of the sphere of equal volume [m]
    double density = 0.0;                                             ///< [kg/m3]
    int shape = k_sphere_shape;                                       ///< its number among the clumps of the settings, or k_sphere_shape
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< turns the shape from its file's axes; of a sphere the identity
};

/// All rocks of the run, the same on every rank, sorted by id. Arrays of equal length; see Rock.
struct Rocks {
    std::vector<int> id;
    std::vector<Vec3> position;
    std::vector<Vec3> velocity;
    std::vector<Vec3> angular_velocity;
    std::vector<double> diameter;
    std::vector<double> density;
    std::vector<int> shape;
    std::vector<Eigen::Quaterniond> orientation;

    std::size_t size() const { return id.size(); }
    Rock at(std::size_t p) const {
        return {id[p], position[p], velocity[p], angular_velocity[p], diameter[p], density[p], shape[p], orientation[p]};
    }
    void append(const Rock& rock) {
        id.push_back(rock.id);
        position.push_back(rock.position);
        velocity.push_back(rock.velocity);
        angular_velocity.push_back(rock.angular_velocity);
        diameter.push_back(rock.diameter);
        density.push_back(rock.density);
        shape.push_back(rock.shape);
        orientation.push_back(rock.orientation);
    }
    /// Calls visit(array, the same array of `other`) for each array.
    template <class Visit>
    void each_array_with(const Rocks& other, const Visit& visit) {
        visit(id, other.id);
        visit(position, other.position);
        visit(velocity, other.velocity);
        visit(angular_velocity, other.angular_velocity);
        visit(diameter, other.diameter);
        visit(density, other.density);
        visit(shape, other.shape);
        visit(orientation, other.orientation);
    }
    /// Appends rock `p` of `from`.
    void append(const Rocks& from, std::size_t p) { append(from.at(p)); }
};

/// Force [N] that the fluid exerts on rock `index` (of rocks() as they were when advance was called) when it moves with `velocity` [m/s]:
/// drag and the Du/Dt parts. Neither weight nor buoyancy (the engine adds both) nor the -dv/dt part of added mass (it is part of the
/// engine's inertia).
using HydrodynamicForce = std::function<Vec3(std::size_t index, const Vec3& velocity)>;

/// Mean force [N] of rock on a wall.
struct WallForce {
    std::string wall;  ///< a name of the settings, or a side of the domain
    Vec3 force = Vec3::Zero();
    Vec3 pressed = Vec3::Zero();  ///< way [m] that it was pressed from its place, at the call's end
};

/// What rock has done to the triangles of a wall, in the order of the wall's file.
struct WallWork {
    std::string wall;                      ///< a name of the settings
    double since = 0.0;                    ///< from then on it is counted [s]
    std::vector<SteelTriangle> triangles;  ///< where the file has them [m]
    std::vector<double> impact;            ///< work of rock that comes closer, against the normal force [J]
    std::vector<double> sliding;           ///< work of friction [J]
};

/// What one call of advance did.
struct DemStep {
    std::vector<Vec3>
        impulse;  ///< of HydrodynamicForce on each rock of rocks() after the call [N s]: sum of force times DEM step, ends half
    std::vector<Vec3> contact_impulse;  ///< of all contacts on each rock, and of what holds a frozen one; in the order of `impulse` [N s]
    Rocks left;                         ///< rocks that left the DEM domain in the call, in their last state; no longer in rocks()
    std::vector<Vec3> left_impulse, left_contact_impulse;  ///< as `impulse` and `contact_impulse`, of `left` [N s]
    Vec3 gravity = Vec3::Zero();                           ///< that acted on all rocks [m/s2]
    double cutter_torque = 0.0;                            ///< mean torque of rock contacts on the rotating steel about the axis [N m]
    std::vector<WallForce> wall_force;                     ///< over the call, of every wall
    double max_overlap_ratio = 0.0;                        ///< largest overlap over rock radius in all steps of the call
    int substeps = 0;                                      ///< DEM steps of the call
    int contacts = 0;                                      ///< rock-rock and rock-wall contacts at the call's end
};

class DemEngine {
public:
    virtual ~DemEngine() = default;

    virtual const Rocks& rocks() const = 0;

    /// Largest DEM time step [s] that the contacts allow with the given rocks (fraction of Rayleigh and Hertz times).
    virtual double largest_time_step() const = 0;

    /// Whether each of these rocks has room: it lies in the domain and overlaps no wall, no rock of the run and none before it in `rocks`
    /// that has room.
    virtual std::vector<bool> room_for(const Rocks& rocks) const = 0;

    /// Inserts rocks (ids new, arrays of rocks sorted by id). Those without room are not inserted.
    /// \return ids that were inserted
    virtual std::vector<int> insert(const Rocks& rocks) = 0;
    virtual void remove(gsl::span<const int> ids) = 0;

    /// Ids of frozen rocks, sorted. A frozen rock has a velocity of exactly 0 and stays exactly where it is. It keeps its mass; in contacts
    /// of others with it that counts as infinite, and two frozen rocks have no contact. The fluid's force on it counts in
    /// DemStep::impulse as on any other.
    virtual std::vector<int> frozen() const { return {}; }
    virtual void freeze(gsl::span<const int>) { throw std::logic_error("this DEM does not hold rock"); }
    virtual void thaw(gsl::span<const int>) { throw std::logic_error("this DEM does not hold rock"); }

    /// Last time [s] at which a wall stops or is taken out; 0 when all stand. Infinite while rock does not bear what presses on it to 1 %.
    virtual double walls_change_until() const { return 0.0; }

    /// Advances by `duration` [s] in a whole number of equal steps, at most largest_time_step() long; the rotor turns along.
    virtual DemStep advance(double duration, const HydrodynamicForce& force) = 0;

    /// Of every wall given as STL that is not soil, summed over all ranks.
    virtual std::vector<WallWork> wall_work() const { return {}; }

    /// Angle [rad] that the walls of each moving zone have turned since time 0, as the rock meets them.
    virtual std::vector<double> zone_angles() const = 0;

    /// Writes rocks with their contact history into an existing folder / reads them back (before any insert).
    virtual void write_checkpoint(const std::filesystem::path& folder) = 0;
    virtual void read_checkpoint(const std::filesystem::path& folder) = 0;
    /// Takes the rocks of another run's checkpoint with their contacts, also with walls of the same names, before any insert. Time stays
    /// this run's.
    virtual void start_from(const std::filesystem::path&) { throw std::logic_error("this DEM starts without rock"); }
};

}  // namespace cutterflow::coupling
