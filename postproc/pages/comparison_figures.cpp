#include "postproc/pages/comparison_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

#include "postproc/analysis/text.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/draw/palette.hpp"
#include "postproc/pages/onset_band.hpp"

namespace cutterflow::postproc {
namespace {

using html::escape;
using nlohmann::json;

/// Colours of settings, in order; told apart with any colour vision.
constexpr const char* k_colours[] = {"#0072b2", "#d55e00", "#00795c", "#a34b86", "#8a6d00", "#26303a", "#56b4e9", "#9aa3ab"};
constexpr int k_width = 540, k_height = 330;
constexpr const char* k_key = "set key outside top center horizontal";

/// A point with its bars.
struct Point {
    std::size_t setting;
    double x, y, y_low, y_high;
    double x_half = 0.0;
};

/// Points of one colour, in the plot's order.
struct Series {
    std::string name;  ///< plain text
    std::string colour;
    std::vector<Point> points;
    bool joined = false;
};

const RunData& first_run(const Comparison& comparison, std::size_t setting) {
    return comparison.runs[comparison.settings[setting].runs.front()].run;
}

/// Bounds when there are some, else the interval, else the value itself.
std::pair<double, double> range_of(const Estimate& estimate) {
    if (estimate.low) return {*estimate.low, *estimate.high};
    const double half = estimate.half_width.value_or(0.0);
    return {*estimate.value - half, *estimate.value + half};
}

PlotRows rows_of(const Series& series) {
    PlotRows rows;  // x, y, low, high, half of the bar in x, its ends
    for (const Point& p : series.points) rows.push_back({p.x, p.y, p.y_low, p.y_high, p.x_half});
    return rows;
}

json differences(const std::vector<Point>& points, double (*difference)(const Point&)) {
    json values = json::array();
    for (const Point& point : points) values.push_back(difference(point));
    return values;
}

/// Markers with bars; the tool tip names the setting.
json markers(const Comparison& comparison, const Series& series, const std::string& tip) {
    json trace = curve(rows_of(series), 0, 1, escape(series.name), series.colour);
    json labels = json::array();
    for (const Point& p : series.points) {
        labels.push_back(fmt::format("setting {}: {}", p.setting + 1, escape(comparison.settings[p.setting].label)));
    }
    trace.update(
        {{"mode", series.joined ? "lines+markers" : "markers"},
         {"text", labels},
         {"marker", {{"size", 8}}},
         {"cliponaxis", false},  // 0 and 100 % are common
         {"hovertemplate", "%{text}<br>" + tip + "<extra></extra>"},
         {"error_y",
          {{"symmetric", false},
           {"width", 4},
           {"thickness", 1.5},
           {"array", differences(series.points, [](const Point& p) { return p.y_high - p.y; })},
           {"arrayminus", differences(series.points, [](const Point& p) { return p.y - p.y_low; })}}},
         {"error_x", {{"width", 0}, {"thickness", 1.2}, {"array", differences(series.points, [](const Point& p) { return p.x_half; })}}}});
    trace["line"]["width"] = 1.2;
    return trace;
}

/// Series of points with bars, both forms.
Plot points_plot(const Comparison& comparison, const std::string& name, const std::vector<Series>& all, const std::string& x_title,
                 const std::string& y_title, const std::string& tip) {
    Plot plot{{name, k_width, k_height, ""}, json::array(), {{"xaxis", axis(x_title)}, {"yaxis", axis(y_title)}, {"hovermode", "closest"}}};
    std::vector<std::string> curves;
    for (std::size_t s = 0; s < all.size(); ++s) {
        const std::string block = fmt::format("series{}", s);
        plot.script.commands += data_block(block, rows_of(all[s]));
        const std::string style = fmt::format("pt {} ps 0.8 lw 1.6 lc rgb \"{}\"", 7 + 2 * (s / 2 % 4), all[s].colour);
        curves.push_back(fmt::format("${} using 1:2:($1-$5):($1+$5):3:4 with xyerrorbars {} title {}", block, style, quoted(all[s].name)));
        if (all[s].joined) curves.push_back(fmt::format("${} using 1:2 with lines lw 1.2 lc rgb \"{}\" notitle", block, all[s].colour));
        plot.traces.push_back(markers(comparison, all[s], tip));
    }
    plot.script.commands +=
        fmt::format("set xlabel {}\nset ylabel {}\nset offsets graph 0.06,graph 0.06,0,0\n{}\n", quoted(x_title), quoted(y_title), k_key);
    // The tics of one colour a setting need no legend of ten rows.
    if (all.size() > 8) plot.script.commands += "unset key\n";
    plot.script.commands += curves.empty() ? "plot NaN notitle\n" : fmt::format("plot {}\n", fmt::join(curves, ", "));
    return plot;
}

void show_percent(Plot& plot) {
    plot.script.commands = "set yrange [0:100]\n" + plot.script.commands;
    plot.layout["yaxis"]["range"] = {0, 100};
}

Point share_point(const Estimate& estimate, std::size_t setting, double x) {
    const auto [low, high] = range_of(estimate);
    return {setting, x, 100.0 * *estimate.value, 100.0 * low, 100.0 * high};
}

constexpr const char* k_share_title = "% by mass";
constexpr const char* k_share_tip = "%{y:.2f} %";

struct Share {
    const char* key;
    const char* name;
    const char* colour;
};
constexpr Share k_shares[] = {{"ratio", "spillage ratio", palette::spilled}, {"production", "production", palette::sucked_up}};

/// Spillage and production, setting by setting.
Plot shares_plot(const Comparison& comparison) {
    std::vector<Series> all;
    double shift = -0.06;
    for (const Share& share : k_shares) {
        Series series{share.name, share.colour, {}};
        const Quantity& quantity = *find_quantity(comparison, share.key);
        for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
            if (quantity.settings[i].value)
                series.points.push_back(share_point(quantity.settings[i], i, static_cast<double>(i + 1) + shift));
        }
        if (!series.points.empty()) all.push_back(series);
        shift = 0.06;
    }
    Plot plot = points_plot(comparison, "shares", all, "setting", k_share_title, k_share_tip);
    const double last = static_cast<double>(comparison.settings.size()) + 0.5;
    plot.script.commands = fmt::format("set xrange [0.5:{}]\nset xtics 1\n", last) + plot.script.commands;
    plot.layout["xaxis"].update({{"range", {0.5, last}}, {"dtick", 1}});
    show_percent(plot);
    return plot;
}

bool varies(const Quantity& quantity) {
    std::set<double> values;
    for (const Estimate& estimate : quantity.settings) {
        if (estimate.value) values.insert(*estimate.value);
    }
    return values.size() > 1;
}

/// What tells the curves of a trend apart: cutter, discharge, mesh, each only where settings differ in it. At one speed the flow number
/// varies with the discharge, along a curve.
std::vector<std::string> groups_of(const Comparison& comparison) {
    using Describe = std::string (*)(const RunData&);
    std::vector<Describe> parts{
        [](const RunData& run) { return std::filesystem::path(run.geometry.value("file", std::string())).filename().string(); },
        [](const RunData& run) { return run.operating_point.mesh_preset.empty() ? "" : run.operating_point.mesh_preset + " mesh"; }};
    if (varies(*find_quantity(comparison, "speed_rpm")))
        parts.push_back([](const RunData& run) { return fmt::format("{:g} m³/s", run.operating_point.discharge); });
    std::vector<std::string> groups(comparison.settings.size());
    for (const Describe part : parts) {
        std::set<std::string> values;
        for (std::size_t i = 0; i < groups.size(); ++i) values.insert(part(first_run(comparison, i)));
        if (values.size() < 2) continue;
        for (std::size_t i = 0; i < groups.size(); ++i) groups[i] += ", " + part(first_run(comparison, i));
    }
    return groups;
}

/// Spillage and production against an operating quantity, a curve for every group of settings.
Plot trend_plot(const Comparison& comparison, const Quantity& operating, const std::string& name, const std::string& x_title) {
    const std::vector<std::string> groups = groups_of(comparison);
    std::map<std::string, std::vector<Series>> by_group;
    for (const Share& share : k_shares) {
        const Quantity& quantity = *find_quantity(comparison, share.key);
        std::map<std::string, Series> series;
        for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
            if (!quantity.settings[i].value || !operating.settings[i].value) continue;
            Series& own = series.emplace(groups[i], Series{share.name + groups[i], share.colour, {}, true}).first->second;
            own.points.push_back(share_point(quantity.settings[i], i, *operating.settings[i].value));
        }
        for (auto& [group, own] : series) {
            std::sort(own.points.begin(), own.points.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
            by_group[group].push_back(own);
        }
    }
    std::vector<Series> all;
    for (const auto& [group, series] : by_group) all.insert(all.end(), series.begin(), series.end());
    Plot plot = points_plot(comparison, name, all, x_title, k_share_title, k_share_tip);
    const char* const symbols[] = {"circle", "diamond", "square", "triangle-up"};
    for (std::size_t s = 0; s < plot.traces.size(); ++s) plot.traces[s]["marker"]["symbol"] = symbols[s / 2 % std::size(symbols)];
    show_percent(plot);
    return plot;
}

std::vector<std::string> bins_of(const Comparison& comparison, const std::string& what, const std::string& unit) {
    std::vector<std::string> names;
    for (const geometry::AxialBin& bin : comparison.runs.front().run.bins) {
        if (find_quantity(comparison, bin_key(what, bin.name, unit))) names.push_back(bin.name);
    }
    return names;
}

/// A quantity of the bins, one curve a setting, down the axis.
Plot bins_plot(const Comparison& comparison, const std::string& what, const std::string& unit, double factor, const std::string& x_title,
               const std::string& tip) {
    const std::vector<std::string> bins = bins_of(comparison, what, unit);
    Plot plot{{what, k_width, 90 + 22 * static_cast<int>(bins.size()), ""},
              json::array(),
              {{"xaxis", axis(x_title)}, {"yaxis", axis("")}, {"legend", {{"title", {{"text", "setting "}}}}}, {"hovermode", "y unified"}}};
    std::vector<std::string> tics, curves;
    json places = json::array(), names = json::array();
    for (std::size_t b = 0; b < bins.size(); ++b) {
        tics.push_back(fmt::format("{} {}", quoted(text::bin_text(bins[b])), -static_cast<int>(b)));
        places.push_back(-static_cast<int>(b));
        names.push_back(text::bin_text(bins[b]));
    }
    for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
        PlotRows rows;
        for (std::size_t b = 0; b < bins.size(); ++b) {
            const Estimate& estimate = find_quantity(comparison, bin_key(what, bins[b], unit))->settings[i];
            if (estimate.value)
                rows.push_back({factor * *estimate.value, -static_cast<double>(b), factor * estimate.half_width.value_or(0.0)});
        }
        if (rows.empty()) continue;
        plot.script.commands += data_block(fmt::format("bins{}", i), rows);
        curves.push_back(
            fmt::format("$bins{} using 1:2:3 with xerrorlines pt 7 ps 0.5 lw 1.4 lc rgb \"{}\" title \"{}\"", i, setting_colour(i), i + 1));
        json trace = curve(rows, 0, 1, fmt::format("{}", i + 1), setting_colour(i));
        trace.update({{"mode", "lines+markers"},
                      {"error_x", {{"array", column(rows, 2)}, {"width", 0}, {"thickness", 1.2}}},
                      {"hovertemplate", tip + " (" + escape(comparison.settings[i].label) + ")"}});
        plot.traces.push_back(trace);
    }
    plot.layout["yaxis"].update({{"tickvals", places}, {"ticktext", names}, {"showgrid", false}, {"zeroline", false}});
    plot.script.commands += fmt::format(
        "set ytics ({}) scale 0\nset yrange [{}:0.6]\nset xlabel {}\n"
        "set arrow 1 from 0,graph 0 to 0,graph 1 nohead lc rgb \"{}\" lw 1\nset key outside top center horizontal title \"setting\"\n",
        fmt::join(tics, ", "), 0.4 - static_cast<double>(bins.size()), quoted(x_title), palette::faint);
    plot.script.commands += curves.empty() ? "plot NaN notitle\n" : fmt::format("plot {}\n", fmt::join(curves, ", "));
    return plot;
}

