#pragma once
/// \file What the commands that replay do and print.
#include <filesystem>
#include <string>
#include <vector>

namespace cutterflow::cli {

/// Runs replays on all cores (cases::ReplaySettings has the parameters). \return the answer's lines
/// \throws CheckFailure  when rock changes the flow more than replays may leave out
/// \throws Interrupted   with the way to go on
std::string replay_lines(const std::vector<std::filesystem::path>& runs, const std::filesystem::path& study, int count,
                         const std::filesystem::path& folder, bool resume);

}  // namespace cutterflow::cli
