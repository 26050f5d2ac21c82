#pragma once
/// \file Runs beside each other by settings: repeats of a setting combined, differences from the first setting in pairs.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace cutterflow::postproc {

/// Mean of repeats and half of its 95 % interval (Student); NaN where it is not known: fewer than two repeats, or an event that never came.
struct RepeatMean {
    double mean = 0.0, half = 0.0;
};

RepeatMean repeat_mean(const std::vector<double>& values);

/// What the interval of a difference says: "higher" or "lower" when it leaves 0 out, "not told apart" when it holds 0, "no interval"
/// without one.
std::string verdict_of(const RepeatMean& difference);

/// One quantity of one setting.
struct SettingQuantity {
    std::string key, name, unit;
    bool zero_is_nothing = false;
    std::vector<double> each;  ///< of every repeat, infinite when it never came
    RepeatMean mean;
    RepeatMean difference;  ///< from the first setting, of repeats with the same number
    std::string reason{};   ///< why a run has no value
};

struct SettingResults {
    std::string name;  ///< the runs' folder without _repeat<n>
    std::vector<int> repeats;
    std::vector<SettingQuantity> quantities;
};

/// A quantity of one run.
struct RunQuantity {
    std::string key, name, unit;
    double value = 0.0;
    bool zero_is_nothing = false;  ///< a value of 0 in all runs is not shown
    std::string reason{};          ///< why there is no value
};

/// \param quantities_of  a run: the same ones of every run
/// \throws UserError  when runs have other quantities than the first
std::vector<SettingResults> compare_settings(const std::vector<std::filesystem::path>& runs,
                                             const std::function<std::vector<RunQuantity>(const std::filesystem::path&)>& quantities_of);

std::string setting_comparison_text(const std::vector<SettingResults>& settings);
/// \param schema  its name, as "cutterflow.surface_comparison/1"
nlohmann::json setting_comparison_json(const std::vector<SettingResults>& settings, const std::string& schema);

/// Writes comparison.json and index.html. \return the page
std::filesystem::path write_setting_comparison(const std::vector<SettingResults>& settings, const std::string& schema,
                                               const std::filesystem::path& folder);

}  // namespace cutterflow::postproc
