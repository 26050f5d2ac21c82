/// \file The study, tables of points and rock, the files of a run directory, checkpoints.
#include "validation/fuzz/run_kinds.hpp"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/runner/manifest.hpp"
#include "cases/runner/prediction.hpp"
#include "cases/scenes/cutter/feed.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "cases/scenes/cutter/velocity_points.hpp"
#include "cases/study/study.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/head/crown_cutter.hpp"
#include "geometry/head/stationary_steel.hpp"
#include "geometry/io/write_stl.hpp"
#include "postproc/analysis/adv_comparison.hpp"
#include "postproc/analysis/comparison.hpp"
#include "postproc/draw/page.hpp"
#include "postproc/pages/adv_trend.hpp"
#include "postproc/pages/report_page.hpp"
#include "postproc/run/adv_points.hpp"
#include "postproc/tests/synthetic_run.hpp"
#include "solver/coupling/checkpoint.hpp"
#include "solver/coupling/feed/rock_feed.hpp"
#include "solver/ports/settings.hpp"
#include "solver/ports/testing/fake_engines.hpp"
#include "validation/fuzz/surface_kinds.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

// ---- the study ----

const std::vector<std::string> k_study_words{"[cutter]",  "[rotor]",
                                             "[suction]", "[run]",
                                             "[[feed]]",  "[[feed.class]]",
                                             "[report]",  "speed_rpm = 0",
                                             "count = 0", "mass_kg = 1",
                                             "true",      "false",
                                             "\"text\"",  "'",
                                             "\"",        "[]",
                                             "{}",        "=",
                                             "[",         "]",
                                             "#",         "inf",
                                             "+",         "1979-05-27"};

constexpr const char* k_long_study = R"(name = "two feeds"
[cutter]
file = "cutter.stl"
unit = "m"
[rotor]
speed_rpm = 60
direction = "right_handed"
[suction]
discharge_m3_s = 0.12
mouth_azimuth_deg = 10
[ladder]
inclination_deg = 30
[swing]
direction = "under_cut"
[fluid]
density_kg_m3 = 998.2
[closures]
drag = "brown_lawler"
hindrance = "di_felice"
[kernel]
gamma = 1.0
[run]
flow_revolutions = 1
max_revolutions = 3
[report]
bin_width_m = 0.03
adv_points = "points.csv"
[[feed]]
count = 20
seed = 3
[[feed.class]]
diameter_m = 0.02
density_kg_m3 = 2650
[[feed]]
mass_kg = 0.5
start_revolution = 1.5
[[feed.class]]
diameter_m = 0.03
density_kg_m3 = 2650
mass_share = 0.7
[[feed.class]]
diameter_m = 0.02
density_kg_m3 = 2400
mass_share = 0.3
)";

constexpr const char* k_points =
    "# measured by hand\nname,r_mm,theta_deg,z_m,frame,u_radial_cm_s,u_tangential_cm_s,u_axial_cm_s\nA,700,0,-0.137,still,12,,5\n"
    "B,500,30,-0.2,rotating,1,2,3\n";
constexpr const char* k_cartesian_points =
    "name,x_m,y_m,z_m,frame,u_radial_m_s,u_tangential_m_s,u_axial_m_s\nA,0.7,0,-0.137,still,0.1,0.2,0.3\nB,0,0.6,-0.1,still,,,\n";

