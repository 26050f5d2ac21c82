/// \file Studies of rooms and of scenes with a free surface, and what goes with them: clumps, calibrations, measures, measured points.
#include "validation/fuzz/scene_kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/calibration/calibration_file.hpp"
#include "cases/runner/room_stages.hpp"
#include "cases/scenes/free_surface/surface_study.hpp"
#include "cases/scenes/room/room_case.hpp"
#include "cases/scenes/room/room_prediction.hpp"
#include "cases/scenes/room/room_study.hpp"
#include "cases/sweep/surface_sweep.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/clump/clump_file.hpp"
#include "geometry/clump/unit_clump.hpp"
#include "postproc/analysis/measures/measure_run.hpp"
#include "postproc/run/measured_points.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

// ---- clumps ----

constexpr const char* k_clump =
    "sphericity = 0.9\n[[sphere]]\nx_m = 0.0\ny_m = 0.0\nz_m = 0.0\nradius_m = 0.010\n\n"
    "[[sphere]]\nx_m = 0.008\ny_m = 0.0\nz_m = 0.002\nradius_m = 0.007\n";

// ---- rooms ----

/// Clumps that are poured, trimmed, fed and taken out, in a hopper that travels; every kind of event and of region.
constexpr const char* k_room = R"(name = "hopper"
[scene]
kind = "room"
[room]
size_m = [0.1, 0.1, 0.2]
tilt_deg = 5
[[boundary]]
on = "bottom"
grains = "open"
[[solid]]
name = "bin"
generate = "hopper"
centre_m = [0, 0, 0.05]
inner_radius_m = 0.04
height_m = 0.1
wall_m = 0.005
orifice_radius_m = 0.016
velocity_m_s = [0, 0, 0.01]
from_s = 1
to_s = 2
[[solid]]
name = "plug"
generate = "box"
lower_m = [-0.03, -0.03, 0.03]
upper_m = [0.03, 0.03, 0.044]
removed_at_s = 0.0
[[material]]
name = "gravel"
youngs_modulus_pa = 5e6
[[contact]]
pair = ["gravel", "gravel"]
friction = 0.5
restitution = 0.8
[[contact]]
pair = ["gravel", "steel"]
friction = 0.4
rolling = 0.01
restitution = 0.8
[[grains]]
name = "grains"
material = "gravel"
density_kg_m3 = 2650
shape = "rock.clump"
[[grains.class]]
diameter_m = 0.006
mass_share = 0.7
[[grains.class]]
diameter_m = 0.005
mass_share = 0.3
[[prepare]]
do = "pour"
grains = "grains"
count = 20
region = { cylinder = { from_m = [0, 0, 0.05], to_m = [0, 0, 0.15], radius_m = 0.04 } }
[[prepare]]
do = "settle"
[[prepare]]
do = "trim"
above_m = 0.1
[[event]]
do = "feed"
grains = "grains"
from_s = 1
to_s = 2
rate_kg_s = 0.002
region = { box = { lower_m = [-0.02, -0.02, 0.1], upper_m = [0.02, 0.02, 0.14] } }
[[event]]
do = "extract"
from_s = 1
to_s = 2
rate_kg_s = 0.001
region = { sphere = { centre_m = [0, 0, 0.05], radius_m = 0.02 } }
[[event]]
do = "freeze"
at_s = 1.5
region = { half_space = { point_m = [0, 0, 0.1], normal = [0, 0, 1] } }
[[measure]]
name = "rate"
what = "rate"
gate = { disc_m = [0, 0, 0.03], radius_m = 0.045, normal = [0, 0, -1] }
[run]
end_s = 4
stop = { measure = "rate", idle_s = 0.5 }
)";

const std::vector<std::string> k_room_words{
    "[[solid]]",     "[[grains]]", "[[prepare]]",    "[[event]]",       "[[measure]]", "[[boundary]]", "[[contact]]", "medium = \"water\"",
    "cell_m = 0.01", "count = 0",  "depth_m = 1e-6", "do = \"settle\"", "1e-9",        "inf",          "[]",          "{}",
    "true",          "\"text\""};

/// As `cutterflow check`, and the files of the cases.
void check_room_file(const fs::path& folder, const std::string& file) {
    const cases::RoomRequest request = cases::read_room_request(folder / file);
    const cases::RoomPrediction prediction = cases::predict(request.scene, request.pieces, request.mesh);
    to_text(prediction);
    to_json(prediction).dump();
    cases::bed_inputs(request.values);
    for (const cases::BedPiece& piece : request.pieces) cases::bed_case(request.scene, piece, "", "");
    cases::grain_files(request.scene, "", 1);
}

// ---- free surface ----

