#pragma once
/// \file What the commands that replay do and print.
#include <filesystem>
#include <string>
#include <vector>

#include "cases/replay/replay.hpp"

namespace cutterflow::cli {

struct ReplayAnswer {
    cases::ReplayResults results;
    std::string lines;
};

/// Runs replays on all cores (cases::ReplaySettings has the parameters).
/// \throws as cases::run_replays, Interrupted with the way to go on
ReplayAnswer replay_answer(const std::vector<std::filesystem::path>& runs, const std::filesystem::path& study, int count,
                           const std::filesystem::path& folder, bool resume);

}  // namespace cutterflow::cli
