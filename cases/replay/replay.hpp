#pragma once
/// \file Many placements of rock in the flow that a run recorded.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/parameters/parameter.hpp"
#include "postproc/analysis/replays/exits.hpp"
#include "postproc/analysis/replays/replay_estimate.hpp"

namespace cutterflow::cases {

struct ReplaySettings {
    std::vector<std::filesystem::path> runs;  ///< run directories with a recording, repeats of one study; the first one's flow is replayed
    std::filesystem::path study;              ///< whose rock is replayed, in the flow of the one run; empty: the runs' own
    int count = 20;                           ///< replays with placements of their own, beside one per run with that run's placement
    std::filesystem::path folder;             ///< of the results; new, or with `resume` that of an interrupted call
    std::filesystem::path solver;             ///< cutterFoam
    int jobs = 1;                             ///< replays in parallel
    bool resume = false;
};

/// One replay.
struct Replay {
    std::string name;           ///< of its case folder
    std::filesystem::path run;  ///< whose flow is replayed
    bool is_pair = false;       ///< has the placement of `run`
    std::int64_t seed = 0;      ///< of the first feed
    double start_revolution = 0.0;
    double spillage = 0.0;   ///< as postproc::RockAnswer
    double undecided = 0.0;  ///< share of the placed mass
    double core_s = 0.0;
    std::optional<postproc::FedHead> fed;  ///< of a head that is fed all the time
    std::optional<postproc::Exits> exits;  ///< where rock is spilled
};

struct ReplayResults {
    std::vector<Replay> replays;
    std::vector<postproc::ReplayPair> pairs;  ///< of the runs whose spillage is known
    postproc::ReplayEstimate estimate;
    std::optional<postproc::FedReplays> fed;  ///< of the replays of a head that is fed all the time, without pairs
    std::vector<postproc::Exits> exits;       ///< of the replays in which rock is spilled, without pairs
};

/// The study of a run by the program that ran it: before the key kernel.sampling existed, rock sampled from a shell, and keys that a feed
/// does not use were allowed.
ParameterValues study_as_recorded(ParameterValues study);

/// Whether run_replays has begun in a folder.
bool holds_replays(const std::filesystem::path& folder);

/// Runs every replay and writes replays.csv, replays.json and, where rock is spilled, exits.csv into the folder.
/// \throws UserError    with every run that has no recording or is of another study, with every key of another flow, when the
///                      folder holds replays of other runs or of a study that has changed since, and as RunDirectory
/// \throws ToolError    when a replay fails
/// \throws Interrupted  when the user stops it; finished replays are kept
ReplayResults run_replays(const ReplaySettings& settings, const std::function<void(const std::string&)>& say);

/// Core seconds of all of them.
double cost_of(const std::vector<Replay>& replays);

/// Cells of a table: shares of what is fed that are lost after mixing, where rock is cut, and left behind.
std::string loss_columns(const postproc::Losses& losses);

/// Whether the coupled runs differ from their replays by at most postproc::largest_correction; so does no run at all.
bool is_weakly_coupled(const postproc::ReplayEstimate& estimate);

/// \param replays  for the message \throws CheckFailure  when they are not weakly coupled
void require_weak_coupling(const postproc::ReplayEstimate& estimate, const std::string& replays);

}  // namespace cutterflow::cases
