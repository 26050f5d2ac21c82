#pragma once
/// \file Port to the fluid solver: flat arrays over this rank's cells, in mesh order. solver/foam implements it; tests use fakes.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gsl/span>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/vec3.hpp"

namespace cutterflow::coupling {

/// Rigid rotation of a zone of the mesh: angle(t) = speed * t, the one source for mesh, DEM walls and reports.
struct ZoneMotion {
    RotationAxis axis;
    double speed = 0.0;  ///< [rad/s], right-handed about the axis
    std::string name{};  ///< of the zone in the mesh
    double angle(double time) const { return speed * time; }
};

/// Number of a zone: 0 is the part of the mesh that stands still, k the moving zone k - 1 of FluidEngine::moving_zones().
using Zone = std::size_t;
inline constexpr Zone k_still_zone = 0;

/// The cells of this rank. They do not move in their zone's frame: cells of a moving zone are given at angle 0, the others in the
/// absolute frame. The arrays (and those of Steel) stay as they are, in place and value, for the engine's life.
struct Cells {
    gsl::span<const Vec3> centres;       ///< [m], zone's frame
    gsl::span<const double> volumes;     ///< [m3]
    gsl::span<const double> sizes;       ///< cell size dx [m], smooth in space
    gsl::span<const std::uint8_t> zone;  ///< number of each cell's zone
    gsl::span<const std::int64_t> ids;   ///< number in the whole mesh, whatever the number of ranks
};

/// A triangle of steel, in its zone's frame (as Cells).
struct SteelTriangle {
    Vec3 a, b, c;
};

/// All steel faces of the whole mesh (every rank has all of them): what hides a cell from a rock. And the soil, whose cells take no rock.
struct Steel {
    std::vector<gsl::span<const SteelTriangle>> of_zone;  ///< by zone
    gsl::span<const SteelTriangle> soil{};                ///< its closed surface, at rest; empty where there is none
};

/// Fields at the present time, one value per cell of this rank.
struct FluidFields {
    gsl::span<const Vec3> velocity;               ///< interstitial fluid velocity, absolute [m/s]
    gsl::span<const Vec3> material_acceleration;  ///< Du/Dt [m/s2]
    gsl::span<const double> void_fraction;        ///< [-]
};

/// Momentum that the rocks transfer to the fluid over one step, per cell. The fluid's momentum equation (divided by the fluid's density)
/// receives
///   explicit_source - drag_rate (u_new - u_old) - inertia (Du/Dt_new - Du/Dt_old)   [m/s2]
/// where "old" are the fields that FluidEngine::fields() showed when the step began, carried by the moving cells.
struct MomentumExchange {
    gsl::span<const Vec3> explicit_source;  ///< force on the fluid per mixture volume over fluid density [m/s2]
    gsl::span<const double> drag_rate;      ///< linearised drag [1/s], >= 0
    gsl::span<const double> inertia;        ///< (1 + C_AM) solid fraction [-], >= 0
};

/// Forces of the flow on the steel of the moving zone about its axis (0 without one), and flows through the boundary, at the present time
/// (whole mesh). Flows are of the fluid, alpha u, relative to the mesh, but for outlet_flow, which is of u.
struct FluidLoads {
    double torque_pressure = 0.0;           ///< [N m], positive about the axis' direction
    double torque_viscous = 0.0;            ///< [N m]
    std::optional<double> outlet_flow;      ///< volume flow out through the patch that PatchSettings::outlet names [m3/s]
    std::optional<double> outlet_pressure;  ///< area mean of p* there [m2/s2]
    double boundary_flow = 0.0;  ///< net volume flow out through open patches and interfaces: 0 when cells close and walls hold [m3/s]
    double wall_flow = 0.0;      ///< sum of |flow| over the faces of all walls [m3/s]
    double through_flow = 0.0;   ///< half of the sum of |flow| over the faces of all open patches; of a closed domain volume / step [m3/s]
    double interface_imbalance = 0.0;  ///< sum over interfaces of |flow out of one side - flow into the other| / gross flow [-]
    double interface_mismatch = 0.0;   ///< the same face by face, against the other side's overlapping parts / gross flow [-]
    double continuity_error = 0.0;     ///< sum |cell residual of d(alpha)/dt + div(alpha u)| V / (2 through_flow) [-]
    double domain_surplus = 0.0;       ///< of a closed domain: |volume that a step's continuity has too much| / volume; 0 of an open one
    int clipped_cells = 0;             ///< in which a field of the turbulence model was raised to its least value, over all fields
    double courant_max = 0.0;
    double speed_max = 0.0;          ///< of the fluid in a cell [m/s]
    std::optional<Vec3> soil_force;  ///< of the water on the soil, by p* and stress [N]; none without soil
    // With rock only, over the last step:
    Vec3 boundary_impulse =
        Vec3::Zero();  ///< on the fluid by pressure, stress and through-flow of patches that are no interface, and by soil [N s]
    Vec3 interface_impulse = Vec3::Zero();  ///< the same of both sides of all sliding interfaces: 0 where they conserve [N s]
    Vec3 replaced_momentum = Vec3::Zero();  ///< [N s] of fluid that took the place of rock that left, less that of fluid it pushed aside
                                            ///< (also below rock where the mesh turns), without a source in the equations
    Vec3 turned_momentum =
        Vec3::Zero();  ///< [N s] by which pressure, stress and convection in turning cells act half a turn of the step ahead
};

/// Places and vectors there, in groups of equal size that follow each other.
struct WatchedPlaces {
    std::vector<Vec3> points;      ///< [m]
    std::vector<Vec3> directions;  ///< as many, of any length
    std::size_t groups = 0;
};

class FluidEngine {
public:
    virtual ~FluidEngine() = default;

