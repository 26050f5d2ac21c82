#include "cases/runner/surface_stages.hpp"

#include <iostream>

#include <fmt/format.h>

#include "cases/runner/run_progress.hpp"
#include "cases/runner/solver_run.hpp"
#include "cases/runner/table_inputs.hpp"
#include "cases/scenes/free_surface/surface_study.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/run_files.hpp"
#include "postproc/pages/free_surface/surface_page.hpp"

namespace cutterflow::cases {

namespace {

namespace fs = std::filesystem;

StageOutcome write_case(const RunDirectory& directory, const SurfaceInputs& inputs, const SurfaceCheck& check) {
    write_file(directory.file(postproc::k_surface_study), inputs.study);
    for (const auto& [name, file] : inputs.copies) write_file(directory.file(name), read_file(file));
    write_file(directory.file(postproc::k_surface_scene), check.scene.dump(2) + "\n");
    write_file(directory.file(names::prediction), check.prediction.dump(2) + "\n");
    return {{postproc::k_surface_study, postproc::k_surface_scene}, 0.0};
}

/// Lines of progress go on to the user; everything is in the log.
StageOutcome run_solver(const RunDirectory& directory, const fs::path& solver, bool resume) {
    ChildCommand command{{solver.string(), directory.path().string()}, {}, directory.file("log.cutterSurface"), {}};
    if (resume && fs::exists(directory.file("scene.started.toml"))) command.arguments.emplace_back("--resume");
    command.first_stop_signal = k_end_in_order;
    keep_older_log(command.log);
    const double core_s = run_own_solver(command, [](const std::string& line) { std::cerr << "  " << line << std::endl; });
    return {{}, core_s};
}

}  // namespace

std::vector<Stage> surface_stages(const RunDirectory& directory, const fs::path& study_file, const SurfaceCheck& check,
                                  const fs::path& solver) {
    const SurfaceInputs inputs = surface_inputs(study_file);
    const std::map<std::string, std::string> none;
    const std::map<std::string, std::string> of_case =
        table_inputs(surface_study_table(), read_placed_surface_study(study_file), [](const Parameter&) { return true; });
    return {{"case", of_case, {}, false, [&directory, inputs, check](bool) { return write_case(directory, inputs, check); }},
            {"run", none, {}, true, [&directory, solver](bool resume) { return run_solver(directory, solver, resume); }},
            {"report",
             none,
             {},
             false,
             [&directory](bool) {
                 postproc::write_surface_report(directory.path());
                 return StageOutcome{};
             },
             {names::results_json, names::report_page}}};
}

}  // namespace cutterflow::cases
