#pragma once
/// \file Free-surface runs beside each other.
#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "postproc/analysis/settings/setting_comparison.hpp"

namespace cutterflow::postproc {

/// Name of the study in the run of a scene.
inline constexpr const char* k_surface_study = "scene.toml";

/// \throws UserError  when a folder is no run of a free-surface study
std::vector<SettingResults> compare_surface_runs(const std::vector<std::filesystem::path>& runs);

nlohmann::json surface_comparison_json(const std::vector<SettingResults>& settings);

/// Writes comparison.json and index.html. \return the page
std::filesystem::path write_surface_comparison(const std::vector<SettingResults>& settings, const std::filesystem::path& folder);

}  // namespace cutterflow::postproc
