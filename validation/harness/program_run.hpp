#pragma once
/// \file Studies run through the program itself, as a user would, for cases that ask what comes out of it as a whole.
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "geometry/base/child_process.hpp"

namespace cutterflow::validation {

/// Runs the built cutterflow in a folder (made when it is not there), its output in log.<command> there.
/// \throws ToolError  with the end of the log when it fails
ChildResult run_cutterflow(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

/// Takes study.toml of a folder to its report in run/ there; goes on where an earlier start was stopped.
/// \param start_from  a run directory whose frozen-rotor flow is taken if it is the same; empty: none
/// \return report/results.json
nlohmann::json run_study(const std::filesystem::path& folder, const std::filesystem::path& start_from = {});

/// Core seconds of a stage of a run, from its manifest.
double stage_core_s(const std::filesystem::path& run, const std::string& stage);

}  // namespace cutterflow::validation
