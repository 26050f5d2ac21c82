#pragma once
/// \file What a case is made of: plain numbers in SI units and in the run's frame (docs/design/001-contracts.md), from which the case
/// builder writes an OpenFOAM case.
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/head/contour.hpp"

namespace cutterflow::cases {

struct Rotor {
    RotationAxis axis;   ///< from hub to ring
    double speed = 0.0;  ///< [rad/s], right-handed about the axis; not 0
};

struct Fluid {
    double kinematic_viscosity = 1.0034e-6;  ///< [m2/s]
    double density = 998.2;                  ///< [kg/m3]
};

/// The cylinder of water about the axis.
struct Tank {
    double radius = 0.0;  ///< [m]
    double z_min = 0.0;   ///< [m], the bed
    double z_max = 0.0;   ///< [m]
};

/// The suction mouth in the backplate.
struct Mouth {
    Vec3 centre = Vec3::Zero();      ///< [m]
    Vec3 direction = Vec3::UnitZ();  ///< unit, into the pipe
    double radius = 0.0;             ///< [m]
    double sucked_up_depth = 0.0;    ///< [m] along `direction`; rock beyond it is sucked up
};

/// Scheme of momentum convection in the transient run. The frozen-rotor start is always upwind.
enum class ConvectionScheme {
    upwind,          ///< first order
    limited_linear,  ///< second order, limited to upwind where the velocity is not smooth
};

/// How the transient flow is solved. docs/design/007-flow-settings.md has the measurements behind the defaults.
struct FlowNumerics {
    std::optional<ConvectionScheme> convection;  ///< none: upwind with rock, as the reference work; limited_linear for the flow alone
    double max_courant = 0.9;
    int outer_correctors = 1;
    int pressure_correctors = 2;
};

/// Times of the transient run [s]; 0 is its start, with the frozen rotor's flow.
struct RunTimes {
    double end = 0.0;
    double write_interval = 0.0;  ///< fields and rocks
    double checkpoint_interval = 0.0;
    int checkpoints_kept = 2;
    double outflow_from = 0.0;     ///< the radial outflow is averaged from here on
    double first_time_step = 0.0;  ///< the Courant limit takes over after it
};

/// A rock or steel body of the DEM.
struct Wall {
    std::string name;
    std::string file;  ///< relative to the run directory
    bool rotating = false;
};

/// Contacts, kernels and closures of the rock. Keys and meanings as in constant/couplingProperties.
struct Rock {
    double density = 2650.0;      ///< [kg/m3], the heaviest of the feed
    double youngs_modulus = 0.0;  ///< [Pa], of rock and steel alike
    double poisson_rock = 0.24;
    double poisson_steel = 0.27;
    double friction = 0.15;
    double restitution = 0.97;  ///< dry
    bool wet_restitution = true;
    double time_step_fraction = 0.1;  ///< of the smaller of Rayleigh and Hertz times
    double max_speed = 0.0;           ///< [m/s], for the Hertz time
    std::vector<Wall> walls;

    double kernel_gamma = 1.0;  ///< kernel width over the rock's diameter
    double kernel_min_width_in_cells = 1.5;
    double max_solid_fraction = 0.7;

    std::string drag = "brown_lawler";
    std::string hindrance = "di_felice";
    double added_mass = 0.5;
    double drag_modifier = 1.0;
    double sphericity = 1.0;
    std::string lift = "none";
    bool viscous_force = true;
};

/// Settings of fates and outflow sampling.
struct Fates {
    double hysteresis = 0.25;              ///< of the rock's diameter
    double bin_width = 0.0;                ///< [m]
    double outflow_offset = 0.0;           ///< [m] outside the contour
    std::optional<double> stop_undecided;  ///< ends the run when the undecided share is at most this
};

/// A point at which the run averages the velocity.
struct VelocityPoint {
    Vec3 place = Vec3::Zero();  ///< [m]; of a rotating point at rotor angle 0
    bool rotating = false;      ///< turns with the head
};

struct VelocitySet {
    std::string name;
    int phases = 0;  ///< bins of rotor angle; 0: the mean alone
    std::vector<VelocityPoint> points;
};

/// Everything the case builder needs. The contour carries ring radius and backplate.
struct CaseInputs {
    explicit CaseInputs(geometry::Contour head) : contour(std::move(head)) {}

    geometry::Contour contour;
    Rotor rotor;
    double discharge = 0.0;       ///< [m3/s], of the mixture, out of the suction pipe
    Vec3 gravity = Vec3::Zero();  ///< [m/s2]
    Fluid fluid;
    Tank tank;
    Mouth mouth;
    FlowNumerics numerics;
    RunTimes times;
    Fates fates;
    int blades = 1;
    std::vector<VelocitySet> velocity_sets;  ///< averaged from times.outflow_from on
    int ranks = 1;
    std::optional<Rock> rock;  ///< none: pure flow
};

/// Largest radius [m] of a head.
double tip_radius(const geometry::Contour& contour);

/// Speed [m/s] of the rotor's outermost point.
double tip_speed(const CaseInputs& inputs);

/// Mean speed [m/s] in the suction mouth.
double mouth_speed(const CaseInputs& inputs);

/// Gravity [m/s2] in the run's frame for a ladder `inclination` [rad] below horizontal: g (cos, 0, -sin).
Vec3 gravity_of(double inclination);

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

/// Every rule that the inputs break; empty when a case can be written.
std::vector<Mistake> check_case_inputs(const CaseInputs& inputs);

}  // namespace cutterflow::cases
