#pragma once
/// \file What a verification case shows beside its quantities: tables, and charts of error against cost.
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "postproc/draw/plot.hpp"

namespace cutterflow::validation {

struct ExhibitTable {
    std::string title;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

struct ChartPoint {
    std::string label;  ///< the option's value
    double x = 0.0, y = 0.0;
    bool standard = false;  ///< the program's default
};

/// Points on two logarithmic axes.
struct Chart {
    std::string title;  ///< the option
    std::string x_axis, y_axis;
    std::vector<ChartPoint> points;
};

struct Exhibits {
    std::vector<ExhibitTable> tables;
    std::vector<Chart> charts;
    bool empty() const { return tables.empty() && charts.empty(); }
};

nlohmann::json exhibits_json(const Exhibits& exhibits);
/// \throws nlohmann::json::exception  when the JSON is not what exhibits_json makes
Exhibits exhibits_from_json(const nlohmann::json& json);

/// `name` as Plot has it. An error of 0 has no place on a logarithmic axis: it stands at a hundredth of the smallest other
/// one.
postproc::Plot chart_plot(const Chart& chart, const std::string& name);

/// The chart's numbers, for pages without pictures.
ExhibitTable chart_table(const Chart& chart);

}  // namespace cutterflow::validation
