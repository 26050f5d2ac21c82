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
#include "cases/cli/kinds/stage_lines.hpp"
#include "cases/cli/kinds/study_kind.hpp"
#include "cases/cli/new_file.hpp"
#include "cases/cli/numbers.hpp"
#include "cases/cli/replay_lines.hpp"
#include "cases/replay/replayed_settings.hpp"
#include "cases/replay/rock_study.hpp"
#include "cases/runner/machine.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "cases/study/study.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/parameters/parameter.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/process/shell_word.hpp"
#include "postproc/pages/comparison_page.hpp"

namespace cutterflow::cli {
namespace {

namespace fs = std::filesystem;

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

/// \throws UserError  when the points would record no flow, or run elsewhere, or have no one flow for another study's rock
void require_recorded_points(const SweepOptions& options) {
    Mistakes mistakes;
    mistakes.require(options.replay_study.empty() || options.replays > 0, "--replay-study without --replay",
                     "It names the study whose rock is replayed", "Add --replay N");
    mistakes.require(options.replay_study.empty() || options.axes.repeats.count == 1,
                     fmt::format("--replay-study with --repeats {}", options.axes.repeats.count),
                     "Another study's rock is replayed in one flow of each setting", "Leave --repeats out");
    mistakes.require(options.replay_study.empty() || fs::exists(options.replay_study),
                     fmt::format("--replay-study {} does not exist", options.replay_study), "Its path is relative to the current folder",
                     "Check the path");
    mistakes.refuse();
    if (options.replays == 0) return;
    if (!kind_of_study(options.study).replays || options.launcher != "local" || options.emit)
        throw UserError("--replay with a study that is not a cutter's, --launcher slurm or --emit",
                        "Replays follow cutters that run on this machine", "Leave it out, and use cutterflow replay on the finished runs");
    if (cases::read_study(options.study).number("run.record_revolutions") == 0.0)
        throw UserError({{options.study, "run.record_revolutions = 0 in a sweep with --replay",
                          "A replay needs the flow that its run recorded before the rock", "Set run.record_revolutions = 1"}});
}

cases::HeadSize size_of(const fs::path& cutter, ParameterValues values) {
    values.set("cutter.file", cutter.string());
    return cases::head_size(*cases::import_study_cutter(values, "").head);
}

/// \throws UserError  when the rock to be replayed does not fit the flow of a point
void require_fitting_rock(const SweepOptions& options, const std::vector<cases::SweepPoint>& points, const fs::path& folder) {
    if (options.replay_study.empty()) return;
    const fs::path studies = cases::studies_folder(folder);
    std::map<fs::path, cases::HeadSize> heads;  // a cutter is read once
    for (const cases::SweepPoint& point : points) {
        const ParameterValues values = parse_parameters(cases::study_table(), point.text, point.name);
        const fs::path cutter = (studies / values.text("cutter.file")).lexically_normal();
        if (heads.count(cutter) == 0) heads[cutter] = size_of(cutter, values);
        cases::read_rock_study(cases::planned_flow(values, studies, heads[cutter]), options.replay_study);
    }
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

/// Folders of the replays that are no pairs.
std::vector<fs::path> replay_folders(const fs::path& replays, const cases::ReplayResults& results) {
    std::vector<fs::path> folders;
    for (const cases::Replay& replay : results.replays)
        if (!replay.is_pair) folders.push_back(replays / replay.name);
    return folders;
}

/// Replays every setting, writes replays.csv and compares the replays. \return why settings have no answer, or one that is refused
std::vector<cases::SweepFailure> replay_settings(const SweepOptions& options, const std::vector<cases::SweepPoint>& points,
                                                 const std::vector<fs::path>& done, const fs::path& folder) {
    std::vector<fs::path> told;
    const auto replay = [&](const std::string& name, const std::vector<fs::path>& runs) {
        const fs::path replays = folder / ("replays_" + name);
        say(fmt::format("{}: {} replay{} in {}", name, options.replays, options.replays == 1 ? "" : "s", replays.string()));
        ReplayAnswer answer = replay_answer(runs, options.replay_study, options.replays, replays, cases::holds_replays(replays));
        std::cout << name << '\n' << answer.lines;
        if (cases::is_weakly_coupled(answer.results.estimate))
            for (fs::path& folder_told : replay_folders(replays, answer.results)) told.push_back(std::move(folder_told));
        return std::move(answer.results);
    };
    cases::ReplayedSettings all = cases::replay_each(runs_by_setting(points, done), replay);
    write_file(folder / "replays.csv", cases::replays_csv(all.settings));
    std::cout << fmt::format("the replays: {}\n", (folder / "replays.csv").string());
    if (told.size() > 1)
        std::cout << fmt::format("their comparison: {}\n",
                                 kind_of_study(options.study).write_comparison(told, folder / "replays_comparison").string());
    return std::move(all.failures);
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
    mistakes.gather([&] { points = kind_of_study(options.study).points(options, folder); });
    mistakes.gather([&] { require_recorded_points(options); });
    mistakes.gather([&] { require_fitting_rock(options, points, folder); });
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
                                 kind_of_study(options.study).write_comparison(outcome.done, folder / "comparison").string());
    std::vector<cases::SweepFailure> failures;
    for (std::size_t i = 0; i < outcome.failed.size(); ++i)
        failures.push_back({i < outcome.refused ? ExitCode::user_input : ExitCode::external_program, outcome.failed[i]});
    if (options.replays > 0)
        for (cases::SweepFailure& failure : replay_settings(options, points, outcome.done, folder)) failures.push_back(std::move(failure));
    cases::require_no_failures(failures);
}

void compare(const CompareOptions& options) {
    if (options.measured_template) {
        std::cout << postproc::measured_template() << std::flush;
        return;
    }
    // A run that belongs to no other kind is taken for a cutter's.
    const auto is_other = [](const std::string& run) { return &kind_of_run(run) != &study_kinds().front(); };
    const auto other = std::find_if(options.runs.begin(), options.runs.end(), is_other);
    (other == options.runs.end() ? study_kinds().front() : kind_of_run(*other)).compare(options);
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
        ->add_option("--repeats", options->axes.repeats.count,
                     "Repeats that differ by placement and angle of release; three or more give intervals")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    command
        ->add_option("--replay", options->replays,
                     "Placements of rock in the flow that each setting recorded, after its runs: spillage with its interval")
        ->check(CLI::Range(1, 1000));
    command->add_option("--replay-study", options->replay_study,
                        "Study whose rock --replay places in those flows, in place of the sweep's own");
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
