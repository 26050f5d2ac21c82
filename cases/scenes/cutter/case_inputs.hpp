#pragma once
/// \file What a case is made of: plain numbers in SI units and in the run's frame (docs/design/001-contracts.md), from which the case
/// builder writes an OpenFOAM case.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cases/scenes/flow/flow_files.hpp"
#include "cases/study/shape_file.hpp"
#include "geometry/base/axial_cylinder.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/head/contour.hpp"
#include "solver/ports/dem_settings.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::cases {

struct Rotor {
    RotationAxis axis;   ///< from hub to ring
    double speed = 0.0;  ///< [rad/s], right-handed about the axis; not 0
};

/// Times of the transient run [s]; 0 is its start, with the frozen rotor's flow.
struct RunTimes {
    double end = 0.0;
    double write_interval = 0.0;   ///< fields and rocks
    double first_time_step = 0.0;  ///< the Courant limit takes over after it
    double development_end = 0.0;  ///< until then steps are longer by k_development_step_ratio; 0 for never
};

/// A point at which the run averages the velocity.
struct VelocityPoint {
    Vec3 place = Vec3::Zero();  ///< [m]; of a rotating point at rotor angle 0
    bool rotating = false;      ///< turns with the head
};

struct VelocitySetInput {
    std::string name;
    int phases = 0;  ///< bins of rotor angle; 0: the mean alone
    std::vector<VelocityPoint> points;
};

/// Everything the case builder needs. What the solver reads is kept in the solver's own structs; solver_settings and dem_settings complete
/// them with what follows from the rest.
struct CaseInputs {
    explicit CaseInputs(geometry::Contour head);

    geometry::Contour contour;  ///< carries ring radius and backplate
    Rotor rotor;
    double discharge = 0.0;       ///< [m3/s], of the mixture, out of the suction pipe
    Vec3 gravity = Vec3::Zero();  ///< [m/s2]
    Vec3 hauling = Vec3::Zero();  ///< of soil and of water far off, in the frame that travels with the head [m/s]; 0: it does not travel
    coupling::FluidProperties fluid{998.2, 1.0034e-6};
    AxialCylinder tank;  ///< the water
    FlowNumerics numerics;
    RunTimes times;
    coupling::FateSettings fates;
    coupling::OutflowSettings outflow;
    coupling::CheckpointSettings checkpoint;
    std::optional<coupling::StopSettings> stop;
    std::optional<coupling::RecordSettings> record;
    std::filesystem::path replay;  ///< folder of a recording that is played instead of a solved flow; empty: none
    coupling::KernelSettings kernel;
    coupling::ClosureSettings closures;
    int blades = 1;
    std::vector<VelocitySetInput> velocity_sets;  ///< averaged from outflow.start_time on
    int ranks = 1;
    struct Rock {
        coupling::ContactSettings contact;
        std::vector<coupling::WallSettings> walls;  ///< files relative to the run directory
        double density = 2650.0;                    ///< [kg/m3], the heaviest of the feed
        std::vector<ShapeFile> shapes{};            ///< of rock that is no sphere
    };
    std::optional<Rock> rock;                      ///< none: pure flow
    std::optional<coupling::QueueSettings> queue;  ///< of rock that comes all the time; none: batches
    std::optional<double> bank_permeability;       ///< [m2]; water feels the soil of names::bank_surface; none: there is no bank
};

/// What the solver reads in constant/couplingProperties, files relative to the run directory.
coupling::CouplingSettings solver_settings(const CaseInputs& inputs);

/// The same of the DEM; its domain is the water. \pre inputs.rock
coupling::DemSettings dem_settings(const CaseInputs& inputs);

/// Largest radius [m] of a head.
double tip_radius(const geometry::Contour& contour);

/// Speed [m/s] of the rotor's outermost point.
double tip_speed(const CaseInputs& inputs);

/// Mean speed [m/s] in the suction mouth.
double mouth_speed(const CaseInputs& inputs);

/// Gravity [m/s2] in the run's frame for a ladder `inclination` [rad] below horizontal: g (cos, 0, -sin).
Vec3 gravity_of(double inclination);

/// How much longer steps are while the flow develops and nothing looks at it.
constexpr double k_development_step_ratio = 3.0;

/// Longest time step [s] whatever the Courant number: the rotor turns one degree.
/// \param speed  of the rotor [rad/s], either sign
double largest_time_step(double speed);

/// Young's modulus [Pa] with which a rock of inputs.rock that hits steel at the tip speed overlaps it by 5 % of its radius. The wall is as
/// soft as the rock, and added mass takes part in the impact. \pre inputs.rock
double youngs_modulus_for(const CaseInputs& inputs);

/// Fills what follows the head's size and speed and was left at 0: bin width 0.075 R, outflow offset 0.0375 R (30 mm and 15 mm at
/// R = 0.40 m, the reference model), depth of "sucked up" one mouth diameter, largest rock speed = tip speed + mouth speed, Young's
/// modulus of youngs_modulus_for.
void fill_scaled_defaults(CaseInputs& inputs);

/// File of a velocity set's points, relative to the run directory.
std::string sample_file(const VelocitySetInput& set);

/// Every rule that the inputs break, those of the solver included; empty when a case can be written.
std::vector<Mistake> check_case_inputs(const CaseInputs& inputs);

}  // namespace cutterflow::cases
