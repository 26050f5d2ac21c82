#pragma once
/// \file What the commands that replay do and print.
#include <string>

#include "cases/replay/replay.hpp"

namespace cutterflow::cli {

/// Runs replays. \return the answer's lines
/// \throws CheckFailure  when rock changes the flow more than replays may leave out
/// \throws Interrupted   with the way to go on
std::string replay_lines(const cases::ReplaySettings& settings);

}  // namespace cutterflow::cli
