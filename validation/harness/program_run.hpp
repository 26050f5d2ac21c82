#pragma once
/// \file Studies run through the program, as by a user, for cases that check the program as a whole.
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "geometry/base/process/child_process.hpp"

namespace cutterflow::validation {

/// Runs the cutterflow of this installation in a folder (created if missing), its output in log.<command> there.
/// \throws ToolError  with the end of the log when it fails
ChildResult run_cutterflow(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

/// Runs study.toml of a folder to its report in run/ there; resumes an interrupted run.
/// \param start_from  a run directory whose frozen-rotor flow is taken if it is the same; empty: none
/// \return report/results.json
nlohmann::json run_study(const std::filesystem::path& folder, const std::filesystem::path& start_from = {});

/// Core seconds of a stage of a run, from its manifest.
double stage_core_s(const std::filesystem::path& run, const std::string& stage);

}  // namespace cutterflow::validation
