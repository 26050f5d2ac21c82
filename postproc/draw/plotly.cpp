#include "postproc/draw/plotly.hpp"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "postproc/draw/html.hpp"

namespace cutterflow::postproc {
namespace {

using html::escape;
using nlohmann::json;

/// A number with six significant digits, as gnuplot gets it; NaN is null.
json number(double value) {
    return std::isfinite(value) ? json(std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr)) : json(nullptr);
}

json numbers(const std::vector<double>& values) {
    json all = json::array();
    for (const double value : values) all.push_back(number(value));
    return all;
}

json escaped(const std::vector<std::string>& texts) {
    json all = json::array();
    for (const std::string& text : texts) all.push_back(escape(text));
    return all;
}

const char* symbol(Mark mark) {
    switch (mark) {
        case Mark::ring:
            return "circle-open";
        case Mark::square:
            return "square";
        case Mark::open_square:
            return "square-open";
        case Mark::diamond:
            return "diamond";
        case Mark::open_diamond:
            return "diamond-open";
        case Mark::triangle:
            return "triangle-up";
        case Mark::open_triangle:
            return "triangle-up-open";
        case Mark::triangle_down:
            return "triangle-down";
        case Mark::cross:
            return "x-thin-open";
        case Mark::plus:
            return "cross-thin-open";
        case Mark::disc:
        case Mark::none:
            break;
    }
    return "circle";
}

/// A value in a tool tip. \param variable  plotly's name of it
std::string tip_value(const TipFormat& tip, const std::string& variable) {
    return tip.digits.empty() ? "" : fmt::format("{}%{{{}:{}}}{}", escape(tip.before), variable, tip.digits, escape(tip.after));
}

std::string joined(const std::string& first, const std::string& separator, const std::string& second) {
    return first.empty() ? second : second.empty() ? first : first + separator + second;
}

json line(const std::string& colour, double width, bool dashed = false) {
    return {{"color", colour}, {"width", width}, {"dash", dashed ? "dash" : "solid"}};
}

/// Error bars between their ends.
json error_bars(const std::vector<double>& at, const std::vector<double>& low, const std::vector<double>& high) {
    json above = json::array(), below = json::array();
    for (std::size_t i = 0; i < at.size(); ++i) {
        above.push_back(number(high[i] - at[i]));
        below.push_back(number(at[i] - low[i]));
    }
    return {{"type", "data"}, {"symmetric", false}, {"array", above}, {"arrayminus", below}, {"width", 3}, {"thickness", 1.4}};
}

class Traces {
public:
    explicit Traces(const Plot& plot) : plot_(plot) {}
    json all();

private:
    void add(const Field& field);
    void add(const Polygon& polygon);
    void add(const Area& area);
    void add(const Bar& bar);
    void add(const Series& series);
    std::string tip(const Series& series) const;

