/// \file mesh, run, report: work in a run directory.
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/cli/commands.hpp"
#include "cases/machine.hpp"
#include "cases/pipeline.hpp"
#include "geometry/base/child_process.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/progress.hpp"
#include "geometry/base/run_names.hpp"
#include "postproc/report.hpp"

namespace cutterflow::cli {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
    std::string study;
    std::optional<std::string> output;
    int ranks = 1;
    bool resume = false;
    bool json = false;
};

fs::path run_folder(const RunOptions& options) {
    return options.output ? fs::path(*options.output) : fs::path("runs") / fs::path(options.study).stem();
}

/// cutterFoam stands beside this program.
fs::path solver_path() {
    return fs::read_symlink("/proc/self/exe").parent_path() / "cutterFoam";
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

/// Progress goes to standard error: standard output holds what was asked for.
void say(const std::string& text) {
    std::cerr << "  " << text << std::endl;
}

cases::StageObserver stage_lines(std::size_t count) {
    return [count, index = std::make_shared<std::size_t>(0)](const cases::Stage& stage, cases::StageEvent event, double wall_s) {
        if (event != cases::StageEvent::ends) ++*index;
        const std::string title = fmt::format("[{}/{}] {}", *index, count, stage.name);
        if (event == cases::StageEvent::skipped) std::cerr << title << ": done before" << std::endl;
        if (event == cases::StageEvent::begins) std::cerr << title << std::endl;
        if (event == cases::StageEvent::ends) std::cerr << title << ": done in " << duration_text(wall_s) << std::endl;
    };
}

void go_through_stages(const RunOptions& options, const cases::RunDirectory& directory, const std::string& until, std::size_t count) {
    cases::Manifest manifest(directory.file(names::manifest));
    manifest.set_versions({{"cutterflow", CUTTERFLOW_VERSION}, {"openfoam", "1912"}});
    cases::Pipeline pipeline(directory, {fs::absolute(options.study), options.ranks, solver_path()}, say);
    try {
        cases::run_stages(directory, manifest, pipeline.stages(), until, options.resume, stage_lines(count));
    } catch (const Interrupted& interrupted) {
        throw Interrupted(fmt::format("{}. What is done is kept in {}; go on with: cutterflow {} {} -o {} --ranks {}{}", interrupted.what(),
                                      directory.path().string(), until == "mesh" ? "mesh" : "run", options.study,
                                      run_folder(options).string(), options.ranks, until == "mesh" ? "" : " --resume"));
    }
}

void mesh(const RunOptions& options) {
    cases::require_usable_run_directory(run_folder(options));
    cases::require_machine(options.ranks, programs_for(options, "mesh"));
    const cases::RunDirectory directory(run_folder(options));
    go_through_stages(options, directory, "mesh", 2);
    const std::string report = read_file(directory.file(names::mesh_report));
    std::cout << (options.json ? report : fmt::format("the mesh: {}\n", directory.path().string())) << std::flush;
}

void run(const RunOptions& options) {
    cases::require_usable_run_directory(run_folder(options));
    cases::require_machine(options.ranks, programs_for(options, "report"));
    const cases::RunDirectory directory(run_folder(options));
    go_through_stages(options, directory, "report", 6);
    if (options.json) {
        std::cout << read_file(directory.file(names::results_json)) << std::flush;
    } else {
        std::cout << fmt::format("the report: {}\n", directory.file(names::report_page).string());
    }
}

void report(const std::string& folder, bool json) {
    const postproc::ReportSummary summary = postproc::write_report(folder);
    if (!summary.note.empty()) say(summary.note);
    std::cout << (json ? read_file(summary.results_file) : fmt::format("the report: {}\n", summary.page_file.string())) << std::flush;
}

void add_run_options(CLI::App& command, RunOptions& options) {
    command.add_option("study", options.study, "The study file")->required();
    command.add_option("-o,--output", options.output, "Run directory; without it runs/<name of the study file>");
    command.add_option("--ranks", options.ranks, "Processes, at most the machine's cores")->capture_default_str();
}

}  // namespace

void add_mesh(CLI::App& app) {
    auto* command = app.add_subcommand("mesh", "Read the cutter and make the mesh of a study.");
    const auto options = std::make_shared<RunOptions>();
    add_run_options(*command, *options);
    command->add_flag("--json", options->json, "Print mesh.json");
    command->callback([options] { mesh(*options); });
}

void add_run(CLI::App& app) {
    auto* command = app.add_subcommand("run", "Go through every stage that is not done yet: geometry, mesh, case, start, run, report.");
    const auto options = std::make_shared<RunOptions>();
    add_run_options(*command, *options);
    command->add_flag("--resume", options->resume, "Go on with an interrupted run from its last checkpoint");
    command->add_flag("--json", options->json, "Print results.json");
    command->callback([options] { run(*options); });
}

void add_report(CLI::App& app) {
    auto* command = app.add_subcommand("report", "Make the report of a run directory anew, finished or not.");
    const auto folder = std::make_shared<std::string>();
    const auto json = std::make_shared<bool>(false);
    command->add_option("run_directory", *folder, "The run directory")->required();
    command->add_flag("--json", *json, "Print results.json");
    command->callback([folder, json] { report(*folder, *json); });
}

}  // namespace cutterflow::cli
