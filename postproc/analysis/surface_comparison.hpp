#pragma once
/// \file Free-surface runs beside each other: repeats of a setting combined, differences from the first setting in pairs.
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace cutterflow::postproc {

/// Mean of repeats and half of its 95 % interval (Student); NaN where it is not known: fewer than two repeats, or an event that never came.
struct RepeatMean {
    double mean = 0.0, half = 0.0;
};

RepeatMean repeat_mean(const std::vector<double>& values);

/// One quantity of one setting.
struct SurfaceQuantity {
    std::string key, name, unit;
    std::vector<double> each;  ///< of every repeat, infinite when it never came
    RepeatMean mean;
    RepeatMean difference;  ///< from the first setting, of repeats with the same number
};

struct SurfaceSetting {
    std::string name;  ///< the runs' folder without _repeat<n>
    std::vector<int> repeats;
    std::vector<SurfaceQuantity> quantities;
};

/// \throws UserError  when a folder is no run of a free-surface study
std::vector<SurfaceSetting> compare_surface_runs(const std::vector<std::filesystem::path>& runs);

std::string surface_comparison_text(const std::vector<SurfaceSetting>& settings);
nlohmann::json surface_comparison_json(const std::vector<SurfaceSetting>& settings);

/// Writes comparison.json and index.html. \return the page
std::filesystem::path write_surface_comparison(const std::vector<SurfaceSetting>& settings, const std::filesystem::path& folder);

}  // namespace cutterflow::postproc
