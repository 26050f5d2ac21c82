#include "cases/runner/solver_run.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cases/runner/run_directory.hpp"
#include "cases/runner/run_progress.hpp"
#include "cases/scenes/cutter/flow_dictionaries.hpp"
#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/run_files.hpp"
#include "meshing/dictionary/foam_command.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

/// The first goes first: a case without it counts as undecomposed.
void remove_processor_folders(const fs::path& directory) {
    fs::remove_all(directory / "processor0");
    for (const fs::path& folder : processor_folders(directory)) fs::remove_all(folder);
}

/// As cutterFoam writes it last among the fluid's files of a time.
bool holds_fields(const fs::path& folder, const std::string& time) {
    return fs::exists(folder / time / "uniform/fluidState") && fs::exists(folder / time / "U");
}

/// Number of ranks on which the fields of a time are there: 1 for the undecomposed case, 0 when they are nowhere.
int ranks_that_hold(const fs::path& directory, const std::string& time) {
    const std::vector<fs::path> folders = processor_folders(directory);
    const bool all = std::all_of(folders.begin(), folders.end(), [&](const fs::path& folder) { return holds_fields(folder, time); });
    if (all && fs::exists(directory / "processor0")) return static_cast<int>(folders.size());
    return holds_fields(directory, time) ? 1 : 0;
}

double split(const fs::path& directory, int ranks, const std::vector<std::string>& options) {
    const FoamFile dictionary = decompose_file(ranks);
    meshing::write_foam_file(directory / dictionary.path, dictionary.foam_class, dictionary.contents);
    if (ranks == 1) return 0.0;
    return require_child(meshing::foam_command(directory, "decomposePar", options)).core_s;
}

}  // namespace

double decompose(const fs::path& run_directory, int ranks) {
    return split(run_directory, ranks, {"-force"});
}

RankChange move_checkpoint_to_ranks(const fs::path& run_directory, int ranks) {
    const std::string time = newest_checkpoint(run_directory).filename().string();
    RankChange change{ranks_that_hold(run_directory, time), 0.0};
    if (change.from == ranks) return change;
    if (change.from == 0)
        throw UserError(fmt::format("{} contains no fields of its checkpoint {}", run_directory.string(), time),
                        "A run is resumed from the fields of its newest checkpoint", "Start again in another directory with -o");
    if (change.from > 1) change.core_s += require_child(meshing::foam_command(run_directory, "reconstructPar", {})).core_s;
    remove_processor_folders(run_directory);
    change.core_s += split(run_directory, ranks, {"-time", time, "-copyUniform"});
    return change;
}

double bring_to_start(const fs::path& run_directory, const std::optional<int>& ranks, const std::function<void(const std::string&)>& say) {
    if (newest_checkpoint(run_directory).empty()) {
        remove_unfinished_run(run_directory);
        return ranks ? decompose(run_directory, *ranks) : 0.0;
    }
    drop_times_after_checkpoint(run_directory);
    RankChange change;
    if (ranks) change = move_checkpoint_to_ranks(run_directory, *ranks);
    if (ranks && change.from != *ranks) say(fmt::format("the checkpoint is converted from {} ranks to {}", change.from, *ranks));
    say("resuming from the last checkpoint");
    return change.core_s;
}

double run_own_solver(const ChildCommand& command, const std::function<void(const std::string&)>& each_line) {
    const ChildResult result = run_child(command, each_line);
    const auto ended = static_cast<ExitCode>(result.exit_code);
    if (ended == ExitCode::check_failed) throw CheckFailure(failure_of(command, result));
    if (ended == ExitCode::user_input) throw UserError({failure_of(command, result)});
    if (ended == ExitCode::interrupted)
        throw Interrupted(fmt::format("{} was asked to stop", fs::path(command.arguments.front()).filename().string()));
    if (ended != ExitCode::done) throw ToolError(failure_of(command, result));
    return result.core_s;
}

double run_solver(const fs::path& run_directory, const fs::path& solver, int ranks,
                  const std::function<void(const std::string&)>& each_line) {
    ChildCommand command = meshing::foam_command(run_directory, solver.string(), {}, ranks);
    command.first_stop_signal = k_end_in_order;
    keep_older_log(command.log);
    return run_own_solver(command, each_line);
}

}  // namespace cutterflow::cases
