#pragma once
/// \file Velocities at named points against speed, over the runs of a sweep.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "postproc/draw/page.hpp"

namespace cutterflow::postproc {

/// A component at a point over the runs, by increasing speed.
struct AdvTrendValue {
    double speed_rpm = 0.0, discharge = 0.0;
    std::optional<double> measured, model, position_bar;  ///< [m/s]
};
struct AdvTrend {
    std::string point, component;
    std::vector<AdvTrendValue> values;
};

/// From the report/adv.json of those runs that have one; only points that two or more of them name, at two or more speeds.
std::vector<AdvTrend> read_adv_trends(const std::vector<std::filesystem::path>& run_directories);

/// A section of the comparison's page: one plot a point, model as lines, measurement as marks; and the table. Empty without trends.
std::string adv_trend_section(const std::vector<AdvTrend>& trends, const Page& page);

nlohmann::json adv_trend_json(const std::vector<AdvTrend>& trends);

}  // namespace cutterflow::postproc
