#pragma once
/// \file What the solver wrote of itself in all starts of a run: a run that was stopped and resumed has several.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cutterflow::postproc {

/// What the solver warned of in all starts of a run or of a part of a room's preparation. \throws UserError  when a cost.json breaks its
/// contract
std::vector<std::string> solver_warnings(const std::filesystem::path& run);

/// Those that came first, ten at most and how many more there are: a run can have very many.
std::vector<std::string> first_warnings(std::vector<std::string> warnings);

/// Processor time of all ranks over all starts of a run [s], as their cost.json have it. A start that did not come to its end has none: its
/// part is the wall time of its steps times the ranks of the last start that told its own. Of a start whose tables another one replaced it
/// is what was noted then (geometry/base/statistics/replaced_starts.hpp).
/// \return nothing while no start came to its end
/// \throws UserError  when a cost.json, a cost.csv or replaced_starts.csv breaks its contract
std::optional<double> solver_core_seconds(const std::filesystem::path& run);

}  // namespace cutterflow::postproc
