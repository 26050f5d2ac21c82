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

constexpr std::array k_marks{postproc::Mark::square,  postproc::Mark::triangle,    postproc::Mark::triangle_down,
                             postproc::Mark::diamond, postproc::Mark::open_square, postproc::Mark::ring};

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

/// A logarithmic axis with ticks at 1, 2 and 5 times the powers of ten.
postproc::Axis log_axis(const std::string& title, double low, double high) {
    postproc::Axis axis;
    axis.title = title;
    axis.logarithmic = true;
    axis.from = low;
    axis.to = high;
    for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high; decade *= 10.0)
        for (const double factor : {1.0, 2.0, 5.0})
            if (factor * decade >= low && factor * decade <= high)
                axis.ticks.push_back({factor * decade, fmt::format("{:g}", factor * decade)});
    return axis;
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

postproc::Plot chart_plot(const Chart& chart, const std::string& name) {
    postproc::Plot plot;
    plot.name = name;
    plot.legend = postproc::Legend::right;
    const double least_x = smallest_positive(chart.points, &ChartPoint::x), least_y = smallest_positive(chart.points, &ChartPoint::y);
    double low[2] = {least_x, least_y}, high[2] = {least_x, least_y};
    for (const ChartPoint& point : chart.points) {
        const double place[2] = {std::max(point.x, 0.01 * least_x), std::max(point.y, 0.01 * least_y)};
        for (int axis = 0; axis < 2; ++axis) {
            low[axis] = std::min(low[axis], place[axis]);
            high[axis] = std::max(high[axis], place[axis]);
        }
        postproc::Series series{
            label_text(point), point.standard ? postproc::palette::spilled : postproc::palette::outflow, {place[0]}, {place[1]}};
        series.mark = point.standard ? postproc::Mark::disc : k_marks[plot.series.size() % k_marks.size()];
        series.mark_size = point.standard ? 11.0 : 8.0;
        plot.series.push_back(series);
    }
    // At least half a decade of error, so that agreement of points is visible.
    const double middle = std::sqrt(low[1] * high[1]), reach = std::max(std::sqrt(high[1] / low[1]) * 1.3, 1.8);
    plot.x = log_axis(chart.x_axis, low[0] / 1.5, high[0] * 1.5);
    plot.y = log_axis(chart.y_axis, middle / reach, middle * reach);
    return plot;
}

ExhibitTable chart_table(const Chart& chart) {
    ExhibitTable table{chart.title, {"value", chart.x_axis, chart.y_axis}, {}};
    for (const ChartPoint& point : chart.points)
        table.rows.push_back({label_text(point), fmt::format("{:.4g}", point.x), fmt::format("{:.3g}", point.y)});
    return table;
}

}  // namespace cutterflow::validation
