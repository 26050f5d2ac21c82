#pragma once
/// \file A room as its study describes it: a box with solids, grains and perhaps a medium. SI units; x and y are centred on 0, z runs from
/// 0 up. Everything that builds a room's case works from this alone.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "geometry/base/region.hpp"
#include "geometry/base/vec3.hpp"
#include "geometry/clump/unit_clump.hpp"
#include "geometry/surface/surface.hpp"
#include "solver/ports/dem_settings.hpp"

namespace cutterflow::cases {

/// What fills the room.
struct RoomMedium {
    std::string name = "none";         ///< water, air or none
    double density = 0.0;              ///< [kg/m3]; 0 for none
    double kinematic_viscosity = 0.0;  ///< [m2/s]; 0 for none
    std::string turbulence;            ///< realizableKE, laminar; empty for none

    bool present() const { return name != "none"; }
};

/// Smaller cells in a part of the room.
struct RoomRefinement {
    Region region;      ///< a box or a cylinder
    double cell = 0.0;  ///< side of its cells [m]
};

/// A round hole along a straight axis, as of a pipe: `inside = "pipe"` names the disc that it cuts out of a side.
struct Bore {
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< ends of its axis [m]
    double radius = 0.0;                          ///< [m]
};

struct RoomSolid {
    std::string name;
    geometry::TriangleSurface surface;  ///< closed, outward; where it stands at first
    bool felt_by_fluid = true;          ///< false: grains alone feel it
    std::string material;
    std::vector<coupling::WallTravel> travels;  ///< one after the other
    std::optional<coupling::WallTurn> turn;
    std::optional<double> removed_at;  ///< [s]; 0: it is there for the preparation alone
    std::optional<Bore> bore;
    double thinnest = 0.0;  ///< its thinnest part, for the mesh [m]; 0: not known, as of a file
    double opening = 0.0;   ///< diameter or width of the one in its floor or of its spout [m]; 0: none

    double fastest() const;  ///< largest speed of its surface [m/s]
};

/// What grains meet at a side of the room.
enum class SideForGrains { wall, open, frictionless };

/// Part of a side that a boundary condition holds on.
struct WholeSide {};
/// Of the vertical sides: what lies above (or below) a level [m].
struct SideBand {
    double from = 0.0, to = 0.0;
};
struct SideDisc {
    Vec3 centre = Vec3::Zero();
    double radius = 0.0;
};
struct SideRectangle {
    Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
};
using SidePart = std::variant<WholeSide, SideBand, SideDisc, SideRectangle>;

struct NoSlip {};
struct Slip {};
struct RoughWall {
    double height = 0.0;  ///< k_s [m]
};
struct FixedPressure {};
/// Flow through the part, by time: into the room, or out of it.
struct ThroughFlow {
    bool into_room = true;
    std::vector<std::pair<double, double>> speed;  ///< time [s], mean speed over the part [m/s]; linear between, constant outside
    double area = 0.0;                             ///< of the part [m2]

    double largest_speed() const;  ///< [m/s]
    double changes_until() const;  ///< [s]; 0 for a steady one
};
using SideFlow = std::variant<NoSlip, Slip, RoughWall, FixedPressure, ThroughFlow>;

/// A boundary condition of the fluid on a part of sides. Later rows cover earlier ones. Without a row a side is a wall with no slip.
struct RoomBoundary {
    std::string name;  ///< of its patch
    std::vector<coupling::DomainSide> sides;
    SidePart part;
    SideFlow flow;
};

/// Elastic numbers of a material. The DEM knows one Young's modulus for all.
struct RoomMaterial {
    std::string name;
    double poisson = 0.25;
};

/// Contacts of the grains' material with itself or with another one.
struct RoomPair {
    std::string other;  ///< name of the material
    coupling::PairSettings settings;
};

/// Diameters of a kind of grains.
struct GrainClass {
    double diameter = 0.0;    ///< [m]
    double mass_share = 1.0;  ///< they sum to 1
    double density = 0.0;     ///< [kg/m3]
};
struct UniformByNumber {
    double smallest = 0.0, largest = 0.0;  ///< [m]
};
using GrainSizes = std::variant<std::vector<GrainClass>, UniformByNumber>;

struct RoomGrains {
    std::string name;
    double density = 0.0;  ///< of all sizes, or of classes that give none of their own [kg/m3]
    GrainSizes sizes;
    std::filesystem::path clump;               ///< file of a clump; empty: spheres
    std::string clump_text;                    ///< of that file
    std::optional<geometry::UnitClump> shape;  ///< that it describes; none: spheres

    double girth() const;         ///< diameter of the sphere around a grain over that of the sphere of its volume
    std::size_t spheres() const;  ///< of a grain
    /// Its classes; of a range of diameters its ends.
    std::vector<GrainClass> extremes() const;
    double smallest() const;      ///< [m]
    double largest() const;       ///< [m]
    double mean_mass() const;     ///< of a grain [kg], by number
    double mean_density() const;  ///< mass over volume of many grains [kg/m3]
};

/// Steps of the preparation, in still medium before t = 0.
struct PourStep {
    std::string grains;
    Region region;                       ///< a box or an upright cylinder, whose lower end the grains come to lie on
    double mass = 0.0;                   ///< [kg]; of a count the expected one
    std::string where;                   ///< in the study, for messages
    std::optional<std::size_t> count{};  ///< of grains
};
/// Until the grains are at rest.
struct SettleStep {
    double longest = 0.0;  ///< refused when grains are not at rest by then [s]
};
/// Grains whose centres are in the region are taken out.
struct TrimStep {
    Region region;
};
/// Grains whose centres are in the region stay where they are; there are some.
struct FreezeStep {
    Region region;
    std::string where{};  ///< in the study, for messages
};
/// A solid is pressed on the grains until they bear it; then it stands.
struct CompressStep {
    std::string solid;
    Vec3 direction = -Vec3::UnitZ();
    double pressure = 0.0;  ///< [Pa]
    double force = 0.0;     ///< that pressure on the solid's area [N]
    double longest = 0.0;   ///< as of SettleStep [s]
};
using PrepareStep = std::variant<PourStep, SettleStep, TrimStep, FreezeStep, CompressStep>;

/// Events of the run.
struct FeedEvent {
    std::string grains;
    double from = 0.0, to = 0.0;  ///< [s]
    double rate = 0.0;            ///< [kg/s]
    Region region;                ///< a box or an upright cylinder in which grains begin