/// Share of the placed rock from which on a band of the head counts as open to rock.
constexpr double k_open_to_rock = 0.01;

/// The uppermost band below the ring plane through which a hundredth or more of the rock left any head; where there is none, the band at
/// the ring plane. A ring's own steel closes the bands that it reaches over.
std::string top_bin(const Comparison& comparison) {
    std::string at_ring;
    for (const geometry::AxialBin& bin : comparison.runs.front().run.bins) {
        if (bin.z_max > 0.0) continue;
        if (at_ring.empty()) at_ring = bin.name;
        const Quantity* spilled = find_quantity(comparison, bin_key("spilled", bin.name, "share"));
        if (!spilled) continue;
        for (const Estimate& share : spilled->settings)
            if (share.value.value_or(0.0) >= k_open_to_rock) return bin.name;
    }
    return at_ring;
}

Plot top_bin_plot(const Comparison& comparison, const Quantity& spilled, const Quantity& outflow) {
    std::vector<Series> all;
    for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
        const Estimate &x = outflow.settings[i], &y = spilled.settings[i];
        if (!x.value || !y.value) continue;
        Point point = share_point(y, i, *x.value);
        point.x_half = x.half_width.value_or(0.0);
        all.push_back({fmt::format("{}", i + 1), setting_colour(i), {point}});
    }
    Plot plot = points_plot(comparison, "top_bin", all, "mean radial velocity in the top bin, m/s", "spilled there, % of the placed mass",
                            "%{x:.3f} m/s, %{y:.2f} % of the placed mass");
    double highest = 1.0;  // [%]; where nothing is spilled the axis still shows what a little would be
    double slowest = 0.0, fastest = 0.0;
    for (const Series& series : all) {
        const Point& point = series.points.front();
        highest = std::max(highest, 1.1 * point.y_high);
        slowest = std::min(slowest, point.x - point.x_half);
        fastest = std::max(fastest, point.x + point.x_half);
    }
    add_onset_band(plot, slowest, fastest);
    plot.script.commands = fmt::format("set yrange [0:{}]\n", plot_number(highest)) + plot.script.commands;
    plot.layout["yaxis"]["range"] = {0, highest};
    return plot;
}

