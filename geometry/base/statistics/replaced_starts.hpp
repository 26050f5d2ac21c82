#pragma once
/// \file What those starts of a run took whose tables are gone: replaced_starts.csv of a run directory. A start that goes on from the same
/// time as one before writes its tables anew; a run that begins anew loses all of them.
#include <filesystem>

namespace cutterflow {

/// Notes what a start took, before its tables are removed or written anew: the processor time in its cost.json, without which the wall
/// time of the steps in its cost.csv times `ranks`. One that made no step is not noted.
/// \param start  its folder postProcessing/cost/<t0>, which need not be there
/// \throws NotWritten
void note_replaced_start(const std::filesystem::path& case_folder, const std::filesystem::path& start, int ranks);

/// Processor time of all ranks in the starts that were noted [s]. \throws UserError  with every mistake in the file
double replaced_core_seconds(const std::filesystem::path& case_folder);

}  // namespace cutterflow