std::string short_study() {
    std::string study = read_file(fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples/model_cutter/study.toml");
    const std::string file = "file = \"../../../runs/model_cutter.stl\"", count = "count = 368";
    study.replace(study.find(file), file.size(), "file = \"cutter.stl\"");
    return study.replace(study.find(count), count.size(), "count = 40");
}

void write_cutter(const fs::path& folder) {
    write_file(folder / "crown_of_the_cutter.toml", coarse_crown_file());
    geometry::write_stl(geometry::generate_crown_cutter(geometry::read_crown_parameters(folder / "crown_of_the_cutter.toml")),
                        folder / "cutter.stl");
    write_file(folder / "points.csv", k_points);
}

/// A process inspects the same cutter once.
const geometry::GeometryInspection& inspection_of(const ParameterValues& values, const fs::path& folder) {
    static std::map<std::string, geometry::GeometryInspection> known;
    const std::string key = values.text("cutter.file") + " " + (values.has("cutter.unit") ? values.text("cutter.unit") : "");
    const auto found = known.find(key);
    return found != known.end() ? found->second : known.emplace(key, cases::import_study_cutter(values, folder)).first->second;
}

/// As cases::feed_scene, but with coarse stationary steel: remeshing it would be nine tenths of an input's time.
cases::FeedScene coarse_scene(const cases::Study& study, const cases::HeadSize& size, const geometry::Contour& contour,
                              const geometry::TriangleSurface& cutter) {
    constexpr double coarser = 8.0;
    geometry::StationarySteelParameters steel = cases::stationary_steel_of(study, size);
    steel.edge_length *= coarser;
    return {contour, cutter, geometry::generate_stationary_steel(steel).solid(), size};
}

/// As `cutterflow check`, but for the machine's speed.
void check_study_file(const fs::path& folder, const std::string& file) {
    const ParameterValues values = cases::read_study(folder / file);
    const geometry::GeometryInspection& inspection = inspection_of(values, folder);
    const cases::HeadSize size = cases::head_size(*inspection.head);
    const ParameterValues resolved = cases::resolve_study(values, size);
    const std::vector<Mistake> mistakes = cases::check_study(resolved, size);
    if (!mistakes.empty()) throw UserError(mistakes);
    const cases::Study study = cases::make_study(resolved, folder);
    to_text(cases::predict(study, size, inspection.head->surface, {1, 1.0}));
    const geometry::Contour contour = cases::head_contour(*inspection.head, study.suction.gap);
    if (study.report.adv_points) cases::require_adv_points(study, size, inspection.head->surface, std::nullopt);
    const auto feeds = cases::place_feeds(study, coarse_scene(study, size, contour, inspection.head->surface));
    cases::study_warnings(resolved, study, size);
    cases::carrying_warnings(study, *inspection.head);
    cases::feed_lines(feeds);
    cases::feed_json(feeds, study);
}

std::vector<FuzzSeed> studies() {
    return {{"study.toml", short_study()}, {"long.toml", k_long_study}};
}

/// The process that starts the others inspects the cutter of the good studies for them.
void prepare_studies(const fs::path& folder) {
    write_cutter(folder);
    for (const FuzzSeed& study : studies()) {
        write_file(folder / study.file, study.content);
        inspection_of(cases::read_study(folder / study.file), folder);
    }
}

// ---- tables ----

constexpr const char* k_feed =
    "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3,vx_m_s,vy_m_s,vz_m_s\n1,0.1,0,0.1,-0.2,0.02,2650,0,0,0\n2,0.1,0.1,0.1,-0.2,0.03,2650,0,"
    "1,0\n";

// ---- run directories ----

constexpr const char* k_other_run = "other";

constexpr const char* k_adv_points =
    "name,r_mm,theta_deg,z_mm,frame,u_radial_cm_s,u_tangential_cm_s,u_axial_cm_s\nA,100,30,-50,still,10,20,30\n";
constexpr const char* k_prediction =
    R"({"cells": 61000, "time_step_s": 0.01, "time_step_with_rock_s": 0.008, "first_release_s": 1, "core_hours": 1.5, "revolutions": 2,
 "core_hours_per_revolution": 0.5, "core_hours_per_revolution_with_rock": 1.0})";

/// Velocities at a point of measurement over two revolutions.
void write_adv_tables(const fs::path& folder) {
    write_file(folder / "points.csv", k_adv_points);
    std::string places =
        "point,x_m,y_m,z_m,rotating,u_radial_m_s,u_tangential_m_s,u_axial_m_s,se_radial_m_s,se_tangential_m_s,se_axial_m_s,samples,"
        "dry_samples,revolutions,from_s,to_s\n";
    std::string revolutions = "revolution,point,u_radial_m_s,u_tangential_m_s,u_axial_m_s,wet_share\n";
    const std::vector<Vec3> sampled = postproc::adv_places(postproc::read_adv_points(folder / "points.csv").front(), {});
    for (std::size_t i = 0; i < sampled.size(); ++i)
        places += fmt::format("{},{},{},{},0,0.1,0.2,0.3,,,,240,0,2,1,2\n", i + 1, sampled[i].x(), sampled[i].y(), sampled[i].z());
    for (int n = 1; n <= 2; ++n)
        for (std::size_t i = 0; i < sampled.size(); ++i) revolutions += fmt::format("{},{},0.1,0.2,{},1\n", n, i + 1, 0.1 * n);
    write_file(folder / "postProcessing/velocity/0/adv.csv", places);
    write_file(folder / "postProcessing/velocity/0/adv_revolutions.csv", revolutions);
}

