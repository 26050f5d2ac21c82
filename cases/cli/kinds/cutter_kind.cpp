/// \file Studies of a cutter.
#include <algorithm>
#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/cli/kinds/stage_lines.hpp"
#include "cases/cli/kinds/study_kind.hpp"
#include "cases/cli/new_file.hpp"
#include "cases/runner/disk_space.hpp"
#include "cases/runner/machine.hpp"
#include "cases/runner/pipeline.hpp"
#include "cases/runner/prediction.hpp"
#include "cases/scenes/cutter/checked_study.hpp"
#include "cases/scenes/cutter/feed.hpp"
#include "cases/scenes/cutter/study_bank.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "cases/study/study.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/process/shell_word.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/versions.hpp"
#include "geometry/io/length_unit.hpp"
#include "postproc/pages/adv_page.hpp"
#include "postproc/pages/comparison_page.hpp"
#include "postproc/pages/report.hpp"

namespace cutterflow::cli {
namespace {

namespace fs = std::filesystem;

std::string new_study(const NewOptions& options) {
    if (!options.cutter.empty() && !fs::exists(options.cutter))
        throw UserError(fmt::format("--cutter {} does not exist", options.cutter), "The study names a surface of a cutter",
                        "Check the path");
    if (options.unit) geometry::length_unit_of(*options.unit);  // refuses what is none
    // The study refers to the cutter from its own folder.
    const fs::path folder = fs::absolute(options.study).parent_path();
    const fs::path cutter = options.cutter.empty() ? fs::path("cutter.stl") : fs::absolute(options.cutter).lexically_relative(folder);
    return cases::study_template(fs::path(options.study).stem().string(), cutter.string(), options.unit);
}

void check(const CheckOptions& options) {
    Mistakes mistakes;
    std::optional<cases::CheckedStudy> checked;
    mistakes.gather([&] { cases::require_machine(options.ranks); });
    mistakes.gather([&] { checked = cases::read_checked_study(options.study); });
    mistakes.refuse();
    const auto& [resolved, inspection, placed] = *checked;
    const auto& [study, size, contour, feeds] = placed;
    const cases::Prediction prediction = cases::predict(study, size, inspection.head->surface, {options.ranks, cases::machine_slowness()});
    std::vector<Mistake> warnings = cases::head_warnings(resolved, placed, *inspection.head);
    for (const Mistake& warning : cases::prediction_warnings(study, prediction)) warnings.push_back(warning);
    for (const Mistake& warning : meshing::mesh_warnings(cases::mesh_input_of(study, size, inspection.head->surface)))
        warnings.push_back(warning);
    const fs::path run = fs::path("runs") / fs::path(options.study).stem();  // where it goes without -o
    if (const auto missing = cases::missing_space(run, prediction.mesh_disk + prediction.run_disk)) warnings.push_back(*missing);
    if (options.json) {
        std::cout << nlohmann::json{{"cutter", geometry::to_json(inspection)},
                                    {"bank", cases::bank_json(study, contour)},
                                    {"prediction", to_json(prediction)},
                                    {"feeds", nlohmann::json::parse(cases::feed_json(feeds, study)).at("feeds")},
                                    {"warnings", mistakes_json(warnings)}}
                         .dump(2)
                  << std::endl;
        return;
    }
    std::cout << geometry::to_text(inspection) << cases::bank_text(study, contour) << "\n" << to_text(prediction);
    for (const std::string& line : cases::feed_lines(feeds)) std::cout << line << "\n";
    for (const Mistake& warning : warnings) std::cout << "warning: " << warning.text() << "\n";
    std::cout << fmt::format("{} is valid; next: cutterflow run {} --ranks {}\n", options.study, shell_word(options.study), options.ranks);
}

std::optional<double> predicted_core_s(const fs::path&) {
    return std::nullopt;
}

fs::path solver_path() {
    return installation().programs / "cutterFoam";
}

std::vector<std::string> programs_for(const RunOptions& options, const std::string& until) {
    const fs::path own = solver_path().parent_path();
    std::vector<std::string> programs{"blockMesh",
                                      "surfaceFeatureExtract",
                                      "snappyHexMesh",
                                      "topoSet",
                                      "createPatch",
                                      "checkMesh",
                                      (own / "cutterInterfaceRestore").string(),
                                      (own / "cutterMeshProbe").string()};
    if (options.ranks > 1) programs.insert(programs.end(), {"mpirun", "decomposePar", "reconstructParMesh"});
    if (until == "mesh") return programs;
    programs.insert(programs.end(), {"simpleFoam", solver_path().string()});
    if (options.ranks > 1) programs.emplace_back("reconstructPar");
    return programs;
}

void go_through_stages(const RunOptions& options, const cases::RunDirectory& directory, const std::string& until, std::size_t count) {
    cases::Manifest manifest(directory.file(names::manifest));
    manifest.set_kind("cutter");
    const auto versions = build_versions();
    manifest.set_versions({versions.begin(), versions.end()});
    cases::Pipeline pipeline(directory, {fs::absolute(options.study), options.ranks, solver_path(), options.start_from}, say);
    try {
        cases::run_stages(directory, manifest, pipeline.stages(), until, options.resume, stage_lines(count));
    } catch (const Interrupted& interrupted) {
        throw Interrupted(fmt::format("{}. Finished work is kept in {}; resume with: cutterflow {} {} -o {} --ranks {}{}",
                                      interrupted.what(), directory.path().string(), until == "mesh" ? "mesh" : "run",
                                      shell_word(options.study), shell_word(options.folder().string()), options.ranks,
                                      until == "mesh" ? "" : " --resume"));
    } catch (const std::exception&) {
        // Whatever failed first on a full disk, what to do is the same.
        if (const std::optional<Mistake> full = pipeline.full_disk()) throw ToolError(*full);
        throw;
    }
}

/// Refuses what can be refused before the run directory is made.
void require_begun_well(const RunOptions& options, const std::string& until) {
    Mistakes mistakes;
    mistakes.gather([&] { cases::require_usable_run_directory(options.folder()); });
    mistakes.gather([&] { cases::require_machine(options.ranks); });
    if (!options.start_from.empty()) mistakes.gather([&] { cases::require_start_donor(options.start_from); });
    mistakes.gather([&] { cases::require_study_file(options.study); });
    mistakes.refuse();
    require_programs(programs_for(options, until));
}

void mesh(const RunOptions& options) {
    require_begun_well(options, "mesh");
    const cases::RunDirectory directory(options.folder());
    go_through_stages(options, directory, "mesh", 2);
    const std::string report = read_file(directory.file(names::mesh_report));
    std::cout << (options.json ? report : fmt::format("the mesh: {}\n", directory.path().string())) << std::flush;
}

void run(const RunOptions& options) {
    require_begun_well(options, "report");
    const cases::RunDirectory directory(options.folder());
    go_through_stages(options, directory, "report", 6);
    say_where_the_report_is(options, directory);
}

bool is_run(const fs::path&) {
    return false;  // what is no other kind's run is taken for a cutter's, whose reader tells what is wrong
}

void adv_report(const ReportOptions& options) {
    const postproc::AdvComparison comparison = postproc::compare_with_measurement(options.folder, *options.adv_points, options.revolutions);
    const fs::path page = postproc::write_adv_report(comparison, options.folder);
    std::cout << (options.json ? read_file(fs::path(options.folder) / names::adv_json)
                               : fmt::format("{}the page: {}\n", postproc::adv_text(comparison), page.string()))
              << std::flush;
}

void report(const ReportOptions& options) {
    if (options.adv_points) return adv_report(options);
    const postproc::ReportSummary summary =
        options.still_folder ? postproc::publish_report(options.folder, *options.still_folder) : postproc::write_report(options.folder);
    if (!summary.note.empty()) say(summary.note);
    say_report(summary.results_file, summary.page_file, options.json);
}

std::vector<cases::SweepPoint> points(const SweepOptions& options, const fs::path& folder) {
    cases::SweepAxes axes = options.axes;
    std::vector<cases::SweepPoint> points;
    Mistakes mistakes;
    mistakes.gather([&] { axes.keys = cases::key_axes(cases::study_table(), options.set, k_cutter_kind.params); });
    mistakes.gather([&] { points = cases::sweep_points(options.study, axes, folder); });
    mistakes.refuse();
    return points;
}

fs::path write_comparison(const std::vector<fs::path>& runs, const fs::path& folder) {
    return postproc::write_comparison(postproc::compare_runs(runs), folder);
}

void compare(const CompareOptions& options) {
    Mistakes mistakes;
    postproc::Comparison comparison;
    const bool compared = mistakes.gather([&] { comparison = postproc::compare_runs({options.runs.begin(), options.runs.end()}); });
    mistakes.gather([&] { postproc::add_measured(comparison, {options.measured.begin(), options.measured.end()}); });
    if (options.output && options.still_folder)
        mistakes.gather([&] { require_different_places("--output", *options.output, "--static", *options.still_folder); });
    for (const auto& folder : {options.output, options.still_folder})
        if (folder && compared) mistakes.gather([&] { postproc::require_own_comparison(comparison, *folder); });
    mistakes.refuse();
    std::cout << (options.json ? postproc::comparison_json(comparison).dump(2) + "\n" : postproc::comparison_text(comparison));
    if (options.output) say(fmt::format("the page: {}", postproc::write_comparison(comparison, *options.output).string()));
    if (options.still_folder)
        say(fmt::format("the page without scripts: {}",
                        postproc::write_comparison(comparison, *options.still_folder, postproc::PageForm::still).string()));
}

}  // namespace

const StudyKind k_cutter_kind{"cutter",
                              "a cutter head",
                              "cutterflow params",
                              cases::study_table,
                              new_study,
                              check,
                              predicted_core_s,
                              mesh,
                              run,
                              is_run,
                              report,
                              points,
                              true,
                              write_comparison,
                              compare};

}  // namespace cutterflow::cli