constexpr const char* k_scene = R"(kind = "free_surface"
[domain]
dimensions = "space"
width_m = 0.08
length_m = 0.04
height_m = 0.08
cell_m = 0.004
[[fill]]
from_x_m = 0.0
from_z_m = 0.0
to_x_m = 0.04
to_z_m = 0.04
[[solid]]
kind = "surface"
file = "ramp.stl"
[[solid]]
kind = "gate"
axis_x_m = 0.06
wall_m = 0.01
bottom_m = 0.0
top_m = 0.06
speed_m_s = 0.5
start_s = 0.1
[[bodies]]
shape = "sphere"
diameter_m = 0.02
file = "bodies.csv"
[[gauge]]
name = "middle"
x_m = 0.02
z_m = 0.03
[run]
end_s = 0.3
)";

constexpr const char* k_bodies = "x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,id\n0.02,0.02,0.02,0,0,0.1,1\n";

const std::vector<std::string> k_scene_words{"[[fill]]",
                                             "[[solid]]",
                                             "[[bodies]]",
                                             "[[gauge]]",
                                             "[contact]",
                                             "cell_m = 1e-6",
                                             "layers = 3",
                                             "kind = \"pipe\"",
                                             "kind = \"funnel\"",
                                             "dimensions = \"plane\"",
                                             "1e9",
                                             "[]",
                                             "{}",
                                             "\"text\""};

void write_scene_files(const fs::path& folder) {
    // A wedge in the corner of the tank.
    write_file(folder / "ramp.stl",
               "solid ramp\n"
               "facet normal 0 0 0\nouter loop\nvertex 0.066 0 0\nvertex 0.066 0.04 0\nvertex 0.08 0 0\nendloop\nendfacet\n"
               "facet normal 0 0 0\nouter loop\nvertex 0.066 0.04 0\nvertex 0.08 0.04 0\nvertex 0.08 0 0\nendloop\nendfacet\n"
               "facet normal 0 0 0\nouter loop\nvertex 0.066 0 0\nvertex 0.08 0 0\nvertex 0.08 0 0.014\nendloop\nendfacet\n"
               "facet normal 0 0 0\nouter loop\nvertex 0.066 0.04 0\nvertex 0.08 0.04 0.014\nvertex 0.08 0.04 0\nendloop\nendfacet\n"
               "facet normal 0 0 0\nouter loop\nvertex 0.08 0 0\nvertex 0.08 0.04 0\nvertex 0.08 0.04 0.014\nendloop\nendfacet\n"
               "facet normal 0 0 0\nouter loop\nvertex 0.08 0 0\nvertex 0.08 0.04 0.014\nvertex 0.08 0 0.014\nendloop\nendfacet\n"
               "facet normal 0 0 0\nouter loop\nvertex 0.066 0 0\nvertex 0.08 0 0.014\nvertex 0.08 0.04 0.014\nendloop\nendfacet\n"
               "facet normal 0 0 0\nouter loop\nvertex 0.066 0 0\nvertex 0.08 0.04 0.014\nvertex 0.066 0.04 0\nendloop\nendfacet\n"
               "endsolid ramp\n");
    write_file(folder / "bodies.csv", k_bodies);
    write_file(folder / "of_bodies.toml", k_scene);
}

/// As `cutterflow check`.
void check_scene_file(const fs::path& folder, const std::string& file) {
    const fs::path study = folder / (fs::path(file).extension() == ".csv" ? "of_bodies.toml" : file);
    to_text(cases::check_surface_study(study));
    cases::surface_inputs(study);
}

// ---- calibrations ----

constexpr const char* k_calibration = R"(name = "dam"
study = ["heap.toml", "big.toml"]
method = "surface"
repeats = 2
rounds = 1
[budget]
runs = 200
core_h = 10
[[parameter]]
name = "mu"
key = "contact.friction"
range = [0.1, 0.9]
values = [0.1, 0.5, 0.9]
tolerance = 0.02
[[target]]
study = "heap"
measure = "angle"
value = 22
tolerance = 0.3
[[target]]
name = "profile"
study = "big"
measure = "profile"
profile = "profile.csv"
tolerance = 0.002
held_out = true
)";

const std::vector<std::string> k_calibration_words{"[[parameter]]",
                                                   "[[target]]",
                                                   "[budget]",
                                                   "method = \"grid\"",
                                                   "method = \"bobyqa\"",
                                                   "held_out = true",
                                                   "runs = 0",
                                                   "values = [0.1, 1e9]",
                                                   "[]",
                                                   "{}",
                                                   "\"text\"",
                                                   "inf"};

void write_calibrated_studies(const fs::path& folder) {
    for (const char* study : {"heap", "big"}) write_file(folder / (std::string(study) + ".toml"), cases::surface_study_template(study));
    write_file(folder / "profile.csv", "x_m,height_m\n0,0.01\n0.1,0.02\n");
}

void read_calibration_file(const fs::path& folder, const std::string& file) {
    const cases::StudyAccess access{
        [](const fs::path& study, const std::vector<cases::KeyAxis>& axes, const cases::RepeatRange& repeats, const fs::path&) {
            std::vector<std::string> words;
            for (const cases::KeyAxis& axis : axes) words.push_back(fmt::format("{}={}", axis.key, fmt::join(axis.values, ",")));
            return cases::surface_sweep_points(study, cases::key_axes(cases::surface_study_table(), words, "cutterflow params"), repeats);
        },
        [](const fs::path&) { return std::optional<double>(36.0); },
        [](const fs::path&) {
            return std::vector<cases::StudyMeasure>{{"angle"}, {"profile", true}};
        }};
    cases::read_calibration(folder / file, access);
}