/// The small run of the tests of postproc, with measurements and a prediction.
void write_run(const fs::path& folder, double speed_rpm) {
    postproc::testing::SmallRun run("fuzz");
    run.directory = folder;
    run.speed_rpm = speed_rpm;
    run.write();
    write_adv_tables(folder);
    write_file(folder / names::prediction, k_prediction);
    const postproc::AdvComparison adv = postproc::compare_with_measurement(folder, folder / "points.csv");
    write_file(folder / names::adv_json, postproc::adv_json(adv).dump(2));
}

void write_runs(const fs::path& folder) {
    write_run(folder, 60.0);
    write_run(folder / k_other_run, 50.0);
}

const std::vector<std::string> k_run_words{"null", "true", "{}",        "[]",   "\"text\"", "\"\"", "[1]", "{\"a\": 1}",
                                           "feed", "gap",  "below_hub", "head", "out",      "nan",  ","};

bool is_table_of_run(const fs::path& file) {
    return file.extension() == ".csv";
}

/// The tables of the small run, or its other files.
std::vector<FuzzSeed> files_of_run(bool tables) {
    const fs::path folder = postproc::testing::fresh_directory("fuzz_seeds");
    write_run(folder, 60.0);
    std::vector<FuzzSeed> seeds;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string end = entry.path().extension().string();
        if (!entry.is_regular_file() || (end != ".csv" && end != ".json" && end != ".toml")) continue;
        if (is_table_of_run(entry.path()) == tables)
            seeds.push_back({fs::relative(entry.path(), folder).string(), read_file(entry.path())});
    }
    std::sort(seeds.begin(), seeds.end(), [](const FuzzSeed& a, const FuzzSeed& b) { return a.file < b.file; });
    return seeds;
}

/// As `cutterflow compare`, with a good run, and `cutterflow report`, both but for their pictures.
void compare_run(const fs::path& folder, const std::string&) {
    const postproc::Comparison comparison = postproc::compare_runs({folder, folder / k_other_run});
    postproc::comparison_json(comparison).dump();
    postproc::comparison_text(comparison);
    const postproc::ComparedRun& run = comparison.runs.front();
    postproc::results_json(run.results, run.run).dump();
    const postproc::Page page(folder / "fuzz.html", postproc::PageForm::still);
    postproc::write_report_page(page, run.results, run.run, {});
    postproc::adv_text(postproc::compare_with_measurement(folder, folder / "points.csv"));
    postproc::adv_trend_json(postproc::read_adv_trends({folder, folder / k_other_run})).dump();
}

constexpr const char* k_manifest =
    R"({"schema": "cutterflow.manifest/1", "stages": {"geometry": {"state": "done", "inputs": {"cutter.file": "ab12", "rotor.speed_rpm": "60"},
 "outputs": {"geometry/cutter.stl": "cd34"}, "wall_s": 1.5, "core_s": 1.25, "finished": "2024-01-01T00:00:00Z"},
 "mesh": {"state": "started", "inputs": {}, "outputs": {}, "wall_s": 0, "core_s": 0, "finished": ""}}, "versions": {"cutterflow": "0.2.0"}}
)";

// ---- checkpoints ----

coupling::ZoneMotion turning() {
    coupling::ZoneMotion motion;
    motion.speed = 6.0;
    return motion;
}

constexpr const char* k_sample_points = "x_m,y_m,z_m,rotating\n0.1,0,-0.1,0\n0,0.1,-0.1,1\n";

coupling::VelocitySets velocity_sets(const fs::path& folder, const coupling::FluidEngine& fluid) {
    coupling::VelocitySettings settings;
    settings.blades = 6;
    settings.sets = {{"adv", folder / "samples.csv", 4}};
    return {settings, fluid};
}