std::vector<CaptionedPlot> rock_plots(const Comparison& comparison) {
    const std::string shares = "Spillage ratio, spilled / (spilled + sucked up), and production, sucked up / placed, by mass";
    const std::string bars = "; bars are bounds: what the undecided rock could still do.";
    std::vector<CaptionedPlot> plots{{shares_plot(comparison), shares + ", of every setting" + bars}};
    const Quantity &speed = *find_quantity(comparison, "speed_rpm"), &flow_number = *find_quantity(comparison, "flow_number");
    if (varies(speed)) {
        plots.push_back({trend_plot(comparison, speed, "speed", "rotor speed, rpm"), shares + ", against the rotor’s speed" + bars});
    }
    if (varies(flow_number)) {
        plots.push_back({trend_plot(comparison, flow_number, "flow_number", "flow number Q / (ω R³)"),
                         shares + ", against the flow number (discharge Q, rotor speed ω, ring radius R)" + bars});
    }
    const std::string top = top_bin(comparison);
    const Quantity *spilled = find_quantity(comparison, bin_key("spilled", top, "share")),
                   *outflow = find_quantity(comparison, bin_key("outflow", top, "m_s"));
    if (spilled && outflow) {
        plots.push_back(
            {top_bin_plot(comparison, *spilled, *outflow),
             fmt::format("Rock that left the head for the last time in the top bin, the uppermost through which a hundredth or more "
                         "of the rock left any head ({}), against the mean radial velocity just outside it; a colour a setting; "
                         "bars: 95 % intervals where they are known. {}",
                         text::bin_text(top), onset_band_text())});
    }
    plots.push_back({bins_plot(comparison, "spilled", "share", 100.0, "spilled, % of the placed mass", "%{x:.2f} %"),
                     "Spilled mass by the axial bin of the last exit (distance below the ring; “gap” lies between ring and backplate)."});
    return plots;
}

}  // namespace

const char* setting_colour(std::size_t setting) {
    return k_colours[setting % std::size(k_colours)];
}

const Quantity* find_quantity(const Comparison& comparison, const std::string& key) {
    const auto found =
        std::find_if(comparison.quantities.begin(), comparison.quantities.end(), [&](const Quantity& q) { return q.key == key; });
    return found == comparison.quantities.end() ? nullptr : &*found;
}

std::vector<CaptionedPlot> comparison_plots(const Comparison& comparison) {
    std::vector<CaptionedPlot> plots;
    if (find_quantity(comparison, "ratio")) plots = rock_plots(comparison);
    if (bins_of(comparison, "outflow", "m_s").empty()) return plots;
    plots.push_back(
        {bins_plot(comparison, "outflow", "m_s", 1.0, "mean radial velocity, m/s (outwards positive)", "%{x:.3f} m/s"),
         "Radial velocity just outside the contour by axial bin, averaged over azimuth and time; bars: 95 % interval by batch means."});
    return plots;
}

}  // namespace cutterflow::postproc
