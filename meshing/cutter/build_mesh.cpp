#include "meshing/cutter/build_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "meshing/cutter/background_mesh.hpp"
#include "meshing/cutter/mesh_dictionaries.hpp"
#include "meshing/dictionary/mesher_sections.hpp"

namespace cutterflow::meshing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* k_restore_report = "interface_restore.json";
constexpr const char* k_probe_report = "mesh_probe.json";
constexpr int k_angles_per_pitch = 8;
constexpr double k_least_cells_to_share = 2e5;
constexpr std::array<double, 3> k_attempts = {1.0, 0.93, 0.85};  // cells over those of the preset

std::string foam_list(const std::vector<double>& numbers) {
    return fmt::format("({})", fmt::join(numbers, " "));
}

/// Copies the mesh of blockMesh, which cutterInterfaceRestore needs.
void keep_background(const fs::path& mesh_case) {
    fs::remove_all(mesh_case / "constant" / "background");
    fs::create_directories(mesh_case / "constant" / "background");
    fs::copy(mesh_case / "constant" / "polyMesh", mesh_case / "constant" / "background" / "polyMesh", fs::copy_options::recursive);
}

/// On several ranks the mesh is reconstructed afterwards.
std::vector<FoamStep> steel_cutting(int ranks) {
    const FoamStep cut = {"snappyHexMesh", {"-overwrite"}, 80.0, ranks};
    if (ranks == 1) return {cut};
    return {{"decomposePar", {"-force"}, 1.0}, cut, {"reconstructParMesh", {"-constant"}, 2.0}};
}

void remove_processors(const fs::path& mesh_case) {
    for (int rank = 0; fs::remove_all(mesh_case / fmt::format("processor{}", rank)) > 0; ++rank) {
    }
}

}  // namespace

int ranks_that_pay(const MeshPlan& plan, int ranks) {
    return plan.prediction.cells < k_least_cells_to_share ? 1 : ranks;
}

std::vector<double> probe_angles(const RotorZone& rotor) {
    std::vector<double> angles;
    for (int i = 0; i < k_angles_per_pitch; ++i) angles.push_back(rotor.facet_angle() * i / k_angles_per_pitch);
    for (int i = 1; i < k_angles_per_pitch; ++i) angles.push_back(2.0 * k_pi * i / k_angles_per_pitch + angles[i]);
    return angles;
}

std::optional<MeshRetry> next_attempt(const MeshReport& failed, int attempts, MeshInput& input) {
    const MeshGate* gate = failed.first_failed_gate();
    if (!gate || attempts >= static_cast<int>(k_attempts.size())) return {};
    const double share = k_attempts[static_cast<std::size_t>(attempts)];
    input.resolution.cell_size *= share / k_attempts[static_cast<std::size_t>(attempts) - 1];
    return MeshRetry{gate->name, fmt::format("cells {:g} times as wide as the preset's", share)};
}

std::vector<fs::path> write_mesh_case(const fs::path& run_directory, const MeshPlan& plan, int ranks) {
    std::vector<std::pair<const char*, FoamDictionary>> dictionaries = {
        {"controlDict", mesh_control()},
        {"fvSchemes", mesh_schemes()},
        {"fvSolution", FoamDictionary()},
        {"blockMeshDict", background_mesh(plan)},
        {"surfaceFeatureExtractDict", feature_extraction({steel_surfaces().begin(), steel_surfaces().end()})},
        {"snappyHexMeshDict", steel_cut(plan)},
        {"topoSetDict", outlet_selection(plan)},
        {"createPatchDict", final_patches()}};
    if (ranks > 1) dictionaries.emplace_back("decomposeParDict", decomposition(ranks));
    std::vector<fs::path> written;
    for (const auto& [name, dictionary] : dictionaries) {
        written.push_back(fs::path(k_mesh_case) / "system" / name);
        write_foam_file(run_directory / written.back(), "dictionary", dictionary);
    }
    for (const std::string& name : steel_surfaces()) {
        const std::string file = name + ".stl";
        written.push_back(fs::path(k_mesh_case) / "constant" / "triSurface" / file);
        fs::create_directories((run_directory / written.back()).parent_path());
        fs::copy_file(run_directory / "geometry" / file, run_directory / written.back(), fs::copy_options::overwrite_existing);
    }
    return written;
}

MeshReport build_mesh(const fs::path& run_directory, const MeshPlan& plan, const fs::path& programs, int ranks,
                      const MeshObserver& observer, const std::vector<MeshRetry>& retries) {
    const fs::path mesh_case = run_directory / k_mesh_case;
    const fs::path own = fs::absolute(programs);  // the programs start in the mesh's folder
    const std::string sides = fmt::format("({} {})", k_rotor_side_patch, k_stator_side_patch);
    std::vector<FoamStep> steps = {{"surfaceFeatureExtract", {}, 1.0}};
    for (const FoamStep& step : steel_cutting(ranks)) steps.push_back(step);
    const std::vector<FoamStep> finish = {
        {own / "cutterInterfaceRestore", {"-patches", sides, "-output", k_restore_report}, 2.0},
        {"topoSet", {}, 1.0},
        {"createPatch", {"-overwrite"}, 2.0},
        {"checkMesh", {}, 3.0},
        {own / "cutterMeshProbe", {"-angles", foam_list(probe_angles(plan.rotor)), "-output", k_probe_report}, 10.0},
    };
    FoamSteps runner(mesh_case, 100.0, observer);
    runner.run({"blockMesh", {}, 1.0});
    keep_background(mesh_case);
    for (const FoamStep& step : steps) runner.run(step);
    remove_processors(mesh_case);
    for (const FoamStep& step : finish) runner.run(step);

    MeshReport report;
    report.preset = plan.input.resolution.preset;
    report.prediction = plan.prediction;
    report.quality = parse_check_mesh(read_file(mesh_case / "log.checkMesh"), (mesh_case / "log.checkMesh").string());
    report.figures = parse_probe(json::parse(read_file(mesh_case / k_probe_report)), json::parse(read_file(mesh_case / k_restore_report)));
    report.gates = check_mesh_gates(plan, report.quality, report.figures);
    report.wall_s = runner.wall_s;
    report.core_s = runner.core_s;
    report.memory = runner.memory;
    report.program_core_s = runner.program_core_s;
    report.retries = retries;
    move_mesh(mesh_case, run_directory);
    fs::remove_all(mesh_case / "constant" / "background");
    write_file(run_directory / names::mesh_report, to_json(report).dump(2) + "\n");
    return report;
}

}  // namespace cutterflow::meshing
