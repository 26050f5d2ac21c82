#include "postproc/exhibits.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "postproc/palette.hpp"

namespace cutterflow::postproc {
namespace {

constexpr int k_width = 540, k_height = 330;

/// The smallest value above 0, or 1 when there is none.
double smallest_positive(const std::vector<ChartPoint>& points, double ChartPoint::*value) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const ChartPoint& point : points)
        if (point.*value > 0.0) smallest = std::min(smallest, point.*value);
    return smallest < std::numeric_limits<double>::infinity() ? smallest : 1.0;
}

}  // namespace

nlohmann::json exhibits_json(const Exhibits& exhibits) {
    nlohmann::json tables = nlohmann::json::array(), charts = nlohmann::json::array();
    for (const ExhibitTable& table : exhibits.tables) tables.push_back({{"title", table.title}, {"columns", table.columns}, {"rows", table.rows}});
    for (const Chart& chart : exhibits.charts) {
        nlohmann::json points = nlohmann::json::array();
        for (const ChartPoint& point : chart.points)
            points.push_back({{"label", point.label}, {"x", point.x}, {"y", point.y}, {"default", point.standard}});
        charts.push_back({{"title", chart.title}, {"x_axis", chart.x_axis}, {"y_axis", chart.y_axis}, {"points", points}});
    }
    return {{"tables", tables}, {"charts", charts}};
}

Exhibits exhibits_from_json(const nlohmann::json& json) {
    Exhibits exhibits;
    for (const nlohmann::json& table : json.at("tables"))
        exhibits.tables.push_back({table.at("title").get<std::string>(), table.at("columns").get<std::vector<std::string>>(),
                                   table.at("rows").get<std::vector<std::vector<std::string>>>()});
    for (const nlohmann::json& chart : json.at("charts")) {
        Chart read{chart.at("title").get<std::string>(), chart.at("x_axis").get<std::string>(), chart.at("y_axis").get<std::string>(), {}};
        for (const nlohmann::json& point : chart.at("points"))
            read.points.push_back({point.at("label").get<std::string>(), point.at("x").get<double>(), point.at("y").get<double>(),
                                   point.at("default").get<bool>()});
        exhibits.charts.push_back(read);
    }
    return exhibits;
}

PlotScript chart_plot(const Chart& chart, const std::string& name) {
    PlotScript plot{name, k_width, k_height, {}};
    const double least_x = smallest_positive(chart.points, &ChartPoint::x), least_y = smallest_positive(chart.points, &ChartPoint::y);
    std::vector<std::vector<std::string>> all, standard;
    for (const ChartPoint& point : chart.points) {
        const std::vector<std::string> row = {fmt::format("{:.6g}", std::max(point.x, 0.01 * least_x)),
                                              fmt::format("{:.6g}", std::max(point.y, 0.01 * least_y)),
                                              quoted(point.label + (point.standard ? " (default)" : ""))};
        (point.standard ? standard : all).push_back(row);
    }
    plot.commands = data_block("points", all) + data_block("standard", standard);
    plot.commands += fmt::format(
        "set logscale xy\nset offsets graph 0.1, graph 0.25, graph 0.1, graph 0.1\nset xlabel {}\nset ylabel {}\n"
        "unset key\n",
        quoted(chart.x_axis), quoted(chart.y_axis));
    std::vector<std::string> series;
    const auto add = [&](const char* block, const auto& rows, const char* colour, double size) {
        if (rows.empty()) return;
        series.push_back(fmt::format("${0} using 1:2 with points pt 7 ps {1} lc rgb \"{2}\", ${0} using 1:2:3 with labels left offset 0.8,0.3 "
                                     "textcolor rgb \"{3}\"",
                                     block, size, colour, palette::ink));
    };
    add("points", all, palette::outflow, 0.7);
    add("standard", standard, palette::spilled, 1.1);
    plot.commands += fmt::format("plot {}\n", fmt::join(series, ", "));
    return plot;
}

ExhibitTable chart_table(const Chart& chart) {
    ExhibitTable table{chart.title, {"value", chart.x_axis, chart.y_axis}, {}};
    for (const ChartPoint& point : chart.points)
        table.rows.push_back({point.label + (point.standard ? " (default)" : ""), fmt::format("{:.4g}", point.x), fmt::format("{:.3g}", point.y)});
    return table;
}

}  // namespace cutterflow::postproc
