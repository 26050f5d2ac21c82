/// \file mesh, run, report: work in a run directory.
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/cli/commands.hpp"
#include "cases/runner/machine.hpp"
#include "cases/runner/pipeline.hpp"
#include "cases/runner/surface_stages.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "cases/scenes/free_surface/surface_study.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/process/shell_word.hpp"
#include "geometry/base/progress.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/versions.hpp"
#include "postproc/pages/adv_page.hpp"
#include "postproc/pages/report.hpp"
#include "postproc/pages/surface_page.hpp"

namespace cutterflow::cli {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
    std::string study;
    std::optional<std::string> output;
    int ranks = 1;
    std::string start_from;
    bool resume = false;
    bool json = false;
};

fs::path run_folder(const RunOptions& options) {
    return options.output ? fs::path(*options.output) : fs::path("runs") / fs::path(options.study).stem();
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

/// Progress goes to standard error; standard output has the requested result.
void say(const std::string& text) {
    std::cerr << "  " << text << std::endl;
}

cases::StageObserver stage_lines(std::size_t count) {
    return [count, index = std::make_shared<std::size_t>(0)](const cases::Stage& stage, cases::StageEvent event, double wall_s) {
        if (event != cases::StageEvent::ends) ++*index;
        const std::string title = fmt::format("[{}/{}] {}", *index, count, stage.name);
        if (event == cases::StageEvent::skipped) std::cerr << title << ": already done" << std::endl;
        if (event == cases::StageEvent::begins) std::cerr << title << std::endl;
        if (event == cases::StageEvent::ends) std::cerr << title << ": done in " << duration_text(wall_s) << std::endl;
    };
}

void go_through_stages(const RunOptions& options, const cases::RunDirectory& directory, const std::string& until, std::size_t count) {
    cases::Manifest manifest(directory.file(names::manifest));
    const auto versions = build_versions();
    manifest.set_versions({versions.begin(), versions.end()});
    cases::Pipeline pipeline(directory, {fs::absolute(options.study), options.ranks, solver_path(), options.start_from}, say);
    try {
        cases::run_stages(directory, manifest, pipeline.stages(), until, options.resume, stage_lines(count));
    } catch (const Interrupted& interrupted) {
        throw Interrupted(fmt::format("{}. Finished work is kept in {}; resume with: cutterflow {} {} -o {} --ranks {}{}",
                                      interrupted.what(), directory.path().string(), until == "mesh" ? "mesh" : "run",
                                      shell_word(options.study), shell_word(run_folder(options).string()), options.ranks,
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
    mistakes.gather([&] { cases::require_usable_run_directory(run_folder(options)); });
    mistakes.gather([&] { cases::require_machine(options.ranks); });
    if (!options.start_from.empty()) mistakes.gather([&] { cases::require_start_donor(options.start_from); });
    mistakes.gather([&] { cases::require_study_file(options.study); });
    mistakes.refuse();
    require_programs(programs_for(options, until));
}

bool is_surface(const RunOptions& options) {
    return fs::exists(options.study) && cases::is_surface_study(options.study);
}

void run_surface(const RunOptions& options) {
    const fs::path solver = installation().programs / "cutterSurface";
    Mistakes mistakes;
    if (options.ranks != 1)
        mistakes.add({"", fmt::format("--ranks {}", options.ranks), "A scene with a free surface runs on one core",
                      "Leave it out; run several studies side by side"});
    if (!options.start_from.empty())
        mistakes.add({"", "--start-from with a scene with a free surface", "It has no frozen-rotor flow", "Leave it out"});
    mistakes.gather([&] { cases::require_usable_run_directory(run_folder(options)); });
    cases::SurfaceCheck check;
    mistakes.gather([&] { check = cases::check_surface_study(options.study); });
    mistakes.refuse();
    require_programs({solver.string()});
    const cases::RunDirectory directory(run_folder(options));
    cases::Manifest manifest(directory.file(names::manifest));
    const auto versions = build_versions();
    manifest.set_versions({versions.begin(), versions.end()});
    try {
        cases::run_stages(directory, manifest, cases::surface_stages(directory, options.study, check, solver), "report", options.resume,
                          stage_lines(3));
    } catch (const Interrupted& interrupted) {
        throw Interrupted(fmt::format("{}. Finished work is kept in {}; resume with: cutterflow run {} -o {} --resume", interrupted.what(),
                                      directory.path().string(), shell_word(options.study), shell_word(run_folder(options).string())));
    }
    std::cout << (options.json ? read_file(directory.file(names::results_json))
                               : fmt::format("the report: {}\n", directory.file(names::report_page).string()))
              << std::flush;
}

void mesh(const RunOptions& options) {
    if (is_surface(options))
        throw UserError(fmt::format("mesh of {}", options.study), "A scene with a free surface needs no mesh", "Use cutterflow run");
    require_begun_well(options, "mesh");
    const cases::RunDirectory directory(run_folder(options));
    go_through_stages(options, directory, "mesh", 2);
    const std::string report = read_file(directory.file(names::mesh_report));
    std::cout << (options.json ? report : fmt::format("the mesh: {}\n", directory.path().string())) << std::flush;
}

void run(const RunOptions& options) {
    if (is_surface(options)) return run_surface(options);
    require_begun_well(options, "report");
    const cases::RunDirectory directory(run_folder(options));
    go_through_stages(options, directory, "report", 6);
    if (options.json) {
        std::cout << read_file(directory.file(names::results_json)) << std::flush;
    } else {
        std::cout << fmt::format("the report: {}\n", directory.file(names::report_page).string());
    }
}

struct ReportOptions {
    std::string folder;
    std::optional<std::string> adv_points;
    std::optional<int> revolutions;
    std::optional<std::string> still_folder;
    bool adv_template = false;
    bool json = false;
};

void adv_report(const ReportOptions& options) {
    const postproc::AdvComparison comparison = postproc::compare_with_measurement(options.folder, *options.adv_points, options.revolutions);
    const fs::path page = postproc::write_adv_report(comparison, options.folder);
    std::cout << (options.json ? read_file(fs::path(options.folder) / names::adv_json)
                               : fmt::format("{}the page: {}\n", postproc::adv_text(comparison), page.string()))
              << std::flush;
}

void surface_report(const ReportOptions& options) {
    if (options.adv_points || options.still_folder)
        throw UserError("--adv or --static with a scene with a free surface", "They belong to cutters", "Leave them out");
    const fs::path page = postproc::write_surface_report(options.folder);
    std::cout << (options.json ? read_file(fs::path(options.folder) / names::results_json) : fmt::format("the report: {}\n", page.string()))
              << std::flush;
}

void report(const ReportOptions& options) {
    if (options.adv_template) {
        std::cout << postproc::adv_template() << std::flush;
        return;
    }
    if (options.folder.empty())
        throw UserError("report without a run directory", "A report needs a run", "Give the directory: cutterflow report DIR");
    if (postproc::is_surface_run(options.folder)) return surface_report(options);
    if (options.adv_points) return adv_report(options);
    const postproc::ReportSummary summary =
        options.still_folder ? postproc::publish_report(options.folder, *options.still_folder) : postproc::write_report(options.folder);
    if (!summary.note.empty()) say(summary.note);
    std::cout << (options.json ? read_file(summary.results_file) : fmt::format("the report: {}\n", summary.page_file.string()))
              << std::flush;
}

void add_run_options(CLI::App& command, RunOptions& options) {
    command.add_option("study", options.study, "The study file")->required();
    command.add_option("-o,--output", options.output, "Run directory; default runs/<name of the study file>");
    command.add_option("--ranks", options.ranks, "Processes, at most the machine's cores")->capture_default_str();
}

}  // namespace

void add_mesh(CLI::App& app) {
    auto* command = app.add_subcommand("mesh", "Read the cutter and build the mesh of a study.");
    const auto options = std::make_shared<RunOptions>();
    add_run_options(*command, *options);
    command->add_flag("--json", options->json, "Print mesh.json");
    command->callback([options] { mesh(*options); });
}

void add_run(CLI::App& app) {
    auto* command = app.add_subcommand("run", "Execute every unfinished stage: geometry, mesh, case, start, run, report.");
    const auto options = std::make_shared<RunOptions>();
    add_run_options(*command, *options);
    command->add_option("--start-from", options->start_from,
                        "Run directory whose frozen-rotor flow is reused if its case is identical byte by byte, as for a repeat");
    command->add_flag("--resume", options->resume, "Resume an interrupted run from its last checkpoint");
    command->add_flag("--json", options->json, "Print results.json");
    command->callback([options] { run(*options); });
}

void add_report(CLI::App& app) {
    auto* command = app.add_subcommand("report", "Rewrite the report of a run directory, finished or not.");
    const auto options = std::make_shared<ReportOptions>();
    command->add_option("run_directory", options->folder, "The run directory");
    auto* points =
        command->add_option("--adv", options->adv_points,
                            "Compare with velocities measured at the points of this CSV file, which the run sampled (report.adv_points)");
    command->add_option("--revolutions", options->revolutions, "Number of last revolutions to average over; default: all whole ones")
        ->needs(points);
    command
        ->add_option("--static", options->still_folder,
                     "Folder for results.json and a page without scripts, to publish; the run's own report stays as it is")
        ->excludes(points);
    command->add_flag("--adv-template", options->adv_template, "Print a CSV file of points to fill in");
    command->add_flag("--json", options->json, "Print results.json, or adv.json");
    command->callback([options] { report(*options); });
}

}  // namespace cutterflow::cli