    std::string where{};  ///< in the study, for messages

    double mass(double end) const { return rate * std::max(0.0, std::min(to, end) - from); }  ///< until `end` of the run [kg]
};
struct ExtractEvent {
    double from = 0.0, to = 0.0;  ///< [s]
    double rate = 0.0;            ///< [kg/s]
    Region region;
};
struct RegionEvent {
    std::string what;  ///< remove, freeze or thaw
    double at = 0.0;   ///< [s]
    Region region;
    std::string where{};  ///< of a step of the preparation, in the study
};
using RoomEvent = std::variant<FeedEvent, ExtractEvent, RegionEvent>;

/// A plane opening at which every crossing of a grain's centre is counted: disc or rectangle.
struct RoomGate {
    std::string name;
    Vec3 centre = Vec3::Zero(), normal = Vec3::UnitZ();
    double radius = 0.0;                              ///< 0: a rectangle
    Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();  ///< opposite corners of a rectangle
};

/// The run ends before its end when no grain has passed a gate for a time, when few do, or when all are at rest.
struct StopWhenIdle {
    std::string gate;
    double idle = 0.0;  ///< [s]
};
/// Less than a rate passes a gate in the mean over a window.
struct StopWhenBelow {
    std::string gate;
    double rate = 0.0;    ///< [kg/s]
    double window = 0.0;  ///< [s]
};
struct StopWhenAtRest {};
using RoomStop = std::variant<std::monostate, StopWhenIdle, StopWhenBelow, StopWhenAtRest>;

struct RoomRun {
    double end = 0.0;                  ///< [s]
    double write_interval = 0.0;       ///< between pictures [s]
    double checkpoint_interval = 0.0;  ///< [s]
    double longest_step = 0.0;         ///< between looks at events, pictures and stop rules without a medium; at most, with one [s]
    double max_courant = 0.0;          ///< with a medium [-]
    std::uint64_t seed = 1;            ///< of every random number
    RoomStop stop;
};

struct RoomScene {
    std::string name;
    Vec3 size = Vec3::Zero();
    double gravity_strength = 9.81;  ///< [m/s2]
    double tilt = 0.0;               ///< of gravity from the vertical, towards +x, in the run; the preparation is upright [rad]
    RoomMedium medium;
    double cell = 0.0;  ///< of the mesh [m]; 0 without a medium
    std::vector<RoomRefinement> refinements;

    std::vector<RoomSolid> solids;
    std::vector<RoomBoundary> boundaries;  ///< of the fluid; empty without a medium
    std::array<SideForGrains, 6> sides{};  ///< by coupling::DomainSide
    std::string side_material;             ///< of the sides that are walls

    coupling::ContactSettings contact;  ///< Young's modulus, Poisson ratios, rolling law, share of the stable step, fastest impact
    std::string grain_material;
    std::vector<RoomPair> pairs;  ///< the grains' material with itself and with every material of solids and sides

    std::vector<RoomGrains> grains;
    std::vector<PrepareStep> preparation;
    std::vector<RoomEvent> events;
    nlohmann::json measures = nlohmann::json::array();  ///< tables [[measure]] as they are, with absolute defaults filled in
    std::vector<RoomGate> gates;                        ///< of measures that count what passes, by the measure's name
    RoomRun run;

    double bed_step = 0.0;       ///< between looks at grains that come in and at rest, of the preparation [s]
    double bed_max_speed = 0.0;  ///< fastest impact of the preparation, in which solids stand [m/s]

    // Settings of the coupling; they count with a medium.
    coupling::KernelSettings kernel;
    coupling::ClosureSettings closures;

    Vec3 gravity() const { return gravity_strength * Vec3(std::sin(tilt), 0.0, -std::cos(tilt)); }  ///< of the run [m/s2]
    Vec3 upright_gravity() const { return {0.0, 0.0, -gravity_strength}; }                          ///< of the preparation [m/s2]
    coupling::ContactSettings bed_contact() const;                                                  ///< of the preparation
    Vec3 lower() const { return {-0.5 * size.x(), -0.5 * size.y(), 0.0}; }
    Vec3 upper() const { return {0.5 * size.x(), 0.5 * size.y(), size.z()}; }
    double smallest_grain() const;                               ///< diameter [m]; infinity without grains
    double largest_grain() const;                                ///< diameter [m]; 0 without grains
    double longest_grain() const;                                ///< of the sphere around it, as of a clump [m]; 0 without grains
    double densest_grain() const;                                ///< largest density [kg/m3]; 0 without grains
    double fed_mass() const;                                     ///< that feeds give until the run's end [kg]
    double tolerance() const { return 1e-6 * size.maxCoeff(); }  ///< lengths below it are rounding [m]
    /// Whether a solid is there at a time of the run, and neither moved nor was pressed until then.
    bool is_as_at_first(const RoomSolid& solid, double time) const;
    const RoomGrains* find_grains(const std::string& name) const;
    const RoomSolid* find_solid(const std::string& name) const;
    const RoomGate* find_gate(const std::string& name) const;
};

}  // namespace cutterflow::cases