// ---- measures ----

constexpr const char* k_measures_file = R"([{"name": "outlet", "what": "passed_mass", "gate": {"disc_m": [0, 0, 0], "radius_m": 0.1}},
 {"name": "part", "what": "passed_mass", "gate": "outlet", "from_s": 1, "to_s": 2},
 {"name": "flow", "what": "rate", "gate": "outlet", "from_s": 0.5, "to_s": 3.5},
 {"name": "half", "what": "time_of", "gate": "outlet", "share": 0.5},
 {"name": "all", "what": "mass_in", "region": {"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, 1]}}},
 {"name": "share", "what": "packing", "region": {"box": {"lower_m": [0, 0, 0], "upper_m": [0.04, 0.04, 0.02]}}, "at_s": 0.9},
 {"name": "moving", "what": "bed_velocity", "region": {"box": {"lower_m": [0, 0, 0], "upper_m": [0.04, 0.04, 0.02]}}, "cell_m": 0.02},
 {"name": "top", "what": "profile", "base_m": 0.001, "from_m": 0, "to_m": 0.04}]
)";

const std::vector<std::string> k_measure_words{"null", "[]",   "{}",        "\"text\"",     "1e300",     "-1",
                                               "0",    "1e-9", "\"angle\"", "\"spectrum\"", "\"cavity\""};

/// 4 x 4 x 2 grains of 10 mm, of which some leave through a gate.
void write_measured_run(const fs::path& folder) {
    std::string places, diameters, densities, velocities;
    for (int i = 0; i < 32; ++i) {
        places += fmt::format("{:g} {:g} {:g}\n", 0.005 + 0.01 * (i % 4), 0.005 + 0.01 * (i / 4 % 4), 0.005 + 0.01 * (i / 16));
        diameters += "0.01\n";
        densities += "2650\n";
        velocities += fmt::format("{:g} 0 0\n", 0.1 * (i % 3));
    }
    const auto array = [](const char* name, const std::string& values) {
        return fmt::format("<DataArray type=\"Float64\" Name=\"{}\" format=\"ascii\">\n{}</DataArray>\n", name, values);
    };
    for (const char* time : {"0.5", "1", "2"})
        write_file(folder / fmt::format("postProcessing/rock/vtk/rocks_{}.vtp", time),
                   "<VTKFile>\n" + array("Points", places) + array("diameter", diameters) + array("density", densities) +
                       array("velocity", velocities) + "</VTKFile>\n");
    std::string gates = "time_s,gate,id,direction,mass_kg\n";
    for (int n = 1; n <= 40; ++n) gates += fmt::format("{:.2f},outlet,{},1,0.5\n", 0.1 * n, n);
    write_file(folder / "postProcessing/rock/0/gates.csv", gates);
    write_file(folder / "postProcessing/cost/0/cost.csv", "time_s\n5\n");
}

}  // namespace

std::vector<FuzzKind> scene_kinds() {
    const std::vector<std::string> clump_words{"[[sphere]]", "sphericity = 2", "radius_m = 0", "1e300", "1e-300", "[]", "{}"};
    const std::vector<std::string> csv_words{",", ";", "#", "spillage", "production_error", "speed_rpm", "\"", "1e300", "-1"};
    return {
        {"room",
         {{"heap.toml", cases::room_template("heap")}, {"hopper.toml", k_room}},
         k_room_words,
         [](const fs::path& folder) { write_file(folder / "rock.clump", k_clump); },
         check_room_file,
         0.5},
        {"scene",
         {{"dam.toml", cases::surface_study_template("dam")}, {"space.toml", k_scene}, {"bodies.csv", k_bodies}},
         k_scene_words,
         write_scene_files,
         check_scene_file,
         0.5},
        {"clump",
         {{"rock.clump", k_clump}},
         clump_words,
         {},
         [](const fs::path& folder, const std::string& file) { geometry::unit_clump(geometry::read_clump(folder / file)).reach(); },
         1.0},
        {"calibration", {{"calibration.toml", k_calibration}}, k_calibration_words, write_calibrated_studies, read_calibration_file, 0.5},
        {"measures",
         {{postproc::k_measures, k_measures_file}},
         k_measure_words,
         write_measured_run,
         [](const fs::path& folder, const std::string&) { postproc::measures_text(postproc::measure_run(folder)); },
         1.0},
        {"measured",
         {{"measured.csv", postproc::measured_template() + "60,0.12,0.2,0.05,0.8,0.05\n30,0.12,0.1,0.02,0.9,0.02\n"}},
         csv_words,
         {},
         [](const fs::path& folder, const std::string& file) { postproc::read_measured_points(folder / file); },
         1.0},
    };
}

}  // namespace cutterflow::validation
