#include "validation/harness/suite/exhibits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "postproc/draw/palette.hpp"

namespace cutterflow::validation {
namespace {

constexpr int k_width = 540, k_height = 330;
constexpr std::array<int, 6> k_marks = {5, 9, 11, 13, 4, 6};  // gnuplot's numbers of filled and open shapes other than the default's disc

std::string label_text(const ChartPoint& point) {
    return point.label + (point.standard ? " (default)" : "");
}

/// The smallest value above 0, or 1 when there is none.
double smallest_positive(const std::vector<ChartPoint>& points, double ChartPoint::*value) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const ChartPoint& point : points)
        if (point.*value > 0.0) smallest = std::min(smallest, point.*value);
    return smallest < std::numeric_limits<double>::infinity() ? smallest : 1.0;
}

/// Marks of a logarithmic axis at 1, 2 and 5 times the powers of ten: gnuplot's own leave out all but the powers.
std::string log_tics(double low, double high) {
    std::vector<std::string> tics;
    for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high; decade *= 10.0)
        for (const double factor : {1.0, 2.0, 5.0})
            if (factor * decade >= low && factor * decade <= high) tics.push_back(fmt::format("{:.6g}", factor * decade));
    return fmt::format("({})", fmt::join(tics, ", "));
}

}  // namespace

nlohmann::json exhibits_json(const Exhibits& exhibits) {
    nlohmann::json tables = nlohmann::json::array(), charts = nlohmann::json::array();
    for (const ExhibitTable& table : exhibits.tables)
        tables.push_back({{"title", table.title}, {"columns", table.columns}, {"rows", table.rows}});
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

postproc::PlotScript chart_plot(const Chart& chart, const std::string& name) {
    postproc::PlotScript plot{name, k_width, k_height, {}};
    const double least_x = smallest_positive(chart.points, &ChartPoint::x), least_y = smallest_positive(chart.points, &ChartPoint::y);
    std::vector<std::vector<std::string>> rows;
    std::vector<std::string> series;
    double low[2] = {least_x, least_y}, high[2] = {least_x, least_y};
    for (const ChartPoint& point : chart.points) {
        const double place[2] = {std::max(point.x, 0.01 * least_x), std::max(point.y, 0.01 * least_y)};
        for (int axis = 0; axis < 2; ++axis) {
            low[axis] = std::min(low[axis], place[axis]);
            high[axis] = std::max(high[axis], place[axis]);
        }
        const std::size_t i = rows.size();
        rows.push_back({fmt::format("{:.6g}", place[0]), fmt::format("{:.6g}", place[1])});
        series.push_back(fmt::format("$points every ::{0}::{0} using 1:2 with points pt {1} ps {2} lc rgb \"{3}\" title {4}", i,
                                     point.standard ? 7 : k_marks[i % k_marks.size()], point.standard ? 1.1 : 0.8,
                                     point.standard ? postproc::palette::spilled : postproc::palette::outflow,
                                     postproc::quoted(label_text(point))));
    }
    // At least half a decade of error, so that agreement of points is visible.
    const double middle = std::sqrt(low[1] * high[1]), reach = std::max(std::sqrt(high[1] / low[1]) * 1.3, 1.8);
    plot.commands = postproc::data_block("points", rows);
    plot.commands += fmt::format(
        "set logscale xy\nset xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]\nset xlabel {}\nset ylabel {}\n"
        "set xtics {}\nset ytics {}\nset format \"%g\"\nset key outside right top Left reverse\nplot {}\n",
        low[0] / 1.5, high[0] * 1.5, middle / reach, middle * reach, postproc::quoted(chart.x_axis), postproc::quoted(chart.y_axis),
        log_tics(low[0] / 1.5, high[0] * 1.5), log_tics(middle / reach, middle * reach), fmt::join(series, ", "));
    return plot;
}

ExhibitTable chart_table(const Chart& chart) {
    ExhibitTable table{chart.title, {"value", chart.x_axis, chart.y_axis}, {}};
    for (const ChartPoint& point : chart.points)
        table.rows.push_back({label_text(point), fmt::format("{:.4g}", point.x), fmt::format("{:.3g}", point.y)});
    return table;
}

}  // namespace cutterflow::validation
