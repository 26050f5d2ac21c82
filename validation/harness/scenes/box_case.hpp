#pragma once
/// \file Box-shaped cases for cutterFoam, written by hand as a user would: the simplest rooms in which the coupling can be held against
/// a known answer.
#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "geometry/base/vec3.hpp"

namespace cutterflow::validation {

struct BoxRock {
    int id = 0;
    double time = 0.0;      ///< [s]
    Vec3 position;          ///< [m]
    double diameter = 0.0;  ///< [m]
    double density = 2650;  ///< [kg/m3]
    Vec3 velocity = Vec3::Zero();
    std::string shape{};  ///< of rock.shapes; empty: a sphere
};

/// Pairs of rock.contact: friction 0.15, rock rolls freely. [NieuwboerVanRheeKeetels2023]
inline constexpr const char* k_paper_contact_pairs =
    "pairs { rock_rock { friction 0.15; restitution 0.97; rollingFriction 0; } "
    "rock_steel { friction 0.15; restitution 0.97; rollingFriction 0; } }";

/// What the six sides of the box are.
enum class BoxSides {
    closed,    ///< slip walls all round: nothing gets in or out
    open_top,  ///< slip walls, the upper side at p* = 0
    duct,      ///< slip walls along z, inflow at the bottom, the top at p* = 0
};

/// A box of water with uniform hexahedra and rock, laminar, with the fluid of [NieuwboerVanRheeKeetels2023] by default.
struct BoxCase {
    Vec3 lower, upper;           ///< corners [m]
    std::array<int, 3> cells{};  ///< number along x, y, z
    BoxSides sides = BoxSides::closed;
    double inflow = 0.0;    ///< along z, of a duct [m/s]
    std::string mesh;       ///< another blockMeshDict than the box's; lower and upper then bound it, its patch rim is what top is
    std::string motion;     ///< constant/dynamicMeshDict; empty: a still mesh
    std::string functions;  ///< function objects of controlDict
    Vec3 gravity{0.0, 0.0, -9.81};
    double density = 998.2;        ///< [kg/m3]
    double viscosity = 1.0034e-6;  ///< kinematic [m2/s]
    double end_time = 0.1;
    double time_step = 1e-3;
    double write_interval = 1e9;                                            ///< [s]
    std::string pressure_solver = "solver GAMG; smoother DICGaussSeidel;";  ///< without its tolerance
    double pressure_tolerance = 1e-9;                                       ///< of the linear solver, without a relative one
    std::vector<BoxRock> rocks;
    std::string convection = "linearUpwindV grad(U)";  ///< scheme of div(phi,U); a study's unless set
    std::string kernel = "gamma 1.0; minWidthInCells 1.5; maxSolidFraction 0.7;";
    std::string closures = "drag brown_lawler; hindrance di_felice; addedMass 0.5;";
    std::string contact =
        std::string("youngsModulus 1e8; poissonRock 0.24; poissonSteel 0.27; wetRestitution true; timeStepFraction 0.1; maxSpeed 1.5; ") +
        k_paper_contact_pairs;
    std::string walls;                   ///< entries of rock.walls; their surfaces must be put into the folder afterwards
    std::string shapes;                  ///< entries of rock.shapes; their files must be put into the folder afterwards
    bool rock_leaves_at_top = false;     ///< the upper side is no wall to rock: it leaves there
    bool rock_leaves_at_bottom = false;  ///< the lower side neither
    std::string extra;                   ///< further sections of couplingProperties

    double cell_size() const { return (upper.x() - lower.x()) / cells[0]; }
    std::size_t cell_count() const { return static_cast<std::size_t>(cells[0]) * cells[1] * cells[2]; }
};

/// Writes `body` under OpenFOAM's head into a file of a case. \param kind  dictionary, volScalarField ...
void write_foam_dictionary(const std::filesystem::path& case_folder, const std::string& name, const std::string& kind,
                           const std::string& body);

/// Writes the case into `folder` (created; must be empty or absent) and makes its mesh with blockMesh.
void write_box_case(const std::filesystem::path& folder, const BoxCase& box);

/// Runs cutterFoam (from the build) on a case; with ranks > 1 it is cut into layers along z first, unless that was done. Throws ToolError
/// with the end of the log when it fails.
void run_cutter_foam(const std::filesystem::path& folder, int ranks = 1);

/// Cuts a case into this many parts along x, y and z.
void decompose(const std::filesystem::path& folder, const std::array<int, 3>& parts);

/// Runs any program in a case folder, its output in log.<program>.
void run_in_case(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

/// Columns of a CSV file with one header line, by name; not-a-number where a field is no number.
std::map<std::string, std::vector<double>> read_columns(const std::filesystem::path& file);

/// Rocks of a snapshot (postProcessing/rock/vtk), in the order of their ids.
struct RockSnapshot {
    double time = 0.0;                     ///< [s]
    std::vector<Vec3> position;            ///< [m]
    std::vector<Vec3> velocity;            ///< [m/s]
    std::vector<Vec3> hydrodynamic_force;  ///< mean over the step [N]
    std::vector<int> id;
    std::vector<double> diameter;  ///< [m]
    std::vector<double> density;   ///< [kg/m3]
};

/// All snapshots that a run wrote, in the order of time, and the last one.
std::vector<RockSnapshot> all_rocks(const std::filesystem::path& folder);
RockSnapshot last_rocks(const std::filesystem::path& folder);

/// Numbers of a table that a function object wrote (postProcessing/<name>/<start>/<file>): rows, first column time; other fields than
/// numbers are left out. Rows of all starts, in order.
std::vector<std::vector<double>> read_function_object(const std::filesystem::path& folder, const std::string& name);

/// Values of an ascii OpenFOAM scalar field, one per cell (a uniform field is spread over `cells` values).
std::vector<double> read_scalar_field(const std::filesystem::path& file, std::size_t cells);

/// The same of a vector field.
std::vector<Vec3> read_vector_field(const std::filesystem::path& file, std::size_t cells);

/// A fresh folder for a test's case under the build folder; what an earlier test run left there is removed.
std::filesystem::path scratch_folder(const std::string& name);

/// Path of the built solver.
std::string cutter_foam();

}  // namespace cutterflow::validation