    /// False when the flow is given and takes nothing from rock (one-way coupling): received() and loads() are then not asked for.
    virtual bool feels_rock() const { return true; }

    virtual Cells cells() const = 0;
    /// Collective when it is asked for the first time.
    virtual Steel steel() const = 0;
    /// Empty on a mesh that stands still.
    virtual gsl::span<const ZoneMotion> moving_zones() const = 0;
    virtual FluidFields fields() const = 0;

    /// Curl of the velocity of fields() [1/s], per cell; computed on request. Collective.
    virtual gsl::span<const Vec3> vorticity() = 0;
    /// div(tau), tau the laminar and turbulent stress of the velocity of fields() over density [m/s2], per cell; as vorticity().
    virtual gsl::span<const Vec3> stress_divergence() = 0;

    virtual double time() const = 0;            ///< of fields() [s]
    virtual std::string time_name() const = 0;  ///< of fields(), as the engine's own folders are called
    virtual double time_step() const = 0;       ///< of the step under way or just done, before a resumed run's first too [s]
    /// False when the end time is reached or the user asked to stop (controlDict stopAt, signals).
    virtual bool running() = 0;

    /// Begins a step: picks its length from the Courant limit and `travel_limit` [s] (what rocks and interface allow; infinity: no limit),
    /// such that equal steps lead to the next time at which fields are written or to `stop_time` [s] (rock comes in then; infinity: none);
    /// advances the time, moves the mesh. After it, fields() still shows the old values in the moved cells.
    virtual void begin_step(double travel_limit, double stop_time) = 0;

    /// Volume rate at which the steel beside each cell moves out of the fluid in the step under way [m3/s]: negative where it moves in. Its
    /// sum over a closed body is 0.
    virtual gsl::span<const double> wall_retreat() const = 0;

    /// Ends the step: solves momentum, pressure (with d(alpha)/dt from the two void fractions, both evaluated on the moved mesh) and
    /// turbulence. \param void_fraction_old  void fraction of the old rock positions on the new mesh, corrected for the volume swept by
    /// moving walls (wall_retreat); \param void_fraction_new  for their new ones; one per cell.
    virtual void end_step(gsl::span<const double> void_fraction_old, gsl::span<const double> void_fraction_new,
                          const MomentumExchange& exchange) = 0;

    /// Replaces the present void fraction without a source (rock was inserted or removed).
    virtual void reset_void_fraction(gsl::span<const double> void_fraction) = 0;

    /// Momentum that the fluid received in the last step, per cell [m/s2]: its gain less outflow, pressure and stress, by its state.
    virtual gsl::span<const Vec3> received() const = 0;

    /// Fluid velocity at points of the absolute frame (whole mesh; collective): value of the cell that holds or is nearest to the point,
    /// carried to it with the cell's gradient. The same result on every rank.
    virtual void sample_velocity(gsl::span<const Vec3> points, gsl::span<Vec3> velocity) = 0;

    /// From now on watched_means() is of these places. They are given as they lie at time 0: in a moving zone points and directions turn
    /// with it, which does not change means over circles about its axis. Collective.
    virtual void watch(const WatchedPlaces& places) = 0;
    /// Mean of the velocity along the directions [m/s], per group of watched places; velocities as from sample_velocity. Collective.
    virtual std::vector<double> watched_means() = 0;

    virtual FluidLoads loads() = 0;

    /// Writes the fields when due by the case's write control. \return true when it wrote
    virtual bool write_if_due() = 0;
    /// Writes the fields of the present time as a restart state, regardless of the write control.
    virtual void write_now() = 0;
};

}  // namespace cutterflow::coupling
