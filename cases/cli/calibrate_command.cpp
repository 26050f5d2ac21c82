/// \file calibrate: parameters of studies at which their runs agree with measurements.
#include <algorithm>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/calibration/calibrate.hpp"
#include "cases/cli/commands.hpp"
#include "cases/cli/kinds/stage_lines.hpp"
#include "cases/cli/kinds/study_kind.hpp"
#include "cases/runner/machine.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/process/child_process.hpp"
#include "postproc/analysis/measures/measure_table.hpp"
#include "postproc/pages/calibration_page.hpp"

namespace cutterflow::cli {
namespace {

namespace fs = std::filesystem;

/// "contact.friction=0.1,0.2" of each axis, as sweep --set takes them.
std::vector<std::string> words_of(const std::vector<cases::KeyAxis>& axes) {
    std::vector<std::string> words;
    for (const cases::KeyAxis& axis : axes) words.push_back(fmt::format("{}={}", axis.key, fmt::join(axis.values, ",")));
    return words;
}

std::vector<cases::SweepPoint> points(const fs::path& study, const std::vector<cases::KeyAxis>& axes, const cases::RepeatRange& repeats,
                                      const fs::path& folder) {
    SweepOptions options;
    options.study = study.string();
    options.axes.repeats = repeats;
    options.set = words_of(axes);
    return kind_of_study(study).points(options, folder);
}

/// Of the tables [[measure]]; none where the kind has none. An unknown kind of measure is told with the study.
std::vector<cases::StudyMeasure> measures(const fs::path& study) {
    const ParameterTable& table = kind_of_study(study).table();
    std::vector<cases::StudyMeasure> found;
    if (!cases::find_key(table, "measure.name")) return found;
    const ParameterValues values = read_parameters(table, study);
    for (const ParameterValues& measure : values.tables("measure")) {
        const postproc::MeasureKind* kind = postproc::find_measure_kind(measure.text("measure.what"));
        found.push_back({measure.text("measure.name"), kind == nullptr || kind->has_profile});
    }
    return found;
}

cases::StudyAccess study_access() {
    return {points, [](const fs::path& study) { return kind_of_study(study).predicted_core_s(study); }, measures};
}

struct CalibrateOptions {
    std::string file, output, launcher = "local";
    int ranks = 1, jobs = 0;
    bool resume = false, plan = false;
};

std::string plan_text(const cases::CalibrationFile& file) {
    const cases::CalibrationPlan& plan = file.plan;
    std::string text =
        fmt::format("{} places at most, {} of them the grid, {} run(s) each, and {} at the answer; {} runs of {}", plan.grid + plan.further,
                    plan.grid, file.runs_of_a_place(), file.runs_of_the_answer(), plan.runs, file.budget_runs);
    text += plan.core_h ? fmt::format("; about {:.3g} core hours of {}", *plan.core_h, file.budget_core_h)
                        : fmt::format("; {} core hours at most", file.budget_core_h);
    return text;
}

void calibrate(const CalibrateOptions& options) {
    if (options.plan) {
        std::cout << plan_text(cases::read_calibration(options.file, study_access())) << '\n';
        return;
    }
    const bool local = options.launcher == "local";
    const int jobs = options.jobs > 0 ? options.jobs : std::max(1, cases::available_cores() / options.ranks);
    const cases::CalibrateSettings settings{options.file,
                                            options.output,
                                            installation().programs / "cutterflow",
                                            options.ranks,
                                            jobs,
                                            options.resume,
                                            local ? cases::Launcher::local : cases::Launcher::slurm,
                                            study_access()};
    Mistakes mistakes;
    cases::CalibrationFile file;
    mistakes.gather([&] { cases::require_machine(local ? options.ranks : 1); });
    mistakes.gather([&] { file = cases::begin_calibration(settings); });
    mistakes.refuse();
    say(plan_text(file));
    try {
        const postproc::calibration::Outcome outcome = cases::run_calibration(file, settings, say);
        const fs::path page = postproc::write_calibration(outcome, settings.folder);
        std::cout << postproc::calibration::outcome_text(outcome) << fmt::format("the page: {}\n", page.string());
    } catch (const Interrupted& interrupted) {
        throw Interrupted(fmt::format("{}. Finished runs are kept in {}; repeat the command with --resume", interrupted.what(),
                                      settings.folder.string()));
    }
}

void refuse_without_folder(const CalibrateOptions& options) {
    Mistakes mistakes;
    mistakes.add("calibrate without -o", "Its runs need a folder", "Name one: cutterflow calibrate FILE -o DIR");
    mistakes.gather([&] { cases::read_calibration(options.file, study_access()); });
    mistakes.refuse();
}

}  // namespace

void add_calibrate(CLI::App& app) {
    auto* command = app.add_subcommand("calibrate", "Find values of studies' keys at which their runs agree with measurements.");
    const auto options = std::make_shared<CalibrateOptions>();
    command->add_option("calibration", options->file, "The calibration file: studies, parameters, targets, budget")->required();
    auto* output = command->add_option("-o,--output", options->output, "Folder of the calibration");
    command->add_flag("--plan", options->plan, "Check the file and print what it takes; run nothing");
    command->add_option("--ranks", options->ranks, "Processes per run")->check(CLI::Range(1, 1000))->capture_default_str();
    command->add_option("--jobs", options->jobs, "Runs in parallel; default: as many as the cores carry")->check(CLI::Range(1, 1000));
    command->add_flag("--resume", options->resume, "Go on with a calibration that was stopped");
    command->add_option("--launcher", options->launcher, "Where the runs are made: on this machine, or by Slurm as a job array")
        ->check(CLI::IsMember({"local", "slurm"}))
        ->capture_default_str();
    command->callback([options, output] {
        if (!options->plan && output->count() == 0) refuse_without_folder(*options);
        calibrate(*options);
    });
}

}  // namespace cutterflow::cli
