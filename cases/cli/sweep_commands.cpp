/// \file sweep, compare: many runs.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/cli/commands.hpp"
#include "cases/cli/new_file.hpp"
#include "cases/cli/numbers.hpp"
#include "cases/cli/replay_lines.hpp"
#include "cases/runner/machine.hpp"
#include "cases/scenes/free_surface/surface_study.hpp"
#include "cases/study/study.hpp"
#include "cases/sweep/surface_sweep.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/parameters/parameter.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/process/shell_word.hpp"
#include "postproc/analysis/surface_comparison.hpp"
#include "postproc/pages/comparison_page.hpp"
#include "postproc/pages/surface_page.hpp"

namespace cutterflow::cli {
namespace {

namespace fs = std::filesystem;

void say(const std::string& text) {
    std::cerr << "  " << text << std::endl;
}

struct SweepOptions {
    std::string study;
    std::optional<std::string> output;
    cases::SweepAxes axes;
    std::vector<std::string> set;  ///< other keys of the study
    int ranks = 1;
    bool resume = false;
    std::string launcher = "local";
    bool emit = false;
    int replays = 0;  ///< of every setting; 0: none
};

/// Options unknown to CLI11: most likely a key that a sweep does not vary.
void require_known_axes(const std::vector<std::string>& words) {
    const std::vector<std::string> known{"--rpm", "--discharge", "--design", "--set", "--repeats"};
    std::vector<Mistake> mistakes;
    for (const std::string& word : words) {
        if (word.empty() || word.front() != '-') continue;
        const std::string axis = word.substr(0, word.find('='));
        const std::string nearest = nearest_word(axis, known);
        mistakes.push_back({"", fmt::format("a sweep over {}", axis), fmt::format("A sweep varies {}", fmt::join(known, ", ")),
                            nearest.empty() ? "Write other changes into separate studies, and compare the runs with cutterflow compare"
                                            : fmt::format("Did you mean {}?", nearest)});
    }
    if (mistakes.empty() && !words.empty())
        mistakes.push_back(
            {"", fmt::format("\"{}\" belongs to no option", words.front()), "A sweep takes one study, and options", "Remove it"});
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

bool is_surface(const SweepOptions& options) {
    return fs::exists(options.study) && cases::is_surface_study(options.study);
}

/// \throws UserError  when the points would record no flow, or run elsewhere
void require_recorded_points(const SweepOptions& options) {
    if (options.replays == 0) return;
    if (is_surface(options) || options.launcher != "local" || options.emit)
        throw UserError("--replay with a free-surface study, --launcher slurm or --emit", "Replays follow cutters that run on this machine",
                        "Leave it out, and use cutterflow replay on the finished runs");
    if (cases::read_study(options.study).number("run.record_revolutions") == 0.0)
        throw UserError({{options.study, "run.record_revolutions = 0 in a sweep with --replay",
                          "A replay needs the flow that its run recorded before the rock", "Set run.record_revolutions = 1"}});
}

/// Repeats of one setting, by the name of the first.
std::map<std::string, std::vector<fs::path>> runs_by_setting(const std::vector<cases::SweepPoint>& points,
                                                             const std::vector<fs::path>& done) {
    std::map<std::string, std::vector<fs::path>> settings;
    for (const cases::SweepPoint& point : points) {
        const auto run = std::find_if(done.begin(), done.end(), [&](const fs::path& folder) { return folder.filename() == point.name; });
        if (run != done.end()) settings[point.start_donor.empty() ? point.name : point.start_donor].push_back(*run);
    }
    return settings;
}

void replay_settings(const SweepOptions& options, const std::vector<cases::SweepPoint>& points, const std::vector<fs::path>& done,
                     const fs::path& folder) {
    for (const auto& [name, runs] : runs_by_setting(points, done)) {
        const fs::path replays = folder / ("replays_" + name);
        say(fmt::format("{}: {} replays in {}", name, options.replays, replays.string()));
        std::cout << name << '\n' << replay_lines(runs, {}, options.replays, replays, fs::exists(replays));
    }
}

/// The points of a study, of whichever kind it is.
std::vector<cases::SweepPoint> points_of(const SweepOptions& options, const fs::path& folder) {
    if (!is_surface(options)) {
        cases::SweepAxes axes = options.axes;
        axes.keys = cases::key_axes(cases::study_table(), options.set, "cutterflow params");
        return cases::sweep_points(options.study, axes, folder);
    }
    if (!options.axes.speeds.empty() || !options.axes.discharges.empty() || !options.axes.designs.empty() || options.ranks != 1)
        throw UserError("--rpm, --discharge, --design or --ranks in a sweep of a free-surface study", "They belong to cutters",
                        "Use --set KEY=a,b and --repeats");
    return cases::surface_sweep_points(options.study,
                                       cases::key_axes(cases::surface_study_table(), options.set, "cutterflow params --kind free_surface"),
                                       options.axes.repeats);
}

fs::path write_comparison(const std::vector<fs::path>& runs, bool surface, const fs::path& folder) {
    return surface ? postproc::write_surface_comparison(postproc::compare_surface_runs(runs), folder)
                   : postproc::write_comparison(postproc::compare_runs(runs), folder);
}

/// \param words  that belong to no option
void sweep(const SweepOptions& options, const std::vector<std::string>& words) {
    const bool local = options.launcher == "local" && !options.emit;
    const fs::path folder =
        options.output ? fs::path(*options.output) : fs::path("runs") / (fs::path(options.study).stem().string() + "_sweep");
    Mistakes mistakes;
    std::vector<cases::SweepPoint> points;
    mistakes.gather([&] { require_known_axes(words); });
    // Slurm's nodes may have more cores than the submitting machine.
    mistakes.gather([&] { cases::require_machine(local ? options.ranks : std::min(options.ranks, 1)); });
    mistakes.gather([&] { cases::require_sweep_folder(folder, options.resume); });
    mistakes.gather([&] { points = points_of(options, folder); });
    mistakes.gather([&] { require_recorded_points(options); });
    mistakes.refuse();
    const int jobs = std::max(1, cases::available_cores() / options.ranks);
    const cases::SweepSettings settings{folder,         installation().programs / "cutterflow",
                                        options.ranks,  jobs,
                                        options.resume, local ? cases::Launcher::local : cases::Launcher::slurm};
    if (options.emit) {
        const fs::path script = cases::emit_slurm(points, settings);
        std::cout
            << (script.empty()
                    ? std::string("no point is missing\n")
                    : fmt::format(
                          "the job array: {0}\nnext: sbatch {1}; then this command with --launcher slurm --resume collects and compares\n",
                          script.string(), shell_word(script.string())));
        return;
    }
    if (local)
        say(fmt::format("{} points, {} in parallel on {} rank(s) each, in {}", points.size(), jobs, options.ranks, folder.string()));
    else
        say(fmt::format("{} points by Slurm, on {} core(s) each, in {}", points.size(), options.ranks, folder.string()));
    cases::SweepOutcome outcome;
    try {
        outcome = cases::run_sweep(points, settings, say);
    } catch (const Interrupted& interrupted) {
        throw Interrupted(
            fmt::format("{}. Finished work is kept in {}; repeat the command with --resume", interrupted.what(), folder.string()));
    }
    if (outcome.done.size() > 1)
        std::cout << fmt::format("the comparison: {}\n",
                                 write_comparison(outcome.done, is_surface(options), folder / "comparison").string());
    if (options.replays > 0) replay_settings(options, points, outcome.done, folder);
    if (!outcome.failed.empty()) {
        std::vector<Mistake> failures;
        for (const std::string& text : outcome.failed) failures.push_back({"", text, "", ""});
        throw ToolError(failures);
    }
}

struct CompareOptions {
    std::vector<std::string> runs;
    std::optional<std::string> output, still_folder;
    std::vector<std::string> measured;
    bool measured_template = false;
    bool json = false;
};

void compare_surfaces(const CompareOptions& options) {
    if (!options.measured.empty())
        throw UserError("--measured with free-surface runs", "Measured points are spillage and production of cutters", "Leave it out");
    if (options.still_folder) throw UserError("--static with free-surface runs", "Their page has no script to leave out", "Use --output");
    const auto settings = postproc::compare_surface_runs({options.runs.begin(), options.runs.end()});
    std::cout << (options.json ? postproc::surface_comparison_json(settings).dump(2) + "\n" : postproc::setting_comparison_text(settings));
    if (options.output) say(fmt::format("the page: {}", postproc::write_surface_comparison(settings, *options.output).string()));
}

void compare(const CompareOptions& options) {
    if (options.measured_template) {
        std::cout << postproc::measured_template() << std::flush;
        return;
    }
    if (std::any_of(options.runs.begin(), options.runs.end(), [](const std::string& run) { return postproc::is_surface_run(run); }))
        return compare_surfaces(options);
    postproc::Comparison comparison = postproc::compare_runs({options.runs.begin(), options.runs.end()});
    postproc::add_measured(comparison, {options.measured.begin(), options.measured.end()});
    if (options.output && options.still_folder) require_different_places("--output", *options.output, "--static", *options.still_folder);
    for (const auto& folder : {options.output, options.still_folder})
        if (folder) postproc::require_own_comparison(comparison, *folder);
    std::cout << (options.json ? postproc::comparison_json(comparison).dump(2) + "\n" : postproc::comparison_text(comparison));
    if (options.output) say(fmt::format("the page: {}", postproc::write_comparison(comparison, *options.output).string()));
    if (options.still_folder)
        say(fmt::format("the page without scripts: {}",
                        postproc::write_comparison(comparison, *options.still_folder, postproc::PageForm::still).string()));
}

}  // namespace

void add_sweep(CLI::App& app) {
    auto* command = app.add_subcommand("sweep", "Run a study at several speeds, discharges, designs and repeats, and compare them.");
    const auto options = std::make_shared<SweepOptions>();
    command->add_option("study", options->study, "The study that all points start from")->required();
    command->add_option("--rpm", options->axes.speeds, "Rotor speeds, as 30,60,90")->delimiter(',')->check(k_positive);
    command->add_option("--discharge", options->axes.discharges, "Discharges [m3/s], as 0.08,0.12")->delimiter(',')->check(k_positive);
    command->add_option("--design", options->axes.designs, "Surfaces of cutters, as a.stl,b.stl")->delimiter(',');
    command->add_option("--set", options->set, "Values of a key of the study, as swing.speed_m_min=4,8; may be given again")->take_all();
    command
        ->add_option("--repeats", options->axes.repeats,
                     "Repeats that differ by placement and angle of release; three or more give intervals")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    command
        ->add_option("--replay", options->replays,
                     "Placements of rock in the flow that each setting recorded, after its runs: spillage with its interval")
        ->check(CLI::Range(1, 1000));
    command->add_option("-o,--output", options->output, "Folder of the sweep; default runs/<name of the study file>_sweep");
    command->add_option("--ranks", options->ranks, "Processes per run; runs execute in parallel up to the available cores")
        ->capture_default_str();
    command->add_flag("--resume", options->resume, "Resume a stopped or killed sweep, or add points to it");
    command->add_option("--launcher", options->launcher, "Where the points run: on this machine, or by Slurm as a job array")
        ->check(CLI::IsMember({"local", "slurm"}))
        ->capture_default_str();
    command
        ->add_option_function<std::string>(
            "--emit", [options](const std::string&) { options->emit = true; },
            "Only write the job array (slurm) of the points that have no report yet")
        ->check(CLI::IsMember({"slurm"}));
    command->allow_extras();
    command->callback([options, command] { sweep(*options, command->remaining()); });
}

void add_compare(CLI::App& app) {
    auto* command = app.add_subcommand("compare", "Compare runs: designs, speeds, discharges, repeats; differences from the first.");
    const auto options = std::make_shared<CompareOptions>();
    command->add_option("run_directories", options->runs, "Run directories; repeats of one study are combined");
    command->add_option("-o,--output", options->output, "Folder for the page and comparison.json");
    command->add_option("--static", options->still_folder, "Folder for comparison.json and a page without scripts, to publish");
    command->add_option("--measured", options->measured, "CSV files of measured spillage or production, to stand beside the runs");
    command->add_flag("--measured-template", options->measured_template, "Print such a CSV file to fill in");
    command->add_flag("--json", options->json, "Print comparison.json");
    command->callback([options] { compare(*options); });
}

}  // namespace cutterflow::cli
