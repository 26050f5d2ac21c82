#pragma once
/// \file Settings of the coupled algorithm, as plain numbers. solver/foam fills it from constant/couplingProperties.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/error.hpp"
#include "geometry/base/vec3.hpp"
#include "geometry/head/contour.hpp"
#include "solver/ports/bed_operations.hpp"
#include "solver/ports/clump_shape.hpp"
#include "solver/ports/setting_table.hpp"

namespace cutterflow::coupling {

/// The carrier fluid.
struct FluidProperties {
    double density = 0.0;              ///< [kg/m3]
    double kinematic_viscosity = 0.0;  ///< [m2/s]
};

/// How rock is laid over cells and sees them.
inline constexpr const char* k_gaussian_map = "gaussian";  ///< by kernels that know distance and steel
inline constexpr const char* k_centroid_map = "centroid";  ///< as a whole in the cell of its centre
inline constexpr const char* k_cluster_map = "cluster";    ///< evenly over the cells of a cube

/// From where a rock samples the fluid.
inline constexpr const char* k_gaussian_sampling = "gaussian";  ///< nearer than the kernel by which it is laid
inline constexpr const char* k_quadratic_sampling =
    "quadratic";  ///< mostly 1.5 to 2.8 widths away, clear of what the rock does to the fluid

/// The map between rock and cells; the width of its kernels, sigma = max(gamma d, min_width_in_cells dx), and the largest solid fraction
/// of a cell.
struct KernelSettings {
    std::string map = k_gaussian_map;
    std::string sampling = k_gaussian_sampling;  ///< of map gaussian
    double cluster_size = 0.0;                   ///< side of the cubes of map cluster [m]; 0: none given
    double gamma = 1.0;                          ///< [-]
    double min_width_in_cells = 1.5;             ///< [-]
    double max_solid_fraction = 0.7;             ///< [-]
};

template <>
const SettingTable<KernelSettings>& setting_table<KernelSettings>();

/// Names as physics::catalogue() has them.
struct ClosureSettings {
    std::string drag = "brown_lawler";
    std::string hindrance = "di_felice";
    double added_mass = 0.5;     ///< C_AM [-]
    double drag_modifier = 1.0;  ///< factor on the drag of every rock [-]
    double sphericity = 1.0;     ///< of rock whose shape has none of its own [-], for drag laws that use it
    std::string lift = "none";
    bool viscous_force = true;  ///< false: rho V Du/Dt less its viscous part, so that the pressure gradient's part is left
};

template <>
const SettingTable<ClosureSettings>& setting_table<ClosureSettings>();

/// The suction mouth: rock is sucked up for good once it is `depth` beyond the centre along `direction`, within `radius` of the mouth's
/// axis.
struct MouthSettings {
    Vec3 centre = Vec3::Zero();      ///< [m]
    Vec3 direction = Vec3::UnitZ();  ///< into the pipe
    double radius = 0.0;             ///< [m]
    double depth = 0.0;              ///< [m]
};

/// Rock comes from a cut face. What lies outside the head, farther than `distance` from its contour or more than `distance_behind` behind
/// the rotor's axis, is left behind and taken out.
struct CuttingSettings {
    double distance = 0.0;         ///< [m]
    Vec3 behind = Vec3::Zero();    ///< against the swing, of length 1
    double distance_behind = 0.0;  ///< [m]
};

struct FateSettings {
    std::filesystem::path contour;  ///< CSV z_m,r_m
    double ring_radius = 0.0;       ///< [m]
    double z_backplate = 0.0;       ///< [m]
    double hysteresis = 0.25;       ///< of the rock's diameter
    MouthSettings mouth;
    double bin_width = 0.0;                  ///< [m]
    std::optional<CuttingSettings> cutting;  ///< none: rock comes in batches, and stays wherever it goes
};

/// Sampling of the radial velocity just outside the contour.
struct OutflowSettings {
    double offset = 0.0;      ///< [m] outside the contour
    double start_time = 0.0;  ///< [s], from which the report averages
};

template <>
const SettingTable<OutflowSettings>& setting_table<OutflowSettings>();

/// A set of points at which the velocity is averaged.
struct VelocitySetSettings {
    std::string name;            ///< of the result's file; letters, digits, '-' and '_'
    std::filesystem::path file;  ///< CSV x_m,y_m,z_m,rotating
    int phases = 0;              ///< bins of rotor angle for phase averages; 0: none, and nothing by revolution either
};

/// Averages of the velocity at points, over whole revolutions.
struct VelocitySettings {
    double start_time = 0.0;  ///< [s], averaged from here on
    double interval = 3.0;    ///< of rotor angle between samples [deg]
    int blades = 1;           ///< phases at still points repeat with every blade
    std::vector<VelocitySetSettings> sets;
};

/// The run ends when the undecided share of the placed mass is this small and every feed has been inserted, or when production of a head
/// that is fed all the time is steady and half its 95 % interval at most `target_half_width`.
struct StopSettings {
    double undecided = 0.0;          ///< [-]
    double target_half_width = 0.0;  ///< of delivered over fed [-]; 0: the interval ends no run
};

template <>
const SettingTable<StopSettings>& setting_table<StopSettings>();

struct CheckpointSettings {
    double interval = 0.0;  ///< of simulated time [s]
    int keep = 2;           ///< newest ones that stay
};

template <>
const SettingTable<CheckpointSettings>& setting_table<CheckpointSettings>();

/// The flow is recorded by rotor phase, for replays without a fluid solver.
struct RecordSettings {
    double start_time = 0.0;  ///< [s]
    double end_time = 0.0;    ///< [s]
    int phases = 48;          ///< over one turn of the rotor for its own cells, over one passing of a blade for those that stand still
    int blades = 1;           ///< equal ones
};

template <>
const SettingTable<RecordSettings>& setting_table<RecordSettings>();

/// Roles of boundary patches, by name.
struct PatchSettings {
    std::string outlet;              ///< whose flow and pressure are reported; empty: none is
    std::vector<std::string> steel;  ///< walls that hide the fluid behind them from rock; empty: all patches of type wall
};

/// Rock that comes all the time goes in by packets, and waits where it finds no place (FeedQueue).
struct QueueSettings {
    double interval = 0.0;        ///< between packets [s]
    double retry_interval = 0.0;  ///< until rock without a place is due again [s]
    double reach = 0.0;           ///< how far ahead of its place rock may go in, about the rotor's axis [rad]
};

template <>
const SettingTable<QueueSettings>& setting_table<QueueSettings>();

/// Without a medium: while the root mean square of the velocities of rock that is not frozen is at most `speed`, rock is slowed down by the
/// force -m v/time. What is left of the motion of a bed that only has to come to rest, loose grains that bounce in their cages and the
/// bed's own elastic waves, dies down with `time` instead of going on for seconds. [CundallStrack1979]
struct CalmingSettings {
    double speed = 0.0;  ///< [m/s]
    double time = 0.0;   ///< [s]
};

template <>
const SettingTable<CalmingSettings>& setting_table<CalmingSettings>();

/// Soil that stands in the water: a bank, a bed.
struct SoilSettings {
    std::filesystem::path surface;  ///< STL [m] that closes it, absolute frame
    double permeability = 0.0;      ///< [m2]; 0: solid
    Vec3 velocity = Vec3::Zero();   ///< with which soil flows through its surface, which is at rest [m/s]
};

template <>
const SettingTable<SoilSettings>& setting_table<SoilSettings>();

/// All settings of couplingProperties for the coupled algorithm. `kernel`, `closures`, `fates` and `stop` count with rock only, but for
/// the contour of `fates`, which `outflow` needs too.
struct CouplingSettings {
    bool has_rock = false;
    bool has_medium = true;               ///< false: rock moves by weight and contacts alone, without mesh and fields
    std::optional<double> largest_speed;  ///< that the fluid in a cell may have [m/s]; none: any
    PatchSettings patches;
    std::optional<SoilSettings> soil;
    std::filesystem::path rock_feed;   ///< CSV, with rock
    std::filesystem::path rock_start;  ///< folder of a checkpoint of the DEM, whose rock is in from the start on; empty: none
    std::vector<OperationSettings> operations;
    std::vector<GateSettings> gates;
    std::optional<AtRestSettings> at_rest;
    std::optional<IdleSettings> idle;
    std::optional<BelowSettings> below;
    std::vector<ClumpShape> shapes;      ///< that rock of the feed may have, as the DEM's
    std::optional<QueueSettings> queue;  ///< none: the feed's rock comes in batches
    std::optional<CalmingSettings> calming;
    KernelSettings kernel;
    ClosureSettings closures;
    std::optional<FateSettings> fates;  ///< needed by outflow and stop; without, rock is followed but not sorted by fate
    std::optional<OutflowSettings> outflow;
    std::optional<VelocitySettings> velocity;
    std::optional<StopSettings> stop;
    std::optional<CheckpointSettings> checkpoint;
    std::optional<RecordSettings> record;
    std::filesystem::path replay;  ///< folder of a recording whose flow is played instead of solved; empty: none
};

/// Calls `visit(key, section)` with each section that says how rock and fluid act on each other. They count with rock in a medium. Each
/// holds the rows of its struct's table and nothing else, so that the reader of couplingProperties and the checks need no line for it. A
/// section may be std::optional. \param settings  CouplingSettings, const or not
template <class Settings, class Visit>
void visit_coupling_sections(Settings& settings, Visit visit) {
    visit("kernel", settings.kernel);
    visit("closures", settings.closures);
}

/// Every mistake of the settings (not of the files they name); `where` precedes each, as "constant/couplingProperties".
std::vector<Mistake> check_settings(const CouplingSettings& settings, const FluidProperties& fluid, const std::string& where);

/// Reads the contour `z_m,r_m`. \throws UserError with every mistake of the file
geometry::Contour read_contour(const FateSettings& fates);

}  // namespace cutterflow::coupling
