#pragma once
/// \file Runs beside each other by settings: repeats of a setting combined, differences from the first setting in pairs.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace cutterflow::postproc {

/// Mean of repeats and half of its 95 % interval (Student); NaN where it is not known: fewer than k_fewest_repeats, or an event that never
/// came.
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
    RepeatMean difference;      ///< from the first setting: in pairs where both have the same seeds, else of independent repeats
    std::string reason{};       ///< why a run has no value
    std::size_t known() const;  ///< repeats with a value
};

struct SettingResults {
    /// The first run's folder without _repeat<n>, and that above it where two settings share the name; then, where they still share it,
    /// the files in which they differ.
    std::string name;
    std::vector<std::string> repeats;  ///< their seeds, as "1", of several tables "1, 2"
    std::vector<SettingQuantity> quantities;
    std::vector<std::string> warnings{};  ///< of its runs
};

/// A quantity of one run.
struct RunQuantity {
    std::string key, name, unit;
    double value = 0.0;
    bool zero_is_nothing = false;  ///< a value of 0 in all runs is not shown
    std::string reason{};          ///< why there is no value
};

/// Runs whose studies differ in name and seeds alone, however their values are written, and name files of equal content (by the manifest's
/// hashes), are repeats of one setting, whatever their folders are called. \param study_file  name of the study in a run; a run without it
/// has the setting of its folder's name \param quantities_of  a run: the same ones of every run \param warning_of  a run: what a reader of
/// its quantities has to know, or nothing \throws UserError  when runs have other quantities than the first, or a run comes twice: by its
/// path, as a copy, or with the same study, files and seeds; when a study is not TOML
std::vector<SettingResults> compare_settings(const std::vector<std::filesystem::path>& runs, const std::string& study_file,
                                             const std::function<std::vector<RunQuantity>(const std::filesystem::path&)>& quantities_of,
                                             const std::function<std::string(const std::filesystem::path&)>& warning_of = nullptr);

/// The warning of a run that has not come to its end. \param reached, end  [s]
std::string unfinished_text(const std::filesystem::path& run, double reached, double end);

std::string setting_comparison_text(const std::vector<SettingResults>& settings);
/// \param schema  its name, as "cutterflow.surface_comparison/1"
nlohmann::json setting_comparison_json(const std::vector<SettingResults>& settings, const std::string& schema);

/// Writes comparison.json and index.html. \return the page
std::filesystem::path write_setting_comparison(const std::vector<SettingResults>& settings, const std::string& schema,
                                               const std::filesystem::path& folder);

}  // namespace cutterflow::postproc
