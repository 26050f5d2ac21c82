#include "meshing/room/build_room_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "meshing/dictionary/mesher_sections.hpp"
#include "meshing/room/room_mesh_dictionaries.hpp"

namespace cutterflow::meshing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* k_mesh_folder = "mesh";  // of the run directory
constexpr double k_most_non_orthogonal = 75.0, k_most_skew = 4.0;
// Cells that follow a surface err by 0.1 % of the medium at most (measured in rooms with pipes); a thin solid may lose a third of itself.
// Beside thick solids, which fill most of a room, a third of them would be more than all of the medium.
constexpr double k_volume_error = 0.01, k_solid_volume_error = 0.3, k_largest_volume_error = 0.05;

std::vector<std::string> names_of_solids(const RoomMeshPlan& plan) {
    std::vector<std::string> names;
    for (const RoomMeshSolid& solid : plan.input.solids) names.push_back(solid.name);
    return names;
}

std::vector<std::pair<const char*, FoamDictionary>> dictionaries_of(const RoomMeshPlan& plan) {
    std::vector<std::pair<const char*, FoamDictionary>> all{{"controlDict", mesh_control()},
                                                            {"fvSchemes", mesh_schemes()},
                                                            {"fvSolution", FoamDictionary()},
                                                            {"blockMeshDict", room_background(plan)}};
    if (!plan.input.solids.empty()) all.emplace_back("surfaceFeatureExtractDict", feature_extraction(names_of_solids(plan)));
    if (plan.is_cut()) all.emplace_back("snappyHexMeshDict", room_cut(plan));
    if (!plan.input.patches.empty()) {
        all.emplace_back("topoSetDict", room_selection(plan));
        all.emplace_back("createPatchDict", room_patches(plan));
    }
    return all;
}

std::vector<FoamStep> steps_of(const RoomMeshPlan& plan) {
    std::vector<FoamStep> steps{{"blockMesh", {}, 1.0}};
    if (!plan.input.solids.empty()) steps.push_back({"surfaceFeatureExtract", {}, 1.0});
    if (plan.is_cut()) steps.push_back({"snappyHexMesh", {"-overwrite"}, 40.0});
    if (!plan.input.patches.empty()) {
        steps.push_back({"topoSet", {}, 1.0});
        steps.push_back({"createPatch", {"-overwrite"}, 2.0});
    }
    steps.push_back({"checkMesh", {}, 3.0});
    return steps;
}

std::vector<std::string> missing_patches(const RoomMeshPlan& plan, const CheckMeshSize& size) {
    std::vector<std::string> names = names_of_solids(plan), missing;
    for (const RoomMeshPatch& patch : plan.input.patches) names.push_back(patch.name);
    std::copy_if(names.begin(), names.end(), std::back_inserter(missing), [&](const std::string& name) { return !size.has_patch(name); });
    return missing;
}

}  // namespace

std::vector<MeshGate> check_room_mesh(const RoomMeshPlan& plan, const CheckMeshFigures& quality, const CheckMeshSize& size) {
    const std::vector<std::string> missing = missing_patches(plan, size);
    const std::string finer = "Take smaller cells near the solids ([[room.refine]])";
    return {
        {"failed checks of checkMesh", static_cast<double>(quality.failed_checks), 0.0, false,
         "Open the sets that checkMesh wrote in mesh/, and take smaller cells there"},
        {"non-orthogonality, deg", quality.non_orthogonality_max, k_most_non_orthogonal, false, finer},
        {"skewness", quality.skewness_max, k_most_skew, false, finer},
        {"number of parts that no face connects", static_cast<double>(size.regions), 1.0, false,
         "Take smaller cells where the medium is narrow, or fill the part by a solid"},
        {"missing patches", static_cast<double>(missing.size()), 0.0, false,
         fmt::format("No face belongs to {}: take smaller cells there, or do not cover it by a later boundary", fmt::join(missing, ", "))},
        {"relative error of the medium's volume", std::abs(size.volume / plan.medium_volume - 1.0),
         std::min(k_volume_error + k_solid_volume_error * plan.solid_volume / plan.medium_volume, k_largest_volume_error), false,
         "Check that no part of the room is closed off, and that solids do not overlap; or take smaller cells near them"},
    };
}

json to_json(const RoomMeshReport& report) {
    json programs = json::object();
    for (const auto& [program, core_s] : report.program_core_s) programs[program] = core_s;
    return {{"cells", report.size.cells},
            {"volume_m3", report.size.volume},
            {"cell_size_min_m", std::cbrt(report.size.volume_min)},
            {"non_orthogonality_max_deg", report.quality.non_orthogonality_max},
            {"non_orthogonality_mean_deg", report.quality.non_orthogonality_mean},
            {"skewness_max", report.quality.skewness_max},
            {"aspect_ratio_max", report.quality.aspect_ratio_max},
            {"patches", report.size.patches},
            {"predicted_cells", std::round(report.predicted_cells)},
            {"gates", gates_json(report.gates)},
            {"program_core_s", programs},
            {"wall_s", report.wall_s},
            {"core_s", report.core_s}};
}

std::vector<fs::path> write_room_mesh_case(const fs::path& run_directory, const RoomMeshPlan& plan) {
    std::vector<fs::path> written;
    for (const auto& [name, dictionary] : dictionaries_of(plan)) {
        written.push_back(fs::path(k_mesh_folder) / "system" / name);
        write_foam_file(run_directory / written.back(), "dictionary", dictionary);
    }
    for (const std::string& name : names_of_solids(plan)) {
        written.push_back(fs::path(k_mesh_folder) / "constant/triSurface" / (name + ".stl"));
        fs::create_directories((run_directory / written.back()).parent_path());
        fs::copy_file(run_directory / "geometry" / (name + ".stl"), run_directory / written.back(), fs::copy_options::overwrite_existing);
    }
    return written;
}

RoomMeshReport build_room_mesh(const fs::path& run_directory, const RoomMeshPlan& plan, const MeshObserver& observer) {
    const fs::path mesh_case = run_directory / k_mesh_folder;
    const std::vector<FoamStep> steps = steps_of(plan);
    double weight = 0.0;
    for (const FoamStep& step : steps) weight += step.weight;
    FoamSteps programs(mesh_case, weight, observer);
    for (const FoamStep& step : steps) programs.run(step);

    const fs::path log = mesh_case / "log.checkMesh";
    RoomMeshReport report;
    report.quality = parse_check_mesh(read_file(log), log.string());
    report.size = parse_check_mesh_size(read_file(log), log.string());
    report.predicted_cells = plan.predicted_cells;
    report.gates = check_room_mesh(plan, report.quality, report.size);
    report.program_core_s = programs.program_core_s;
    report.wall_s = programs.wall_s;
    report.core_s = programs.core_s;
    move_mesh(mesh_case, run_directory);
    write_file(run_directory / names::mesh_report, to_json(report).dump(2) + "\n");
    return report;
}

}  // namespace cutterflow::meshing
