#pragma once
/// \file A run that is killed, as a machine that goes down kills it.
#include <filesystem>
#include <string>
#include <vector>

namespace cutterflow::validation {

/// Starts cutterFoam in a case, kills it and all its ranks shortly after it has written `checkpoint` (a folder of checkpoints/), and
/// removes what lies after it, so that cutterFoam goes on from there. With ranks > 1 the case is decomposed.
/// \throws std::runtime_error  when the run ended before, or never wrote that checkpoint
void run_and_kill_after(const std::filesystem::path& folder, const std::string& checkpoint, int ranks);

/// Lines of a table of all starts of a run (`postProcessing/<name>/<start>/<file>`), in order, without headers.
std::vector<std::string> rows_of_all_starts(const std::filesystem::path& tables, const std::string& file);

}  // namespace cutterflow::validation
