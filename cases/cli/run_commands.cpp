/// \file mesh, run, report: work in a run directory.
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "cases/cli/commands.hpp"
#include "cases/cli/kinds/stage_lines.hpp"
#include "cases/cli/kinds/study_kind.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/run_files.hpp"
#include "postproc/pages/adv_page.hpp"

namespace cutterflow::cli {
namespace {

void report(const ReportOptions& options) {
    if (options.adv_template) {
        std::cout << postproc::adv_template() << std::flush;
        return;
    }
    if (options.folder.empty())
        throw UserError("report without a run directory", "A report needs a run", "Give the directory: cutterflow report DIR");
    kind_of_run(options.folder).report(options);
}

void add_run_options(CLI::App& command, RunOptions& options) {
    command.add_option("study", options.study, "The study file")->required();
    command.add_option("-o,--output", options.output, "Run directory; default runs/<name of the study file>");
    command.add_option("--ranks", options.ranks, "Processes, at most the machine's cores")->capture_default_str();
}

}  // namespace

void add_mesh(CLI::App& app) {
    auto* command = app.add_subcommand("mesh", "Build the mesh of a study of a cutter, or the bed of a room, and no more.");
    const auto options = std::make_shared<RunOptions>();
    add_run_options(*command, *options);
    command->add_flag("--resume", options->resume, "Resume an interrupted bed from its last checkpoint");
    command->add_flag("--json", options->json, "Print mesh.json");
    command->callback([options] { kind_of_study(options->study).mesh(*options); });
}

void add_run(CLI::App& app) {
    auto* command = app.add_subcommand("run", "Execute every unfinished stage of a study, up to its report.");
    const auto options = std::make_shared<RunOptions>();
    add_run_options(*command, *options);
    command->add_option("--start-from", options->start_from,
                        "Run directory to take the frozen-rotor flow from (of a room: the bed), if what makes it is identical");
    command->add_flag("--resume", options->resume, "Resume an interrupted run from its last checkpoint");
    command->add_flag("--json", options->json, "Print results.json");
    command->callback([options] {
        const StudyKind& kind = kind_of_study(options->study);
        const std::filesystem::path folder = options->folder();
        if (options->resume && (!std::filesystem::exists(folder) || std::filesystem::is_empty(folder)))
            say(fmt::format("there is no run in {} to resume: it begins", folder.string()));
        kind.run(*options);
    });
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
