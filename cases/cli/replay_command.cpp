/// \file replay: many placements of rock in a recorded flow.
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cases/cli/commands.hpp"
#include "cases/cli/replay_lines.hpp"
#include "cases/replay/replay.hpp"
#include "cases/runner/machine.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/process/child_process.hpp"

namespace cutterflow::cli {
namespace {

namespace fs = std::filesystem;

struct ReplayOptions {
    std::vector<std::string> runs;
    std::string study;
    int count = 20;
    std::string output;
    bool resume = false;
};

}  // namespace

ReplayAnswer replay_answer(const std::vector<fs::path>& runs, const fs::path& study, int count, const fs::path& folder, bool resume) {
    const cases::ReplaySettings settings{
        runs, study, count, folder, installation().programs / "cutterFoam", std::max(1, cases::available_cores()), resume};
    try {
        cases::ReplayResults results =
            cases::run_replays(settings, [](const std::string& text) { std::cerr << "  " << text << std::endl; });
        std::string text = postproc::replay_text(results.estimate, results.fed);
        if (!results.exits.empty()) text += postproc::exits_text(postproc::mean_exits(results.exits));
        return {std::move(results), std::move(text)};
    } catch (const Interrupted& interrupted) {
        throw Interrupted(fmt::format("{}. Finished replays are kept in {}; repeat the command with --resume", interrupted.what(),
                                      settings.folder.string()));
    }
}

void add_replay(CLI::App& app) {
    auto* command = app.add_subcommand(
        "replay", "Place rock many times in the flow that a run recorded: spillage with its interval, at a fraction of the cost.");
    const auto options = std::make_shared<ReplayOptions>();
    command
        ->add_option("run_directories", options->runs,
                     "Runs with run.record_revolutions above 0, repeats of one study; the first one's flow is replayed")
        ->required();
    command->add_option("--study", options->study,
                        "Study whose rock is replayed in the one run's flow; cutter, rotor, suction, tank, mesh and fluid may be left out");
    command->add_option("-n,--count", options->count, "Placements beside those of the runs")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("-o,--output", options->output, "Folder of the replays")->required();
    command->add_flag("--resume", options->resume, "Go on with a stopped call, or add placements to it");
    command->callback([options] {
        const ReplayAnswer answer =
            replay_answer({options->runs.begin(), options->runs.end()}, options->study, options->count, options->output, options->resume);
        std::cout << answer.lines;
        cases::require_weak_coupling(answer.results.estimate, options->output);
    });
}

}  // namespace cutterflow::cli
