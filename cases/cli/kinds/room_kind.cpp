/// \file Studies of a room.
#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/cli/kinds/stage_lines.hpp"
#include "cases/cli/kinds/study_kind.hpp"
#include "cases/runner/disk_space.hpp"
#include "cases/runner/machine.hpp"
#include "cases/runner/room_stages.hpp"
#include "cases/scenes/room/room_prediction.hpp"
#include "cases/scenes/room/room_study.hpp"
#include "cases/sweep/room_sweep.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/process/shell_word.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/versions.hpp"
#include "postproc/analysis/measures/measure_run.hpp"
#include "postproc/pages/room/room_page.hpp"

namespace cutterflow::cli {
namespace {

namespace fs = std::filesystem;

std::string new_study(const NewOptions& options) {
    if (!options.cutter.empty() || options.unit)
        throw UserError("--cutter and --unit with --kind room", "Such a study has no cutter", "Leave them out");
    return cases::room_template(fs::path(options.study).stem().string());
}

cases::RoomPrediction prediction_of(const cases::RoomRequest& request) {
    return cases::predict(request.scene, request.pieces, request.mesh);
}

/// As one gives it again; nothing for one rank.
std::string ranks_option(int ranks) {
    return ranks == 1 ? std::string() : fmt::format(" --ranks {}", ranks);
}

Mistake no_measure(const std::string& study) {
    return {study, "it has no [[measure]]", "Runs of rooms are compared by their measures", "Write one into the study"};
}

std::vector<Mistake> warnings_of(const cases::RoomRequest& request, const std::string& study) {
    std::vector<Mistake> warnings = cases::room_warnings(request.values, request.scene, request.pieces, request.mesh);
    if (request.scene.measures.empty()) warnings.push_back(no_measure(study));
    return warnings;
}

/// \param mistakes  those found so far, told with the study's
cases::RoomRequest read_request(const std::string& study, int ranks, Mistakes& mistakes) {
    cases::RoomRequest request;
    mistakes.gather([&] {
        request = cases::read_room_request(study);
        cases::require_mesh_for_ranks(request, ranks);
    });
    mistakes.refuse();
    return request;
}

void check(const CheckOptions& options) {
    Mistakes mistakes;
    mistakes.gather([&] { cases::require_machine(options.ranks); });
    const cases::RoomRequest request = read_request(options.study, options.ranks, mistakes);
    const cases::RoomPrediction prediction = prediction_of(request);
    const std::vector<Mistake> warnings = warnings_of(request, options.study);
    if (options.json) {
        nlohmann::json found = to_json(prediction);
        found["warnings"] = mistakes_json(warnings);
        std::cout << found.dump(2) << std::endl;
        return;
    }
    std::cout << to_text(prediction);
    for (const Mistake& warning : warnings) std::cout << "warning: " << warning.text() << "\n";
    std::cout << fmt::format("{} is valid; next: cutterflow run {}{}\n", options.study, shell_word(options.study),
                             ranks_option(options.ranks));
}

std::optional<double> predicted_core_s(const fs::path& study) {
    return prediction_of(cases::read_room_request(study.string())).core_seconds();
}

cases::RoomRequest begun_well(const RunOptions& options) {
    Mistakes mistakes;
    if (!options.start_from.empty()) mistakes.gather([&] { cases::require_start_donor(options.start_from); });
    mistakes.gather([&] { cases::require_usable_run_directory(options.folder()); });
    mistakes.gather([&] { cases::require_machine(options.ranks); });
    cases::RoomRequest request = read_request(options.study, options.ranks, mistakes);
    std::vector<std::string> programs{(installation().programs / "cutterFoam").string()};
    if (request.mesh)
        for (const char* program : {"blockMesh", "surfaceFeatureExtract", "snappyHexMesh", "topoSet", "createPatch", "checkMesh"})
            programs.emplace_back(program);
    if (options.ranks > 1) programs.insert(programs.end(), {"mpirun", "decomposePar", "reconstructPar"});
    require_programs(programs);
    for (const Mistake& warning : warnings_of(request, options.study)) say("warning: " + warning.text());
    return request;
}

/// \return the run directory's path
fs::path go_through(const cases::RoomRequest& request, const RunOptions& options, const std::string& until) {
    const cases::RunDirectory directory(options.folder());
    const std::vector<cases::Stage> stages =
        cases::room_stages(directory, request, installation().programs / "cutterFoam", options.ranks, say);
    if (!options.start_from.empty() && !fs::exists(directory.file(names::manifest))) {
        const std::string apart = cases::take_bed(options.start_from, directory, stages);
        say(apart.empty() ? fmt::format("the bed is that of {}, copied from there", options.start_from)
                          : fmt::format("the bed of {} is not taken, {}: it is made here", options.start_from, apart));
    }
    cases::Manifest manifest(directory.file(names::manifest));
    manifest.set_kind("room");
    const auto versions = build_versions();
    manifest.set_versions({versions.begin(), versions.end()});
    const auto last = std::find_if(stages.begin(), stages.end(), [&](const cases::Stage& stage) { return stage.name == until; });
    try {
        cases::run_stages(directory, manifest, stages, until, options.resume,
                          stage_lines(static_cast<std::size_t>(last - stages.begin()) + 1));
    } catch (const Interrupted& interrupted) {
        throw Interrupted(fmt::format("{}. Finished work is kept in {}; resume with: cutterflow run {} -o {}{} --resume",
                                      interrupted.what(), directory.path().string(), shell_word(options.study),
                                      shell_word(options.folder().string()), ranks_option(options.ranks)));
    } catch (const std::exception&) {
        cases::refuse_full_disk(directory.path());
        throw;
    }
    return directory.path();
}

void prepare(const RunOptions& options) {
    const cases::RoomRequest request = begun_well(options);
    const fs::path folder = go_through(request, options, request.mesh ? "mesh" : "bed");
    std::cout << fmt::format("the bed: {}\n", (folder / "bed").string());
    if (request.mesh) std::cout << fmt::format("the mesh: {}\n", (folder / "constant/polyMesh").string());
    std::cout << std::flush;
}

/// results.json, or warnings, the measures and where the report is. \pre the report is written
void say_results(const fs::path& folder, bool json) {
    const std::string measures = postproc::has_measures(folder) ? postproc::measures_text(postproc::read_measures(folder)) : "";
    say_report(folder / names::results_json, folder / names::report_page, json, measures);
}

void run(const RunOptions& options) {
    say_results(go_through(begun_well(options), options, "report"), options.json);
}

void report(const ReportOptions& options) {
    if (options.adv_points || options.still_folder)
        throw UserError(fmt::format("{} with a room", options.adv_points ? "--adv" : "--static"), "It belongs to cutters", "Leave it out");
    postproc::write_room_report(options.folder);
    if (const std::string warning = postproc::unfinished_room(options.folder); !warning.empty()) say("warning: " + warning);
    say_results(options.folder, options.json);
}

std::vector<cases::SweepPoint> points(const SweepOptions& options, const fs::path&) {
    Mistakes mistakes;
    for (const auto& [given, option] : {std::pair(!options.axes.speeds.empty(), "--rpm"),
                                        {!options.axes.discharges.empty(), "--discharge"},
                                        {!options.axes.designs.empty(), "--design"}})
        mistakes.require(!given, fmt::format("{} in a sweep of a room", option), "It belongs to cutters",
                         "Use --set KEY=a,b and --repeats");
    mistakes.refuse();
    const std::vector<cases::KeyAxis> axes = cases::key_axes(cases::room_table(), options.set, k_room_kind.params);
    const ParameterValues values = cases::read_placed_room(options.study);
    std::vector<cases::SweepPoint> points = cases::room_sweep_points(options.study, values, axes, options.axes.repeats, options.ranks);
    if (points.size() > 1 && values.tables("measure").empty()) say("warning: " + no_measure(options.study).text());
    return points;
}

fs::path write_comparison(const std::vector<fs::path>& runs, const fs::path& folder) {
    return postproc::write_room_comparison(postproc::compare_room_runs(runs), folder);
}

void compare(const CompareOptions& options) {
    Mistakes mistakes;
    mistakes.require(options.measured.empty(), "--measured with runs of rooms", "Measured points are spillage and production of cutters",
                     "Leave it out");
    mistakes.require(!options.still_folder, "--static with runs of rooms", "Their page has no script to leave out", "Use --output");
    std::vector<postproc::SettingResults> settings;
    mistakes.gather([&] { settings = postproc::compare_room_runs({options.runs.begin(), options.runs.end()}); });
    mistakes.refuse();
    std::cout << (options.json ? postproc::room_comparison_json(settings).dump(2) + "\n" : postproc::setting_comparison_text(settings));
    if (options.output) say(fmt::format("the page: {}", postproc::write_room_comparison(settings, *options.output).string()));
}

}  // namespace

const StudyKind k_room_kind{"room",
                            "a box with solids and grains",
                            "cutterflow params --kind room",
                            cases::room_table,
                            new_study,
                            check,
                            predicted_core_s,
                            prepare,
                            run,
                            postproc::is_room_run,
                            report,
                            points,
                            false,
                            write_comparison,
                            compare};

}  // namespace cutterflow::cli
