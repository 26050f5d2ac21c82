#pragma once
/// \file The report of a room's run: report/results.json and report/index.html; runs of rooms beside each other.
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "postproc/analysis/settings/setting_comparison.hpp"

namespace cutterflow::postproc {

/// What the room is, written when the run is set up: name, size_m, gravity_m_s2, medium, end_s, seed, bed, grains, solids.
inline constexpr const char* k_room_file = "room.json";

/// Whether a run directory is one of a room's study.
bool is_room_run(const std::filesystem::path& run_directory);

/// Makes the measures of a run anew and writes its page, finished or not. Without gnuplot the page has numbers and pictures but no plots.
/// \return the page
/// \throws UserError  when nothing was computed yet or a file breaks its contract
std::filesystem::path write_room_report(const std::filesystem::path& run_directory);

/// That a run has not come to its end, and how far it has come; empty of one that has, or that keeps no record of its steps.
std::string unfinished_room(const std::filesystem::path& run_directory);

/// Settings by their measures. A measure without a value is unknown for its setting.
/// \throws UserError  when a folder is no run of a room, or has no measures, or other ones than the first
std::vector<SettingResults> compare_room_runs(const std::vector<std::filesystem::path>& runs);
nlohmann::json room_comparison_json(const std::vector<SettingResults>& settings);
/// Writes comparison.json and index.html. \return the page
std::filesystem::path write_room_comparison(const std::vector<SettingResults>& settings, const std::filesystem::path& folder);

}  // namespace cutterflow::postproc