    const Plot& plot_;
    json traces_ = json::array();
};

void Traces::add(const Field& field) {
    json scale = json::array();
    const double last = static_cast<double>(std::size(palette::field) - 1);
    for (const char* colour : palette::field) scale.push_back({static_cast<double>(scale.size()) / last, colour});
    traces_.push_back(
        {{"type", "heatmap"},
         {"x", numbers(field.x)},
         {"y", numbers(field.y)},
         {"z", numbers(field.value)},
         {"zmin", 0},
         {"zmax", number(field.darkest)},
         {"colorscale", scale},
         {"hoverongaps", false},
         {"colorbar", {{"title", {{"text", escape(field.unit)}}}, {"thickness", 12}, {"outlinewidth", 0}}},
         {"hovertemplate", joined(joined(tip_value(plot_.x.tip, "x"), ", ", tip_value(plot_.y.tip, "y")), ": ", tip_value(field.tip, "z")) +
                               "<extra></extra>"}});
}

void Traces::add(const Polygon& polygon) {
    traces_.push_back({{"type", "scatter"},
                       {"mode", "lines"},
                       {"fill", "toself"},
                       {"x", numbers(polygon.x)},
                       {"y", numbers(polygon.y)},
                       {"line", line(polygon.colour, 0)},
                       {"fillcolor", polygon.colour},
                       {"hoverinfo", "skip"},
                       {"showlegend", false}});
}

/// Two curves; the second one fills the room to the first.
void Traces::add(const Area& area) {
    json heights = json::array();
    for (std::size_t i = 0; i < area.x.size(); ++i) heights.push_back({number(area.low[i]), number(area.high[i] - area.low[i])});
    traces_.push_back({{"type", "scatter"},
                       {"mode", "lines"},
                       {"x", numbers(area.x)},
                       {"y", numbers(area.low)},
                       {"line", line(area.colour, 0)},
                       {"hoverinfo", "skip"},
                       {"showlegend", false}});
    const std::string height = tip_value(plot_.y.tip, "customdata[1]"),
                      borders = tip_value(plot_.y.tip, "customdata[0]") + " – " + tip_value(plot_.y.tip, "y");
    traces_.push_back({{"type", "scatter"},
                       {"mode", "lines"},
                       {"x", numbers(area.x)},
                       {"y", numbers(area.high)},
                       {"name", escape(area.name)},
                       {"line", line(area.colour, 0)},
                       {"fill", "tonexty"},
                       {"fillcolor", area.colour},
                       {"customdata", heights},
                       {"hovertemplate", area.stacked ? height : borders}});
}

void Traces::add(const Bar& bar) {
    traces_.push_back({{"type", "bar"},
                       {"orientation", "h"},
                       {"base", {number(bar.from)}},
                       {"x", {number(bar.to - bar.from)}},
                       {"y", {number(bar.at)}},
                       {"width", {number(bar.thickness)}},
                       {"marker", {{"color", bar.colour}}},
                       {"text", {escape(bar.label)}},
                       {"textposition", "inside"},
                       {"insidetextanchor", "middle"},
                       {"textangle", 0},
                       {"textfont", {{"color", bar.label_colour}, {"size", 14}}},
                       {"showlegend", false},
                       {"customdata", {escape(bar.tip)}},
                       {"hovertemplate", "%{customdata}<extra></extra>"}});
}

std::string Traces::tip(const Series& series) const {
    const Axis& x_axis = series.upper_axis && plot_.upper_x ? *plot_.upper_x : plot_.x;
    const std::string x = tip_value(x_axis.tip, "x"), y = tip_value(plot_.y.tip, "y");
    if (plot_.tips != Tips::at_point) return (plot_.tips == Tips::at_x ? y : x) + (series.point_names.empty() ? "" : " (%{text})");
    const std::string head = joined(series.point_names.empty() ? "" : "%{text}", ", ", escape(series.name));
    return joined(head, "<br>", joined(x, ", ", y)) + "<extra></extra>";
}

void Traces::add(const Series& series) {
    if (series.x.empty()) return;
    const bool has_line = series.line_width > 0.0, only_felt = !has_line && series.mark == Mark::none;
    json trace{{"type", "scatter"},
               {"mode", has_line && series.mark != Mark::none ? "lines+markers"
                        : has_line                            ? "lines"
                                                              : "markers"},
               {"x", numbers(series.x)},
               {"y", numbers(series.y)},
               {"name", escape(series.name)},
               {"showlegend", !series.name.empty()},
               {"line", line(series.colour, series.line_width, series.dashed)},
               {"marker", {{"symbol", symbol(series.mark)}, {"size", only_felt ? 24.0 : series.mark_size}, {"color", series.colour}}}};
    if (only_felt) trace["marker"]["opacity"] = 0;
    if (series.mark != Mark::none) trace["cliponaxis"] = false;  // marks at 0 and 100 % are common
    if (series.upper_axis) trace["xaxis"] = "x2";
    if (!series.x_low.empty()) trace["error_x"] = error_bars(series.x, series.x_low, series.x_high);
    if (!series.y_low.empty()) trace["error_y"] = error_bars(series.y, series.y_low, series.y_high);
    if (!series.point_names.empty()) trace["text"] = escaped(series.point_names);
    if (is_named(series)) {
        trace["hovertemplate"] = tip(series);
    } else {
        trace["hoverinfo"] = "skip";
    }
    traces_.push_back(trace);
}

json Traces::all() {
    if (plot_.field) add(*plot_.field);
    for (const Polygon& polygon : plot_.polygons) add(polygon);
    for (const Area& area : plot_.areas) add(area);
    for (const Bar& bar : plot_.bars) add(bar);
    for (const Series& series : plot_.series) add(series);
    return traces_;
}

json axis_layout(const Axis& axis) {
    json layout{
        {"title", {{"text", escape(axis.title)}}}, {"visible", axis.visible}, {"showgrid", axis.grid}, {"zeroline", axis.zero_line}};
    const auto end = [&](const std::optional<double>& value) {
        return value ? number(axis.logarithmic ? std::log10(*value) : *value) : json(nullptr);
    };
    if (axis.from || axis.to) layout["range"] = {end(axis.from), end(axis.to)};
    if (axis.logarithmic) layout.update({{"type", "log"}, {"exponentformat", "power"}});
    if (axis.step) layout["dtick"] = number(axis.logarithmic ? std::log10(*axis.step) : *axis.step);
    if (!axis.ticks.empty()) {
        json places = json::array(), texts = json::array();
        for (const Tick& tick : axis.ticks) {
            places.push_back(number(tick.at));
            texts.push_back(escape(tick.text));
        }
        layout.update({{"tickvals", places}, {"ticktext", texts}});
    }
    if (!axis.tick_suffix.empty()) layout["ticksuffix"] = axis.tick_suffix;
    if (axis.colour != palette::ink) layout["color"] = axis.colour;
    return layout;
}

json annotation(const Text& text) {
    return {{"text", escape(text.text)},
            {"x", number(text.x)},
            {"y", number(text.y)},
            {"showarrow", false},
            {"font", {{"color", text.colour}, {"size", text.size}}}};
}

void add_band(json& layout, const Band& band) {
    layout["shapes"].push_back({{"type", "rect"},
                                {"layer", "below"},
                                {"yref", "paper"},
                                {"x0", band.from},
                                {"x1", band.to},
                                {"y0", 0},
                                {"y1", 1},
                                {"line", {{"width", 0}}},
                                {"fillcolor", band.colour}});
    json label = annotation({band.label, 0.5 * (band.from + band.to), 0.97, palette::ink, 11.0});
    label.update({{"yref", "paper"}, {"yanchor", "top"}, {"textangle", -90}});
    layout["annotations"].push_back(label);
}

void add_circle(json& layout, const Circle& circle) {
    layout["shapes"].push_back({{"type", "circle"},
                                {"layer", "below"},
                                {"x0", -circle.radius},
                                {"x1", circle.radius},
                                {"y0", -circle.radius},
                                {"y1", circle.radius},
                                {"line", {{"color", circle.colour}, {"width", 1}}}});
}

json layout_of(const Plot& plot) {
    static const char* const k_hover[] = {"x unified", "y unified", "closest"};
    json layout{{"height", plot.height},        {"hovermode", k_hover[static_cast<int>(plot.tips)]},
                {"barmode", "overlay"},         {"showlegend", plot.legend != Legend::none},
                {"xaxis", axis_layout(plot.x)}, {"yaxis", axis_layout(plot.y)},
                {"shapes", json::array()},      {"annotations", json::array()}};
    if (plot.legend == Legend::right)
        layout["legend"] = {{"orientation", "v"}, {"x", 1.02}, {"xanchor", "left"}, {"y", 1.0}, {"yanchor", "top"}};
    if (!plot.legend_title.empty()) layout["legend"]["title"] = {{"text", escape(plot.legend_title) + " "}};
    if (plot.upper_x) {
        layout["xaxis2"] = axis_layout(*plot.upper_x);
        layout["xaxis2"].update({{"overlaying", "x"}, {"side", "top"}, {"showgrid", false}});
        if (plot.upper_x->ticks.empty()) layout["xaxis2"]["tickmode"] = "auto";  // its own round numbers, not those below
        layout["margin"] = {{"t", 48}};
    }
    if (plot.equal_scales) {
        layout["xaxis"]["constrain"] = "domain";
        layout["yaxis"].update({{"scaleanchor", "x"}, {"constrain", "domain"}});
    }
    if (!plot.y.visible) {
        layout["margin"] = {{"t", 4}, {"b", plot.x.visible ? 24 : 4}, {"l", 24}, {"r", 24}};
        layout["xaxis"]["fixedrange"] = layout["yaxis"]["fixedrange"] = true;
    }
    for (const Band& band : plot.bands) add_band(layout, band);
    for (const Circle& circle : plot.circles) add_circle(layout, circle);
    for (const Text& text : plot.texts) layout["annotations"].push_back(annotation(text));
    return layout;
}

}  // namespace

json plotly_figure(const Plot& plot) {
    return {{"data", Traces(plot).all()}, {"layout", layout_of(plot)}};
}

}  // namespace cutterflow::postproc