coupling::testing::FakeFluid still_fluid() {
    return {coupling::testing::SyntheticMesh{}, turning(), 0.01};
}

const std::vector<std::int64_t> k_cells{3, 4, 8};

void write_checkpoint(const fs::path& folder) {
    write_file(folder / "samples.csv", k_sample_points);
    coupling::RunState state;
    state.time = 1.25;
    state.feed.placed = {1, 2};
    for (const int id : {1, 2}) {
        coupling::TrackedRock rock;
        rock.id = id;
        rock.diameter = 0.02;
        rock.density = 2650.0;
        if (id == 2) rock.first_exit_time = 1.0;
        state.rocks[id] = rock;
    }
    coupling::write_state(folder, state);
    const std::vector<Vec3> carry{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
    coupling::write_carry(folder, 0, k_cells, carry);
    coupling::testing::FakeFluid fluid = still_fluid();
    coupling::VelocitySets sets = velocity_sets(folder, fluid);
    for (int i = 1; i < 5; ++i) {
        fluid.restart_at(0.3 * i);
        sets.sample_if_due(fluid);
    }
    coupling::write_velocity(folder, sets);
}

std::vector<FuzzSeed> files_of_checkpoint() {
    const fs::path folder = postproc::testing::fresh_directory("fuzz_checkpoint");
    write_checkpoint(folder);
    std::vector<FuzzSeed> seeds;
    for (const char* file : {"state.json", "carry.0", "velocity.sums"}) seeds.push_back({file, read_file(folder / file)});
    return seeds;
}

void read_checkpoint(const fs::path& folder, const std::string&) {
    const coupling::RunState state = coupling::read_state(folder);
    coupling::read_carry(folder, state.ranks, k_cells);
    const coupling::testing::FakeFluid fluid = still_fluid();
    coupling::VelocitySets sets = velocity_sets(folder, fluid);
    coupling::read_velocity(folder, sets);
}

const std::vector<std::string> k_csv_words{",", ";", "#", "name", "still", "rotating", "x_m", "id", "\"", "z_m,r_m"};

}  // namespace

std::vector<FuzzKind> run_kinds() {
    const auto of_file = [](auto reader) { return [reader](const fs::path& folder, const std::string& file) { reader(folder / file); }; };
    return {
        {"study", studies(), k_study_words, prepare_studies, check_study_file, 1.0},
        {"adv_points",
         {{"polar.csv", k_points}, {"cartesian.csv", k_cartesian_points}, {"template.csv", postproc::adv_template()}},
         k_csv_words,
         {},
         of_file([](const fs::path& file) {
             for (const postproc::AdvPoint& point : postproc::read_adv_points(file)) postproc::adv_places(point, {});
             cases::adv_places_hash(file);
         }),
         1.5},
        {"rock_feed",
         {{"rockFeed.csv", k_feed}},
         k_csv_words,
         {},
         of_file([](const fs::path& file) { coupling::read_rock_feed(file); }),
         1.5},
        {"contour",
         {{"contour.csv", "z_m,r_m\n-0.44,0.1\n-0.25,0.32\n-0.1,0.39\n0,0.4\n"}},
         k_csv_words,
         {},
         of_file([](const fs::path& file) {
             coupling::FateSettings fates;
             fates.contour = file;
             fates.ring_radius = 0.4;
             fates.z_backplate = 0.03;
             coupling::read_contour(fates).signed_distance(0.3, -0.2);
         }),
         1.5},
        {"sample_points",
         {{"samples.csv", k_sample_points}},
         k_csv_words,
         {},
         of_file([](const fs::path& file) { coupling::read_sample_points(file); }),
         1.0},
        {"run_tables", files_of_run(true), k_run_words, write_runs, compare_run, 0.5},
        {"run_reports", files_of_run(false), k_run_words, write_runs, compare_run, 0.75},
        {"manifest",
         {{"manifest.json", k_manifest}},
         k_run_words,
         {},
         of_file([](const fs::path& file) { cases::Manifest manifest(file); }),
         1.5},
        {"checkpoint", files_of_checkpoint(), k_run_words, write_checkpoint, read_checkpoint, 2.0},
    };
}

}  // namespace cutterflow::validation
