#include "postproc/pages/figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "postproc/analysis/text.hpp"
#include "postproc/draw/palette.hpp"
#include "postproc/pages/onset_band.hpp"

namespace cutterflow::postproc {
namespace {

using nlohmann::json;

constexpr std::size_t k_points = 500;  ///< of a curve over time; more cannot be seen
constexpr double k_bins_per_revolution = 100.0;
constexpr int k_sectors = 24;
constexpr double k_gap = std::numeric_limits<double>::quiet_NaN();  ///< breaks a curve
constexpr int k_wide = 1116, k_half = 540, k_height = 330;          ///< as large as the page shows them, so that letters have their size

/// A horizontal bar from 0 to 100 %.
constexpr const char* k_bar_style =
    "unset key\nunset grid\nset border 0\nunset ytics\nset xtics 0,10,100 format \"%g %%\" font \",14\"\nset lmargin 3\nset rmargin 3\nset "
    "tmargin 0.4\n"
    "set bmargin 1.6\nset xrange [0:100]\n";

const auto num = plot_number;

/// The horizontal bar from 0 to 100 % as plotly draws it.
json bar_layout(double lowest) {
    return {{"barmode", "stack"},
            {"bargap", 0},
            {"showlegend", false},
            {"hovermode", "closest"},
            {"xaxis", {{"range", {0, 100}}, {"ticksuffix", " %"}, {"showgrid", false}, {"fixedrange", true}}},
            {"yaxis", {{"range", {lowest, 1}}, {"visible", false}, {"fixedrange", true}}},
            {"margin", {{"t", 4}, {"b", 24}, {"l", 24}, {"r", 24}}}};
}

/// A segment of that bar; its ends follow from the order of the segments.
json bar_trace(double share, const std::string& name, const std::string& colour, const std::string& text_colour) {
    return {{"type", "bar"},
            {"orientation", "h"},
            {"x", {share}},
            {"y", {0.5}},
            {"width", {1.0}},
            {"name", name},
            {"marker", {{"color", colour}}},
            {"text", share >= 4.0 ? fmt::format("{:.1f} %", share) : ""},
            {"textposition", "inside"},
            {"insidetextanchor", "middle"},
            {"textangle", 0},
            {"textfont", {{"color", text_colour}, {"size", 14}}},
            {"hovertemplate", "%{x:.2f} %<extra>" + name + "</extra>"}};
}

json dashed_line(double x0, double x1, double y, const std::string& name, const std::string& colour) {
    return {{"type", "scatter"}, {"mode", "lines"}, {"x", {x0, x1}},
            {"y", {y, y}},       {"name", name},    {"line", {{"color", colour}, {"width", 1.5}, {"dash", "dash"}}}};
}

/// One of the areas that add up to the placed rock.
json stacked_area(const PlotRows& rows, std::size_t amount, const char* name, const char* colour) {
    json trace = curve(rows, 0, amount, name, colour);
    trace["line"]["width"] = 0;
    trace["stackgroup"] = "fates";
    trace["fillcolor"] = colour;
    trace["hovertemplate"] = "%{y:.3f} kg";
    return trace;
}

std::string revolutions_title(const char* since, double revolution) {
    return fmt::format("revolutions {} (1 revolution = {:.3g} s)", since, revolution);
}

/// Row indices of a table thinned to about k_points, the last one always among them.
std::vector<std::size_t> thinned(std::size_t first, std::size_t last) {
    const std::size_t stride = std::max<std::size_t>(1, (last - first) / k_points);
    std::vector<std::size_t> rows;
    for (std::size_t i = first; i < last; i += stride) rows.push_back(i);
    rows.push_back(last);
    return rows;
}

/// Rows of fates from the one before the first rock to the evaluated time.
std::vector<std::size_t> rows_with_rock(const Table& fates, const Spillage& spillage) {
    const std::vector<double>& times = fates.number("time_s");
    std::size_t first = 0, last = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (fates.number("placed_count")[i] == 0.0) first = i + 1;
        if (times[i] <= spillage.fates.time) last = i;
    }
    return thinned(std::min(first, last), last);
}

/// Limits with the same zero for two axes: `low` is the share of the range below zero.
struct TwinRange {
    double low_1, high_1, low_2, high_2;
};

TwinRange twin_range(double high_1, double low_2, double high_2) {
    high_1 = high_1 > 0.0 ? 1.12 * high_1 : 1.0;
    high_2 = std::max({1.15 * high_2, -0.5 * low_2, 1e-3});
    const double below = std::max(0.0, -1.15 * low_2) / high_2;
    return {-below * high_1, high_1, -below * high_2, high_2};
}

/// A round step for about four marks up to `high`.
double round_step(double high) {
    const double raw = high / 4.0, decade = std::pow(10.0, std::floor(std::log10(raw)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (raw <= factor * decade) return factor * decade;
    }
    return 10.0 * decade;
}

/// "0-30mm" as "0–30": the axis carries the unit.
std::string tic_text(std::string name) {
    if (name == "below_hub") return "below hub";
    if (name.size() > 2 && name.substr(name.size() - 2) == "mm") name.resize(name.size() - 2);
    const std::size_t dash = name.find('-');
    if (dash != std::string::npos) name.replace(dash, 1, "–");
    return name;
}

/// Means of a value of each time step over equal stretches of 1/100 revolution.
PlotRows averaged_over_revolutions(const std::vector<double>& times, const std::vector<std::vector<double>>& columns, double revolution) {
    PlotRows rows;
    std::size_t i = 0;
    while (i < times.size()) {
        const double stretch = std::floor(times[i] / revolution * k_bins_per_revolution);
        std::vector<double> sums(columns.size());
        double time = 0.0;
        std::size_t count = 0;
        for (; i < times.size() && std::floor(times[i] / revolution * k_bins_per_revolution) == stretch; ++i, ++count) {
            time += times[i];
            for (std::size_t c = 0; c < columns.size(); ++c) sums[c] += columns[c][i];
        }
        std::vector<double> row{time / static_cast<double>(count) / revolution};
        for (const double sum : sums) row.push_back(sum / static_cast<double>(count));
        rows.push_back(row);
    }
    return rows;
}

/// A segment of a horizontal bar of unit height, labelled with its percentage when there is room.
std::string bar_segment(int index, double from, double to, const std::string& colour, const std::string& text_colour) {
    std::string commands = fmt::format("set object {} rectangle from {},0 to {},1 fc rgb \"{}\" fs solid 1.0 noborder front\n", index,
                                       num(from), num(to), colour);
    if (to - from >= 4.0) {
        commands += fmt::format("set label {} \"{:.1f} %\" at {},0.5 center front font \",15\" textcolor rgb \"{}\"\n", index, to - from,
                                num(0.5 * (from + to)), text_colour);
    }
    return commands;
}

json bins_layout(const std::vector<std::string>& names, const TwinRange& range) {
    json places = json::array();
    for (std::size_t i = 0; i < names.size(); ++i) places.push_back(-static_cast<double>(i));
    json layout{{"xaxis", axis("bars: spilled, % of the placed mass")},
                {"xaxis2", axis("points: mean radial velocity, m/s (outwards positive)")},
                {"yaxis", axis("distance below the ring, mm")},
                {"hovermode", "y unified"},
                {"showlegend", false},
                {"margin", {{"t", 48}}}};
    json shares = json::array();  // negative shares have no meaning; the axis has room for them because both zeros stand at one place
    for (double share = 0.0; share < range.high_1; share += round_step(range.high_1)) shares.push_back(share);
    layout["xaxis"].update({{"range", {range.low_1, range.high_1}}, {"color", palette::spilled}, {"tickvals", shares}});
    layout["xaxis2"].update({{"range", {range.low_2, range.high_2}},
                             {"color", palette::outflow},
                             {"overlaying", "x"},
                             {"side", "top"},
                             {"tickmode", "auto"},
                             {"showgrid", false},
                             {"zeroline", true}});
    layout["yaxis"].update({{"tickvals", places}, {"ticktext", names}, {"showgrid", false}, {"zeroline", false}});
    return layout;
}

json rose_label(const std::string& text, double x, double y, const char* colour, double size) {
    return {{"text", text}, {"x", x}, {"y", y}, {"showarrow", false}, {"font", {{"color", colour}, {"size", size}}}};
}

json rose_layout(double largest) {
    json layout{{"showlegend", false},
                {"hovermode", "closest"},
                {"margin", {{"t", 4}, {"b", 4}, {"l", 4}, {"r", 4}}},
                {"xaxis", {{"visible", false}, {"range", {-1.42, 1.42}}, {"fixedrange", true}}},
                {"yaxis", {{"visible", false}, {"range", {-1.36, 1.36}}, {"scaleanchor", "x"}, {"fixedrange", true}}},
                {"shapes", json::array()},
                {"annotations", json::array()}};
    for (const double ring : {0.5, 1.0}) {
        layout["shapes"].push_back(
            {{"type", "circle"}, {"x0", -ring}, {"x1", ring}, {"y0", -ring}, {"y1", ring}, {"line", {{"color", "#c3cad1"}, {"width", 1}}}});
        layout["annotations"].push_back(rose_label(fmt::format("{:g}", ring * largest), ring * std::sin(0.65) + 0.06,
                                                   ring * std::cos(0.65) + 0.04, palette::faint, 11));
    }
    return layout;
}

}  // namespace

Plot outcome_plot(const Spillage& spillage) {
    const double placed = spillage.fates.placed.mass;
    const auto percent = [&](const RockAmount& amount) { return placed > 0.0 ? 100.0 * amount.mass / placed : 0.0; };
    const Fates& fates = spillage.fates;
    Plot plot{{"outcome", k_wide, 130, k_bar_style}, json::array(), bar_layout(-0.62)};
    plot.script.commands += "set yrange [-0.62:1]\n";
    double from = 0.0;
    int index = 1;
    const std::array<std::tuple<const RockAmount*, const char*, const char*, const char*>, 4> parts{{
        {&fates.spilled, "spilled", palette::spilled, "white"},
        {&fates.in_cutter, "in cutter", palette::in_cutter, palette::ink},
        {&fates.never_entered, "never entered", palette::never_entered, palette::ink},
        {&fates.sucked_up, "sucked up", palette::sucked_up, "white"},
    }};
    for (const auto& [amount, name, colour, text_colour] : parts) {
        if (amount->count == 0) continue;
        plot.script.commands += bar_segment(index++, from, from + percent(*amount), colour, text_colour);
        plot.traces.push_back(bar_trace(percent(*amount), name, colour, text_colour));
        from += percent(*amount);
    }
    if (spillage.ratios.ratio_min) {
        const double low = 100.0 * *spillage.ratios.ratio_min, high = 100.0 * *spillage.ratios.ratio_max;
        plot.script.commands += fmt::format("set arrow 1 from {},-0.3 to {},-0.3 heads size screen 0.004,90 lw 2 lc rgb \"{}\" front\n",
                                            num(low), num(high), palette::ink);
        plot.traces.push_back({{"type", "scatter"},
                               {"x", {low, high}},
                               {"y", {-0.3, -0.3}},
                               {"name", "bounds of the spillage ratio"},
                               {"mode", "lines+markers"},
                               {"line", {{"color", palette::ink}, {"width", 2}}},
                               {"marker", {{"symbol", "line-ns-open"}, {"size", 9}}},
                               {"hovertemplate", "%{x:.2f} %<extra>bound of the spillage ratio</extra>"}});
    }
    if (spillage.ratios.ratio) {
        plot.traces.push_back({{"type", "scatter"},
                               {"x", {100.0 * *spillage.ratios.ratio}},
                               {"y", {-0.3}},
                               {"mode", "markers"},
                               {"marker", {{"color", palette::ink}, {"size", 9}}},
                               {"hovertemplate", "%{x:.2f} %<extra>spillage ratio</extra>"}});
    }
    plot.script.commands += spillage.ratios.ratio ? fmt::format("plot \"-\" using 1:2 with points pt 7 ps 0.9 lc rgb \"{}\"\n{} -0.3\ne\n",
                                                                palette::ink, num(100.0 * *spillage.ratios.ratio))
                                                  : "plot NaN notitle\n";
    return plot;
}

Plot bins_plot(const Results& results) {
    PlotRows bars, velocities;  // share | velocity, place, error
    std::vector<std::string> tics, names;
    double largest_share = 0.0, lowest = 0.0, highest = 0.0;
    const std::size_t count = results.outflow.empty() ? results.spillage->bins.size() : results.outflow.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double y = -static_cast<double>(i);
        const std::string& name = results.outflow.empty() ? results.spillage->bins[i].bin.name : results.outflow[i].bin.name;
        tics.push_back(fmt::format("{} {}", quoted(tic_text(name)), num(y)));
        names.push_back(tic_text(name));
        if (results.spillage && results.spillage->fates.placed.mass > 0.0) {
            const double share = 100.0 * results.spillage->bins[i].spilled.mass / results.spillage->fates.placed.mass;
            largest_share = std::max(largest_share, share);
            bars.push_back({0.5 * share, y, 0.5 * share, 0.36, share});
        }
        if (!results.outflow.empty() && results.outflow[i].radial_velocity) {
            const TimeAverage& velocity = *results.outflow[i].radial_velocity;
            const double error = velocity.standard_error.value_or(0.0);
            lowest = std::min(lowest, velocity.mean - error);
            highest = std::max(highest, velocity.mean + error);
            velocities.push_back({velocity.mean, y, error});
        }
    }
    const TwinRange range = twin_range(largest_share, lowest, highest);
    Plot plot{{"bins", k_half, 110 + 20 * static_cast<int>(count), ""}, json::array(), bins_layout(names, range)};
    std::string& commands = plot.script.commands;
    if (!bars.empty()) commands += data_block("bars", bars);
    if (!velocities.empty()) commands += data_block("velocities", velocities);
    commands += fmt::format("set yrange [{}:0.6]\nset ytics ({}) scale 0\nset xrange [{}:{}]\nset x2range [{}:{}]\n",
                            num(-static_cast<double>(count) + 0.4), fmt::join(tics, ", "), num(range.low_1), num(range.high_1),
                            num(range.low_2), num(range.high_2));
    commands += "set ylabel \"distance below the ring, mm\"\nset grid noytics\nunset key\n";
    commands += fmt::format("set arrow 1 from 0,graph 0 to 0,graph 1 nohead lc rgb \"{}\" lw 1 front\n", palette::faint);
    std::vector<std::string> curves;
    if (!bars.empty()) {
        commands +=
            fmt::format("set xlabel \"bars: spilled, % of the placed mass\" textcolor rgb \"{}\"\nset xtics 0,{} textcolor rgb \"{}\"\n",
                        palette::spilled, num(round_step(range.high_1)), palette::spilled);
        plot.traces.push_back({{"type", "bar"},
                               {"orientation", "h"},
                               {"x", column(bars, 4)},
                               {"y", column(bars, 1)},
                               {"width", 0.72},
                               {"name", "spilled, % of the placed mass"},
                               {"marker", {{"color", palette::spilled}}},
                               {"hovertemplate", "%{x:.2f} % of the placed mass"}});
        curves.push_back(fmt::format("$bars using 1:2:3:4 with boxxyerror lc rgb \"{}\" notitle", palette::spilled));
    } else {
        commands += "unset xtics\n";
    }
    if (!velocities.empty()) {
        commands += fmt::format(
            "set x2tics nomirror out scale 0.5 textcolor rgb \"{0}\"\n"
            "set x2label \"points: mean radial velocity, m/s (outwards positive)\" textcolor rgb \"{0}\"\n",
            palette::outflow);
        json trace = curve(velocities, 0, 1, "mean radial velocity, m/s", palette::outflow);
        trace.update({{"mode", "lines+markers"},
                      {"xaxis", "x2"},
                      {"error_x", {{"array", column(velocities, 2)}, {"width", 0}, {"thickness", 1.2}}},
                      {"hovertemplate", "%{x:.3f} m/s"}});
        plot.traces.push_back(trace);
        curves.push_back(fmt::format("$velocities using 1:2 axes x2y1 with lines lw 1.5 lc rgb \"{}\" notitle", palette::outflow));
        curves.push_back(
            fmt::format("$velocities using 1:2:3 axes x2y1 with xerrorbars pt 7 ps 0.55 lw 1.2 lc rgb \"{}\" notitle", palette::outflow));
    }
    commands += curves.empty() ? "plot NaN notitle\n" : fmt::format("plot {}\n", fmt::join(curves, ", "));
    return plot;
}

Plot top_bin_plot(const Results& results) {
    PlotRows others, top;  // velocity, share, standard error of the velocity
    json names = json::array(), top_name = json::array();
    double slowest = 0.0, fastest = 0.0, highest = 1.0;
    for (std::size_t i = 0; i < results.outflow.size(); ++i) {
        const BinOutflow& flow = results.outflow[i];
        if (!flow.radial_velocity) continue;
        const double velocity = flow.radial_velocity->mean, error = flow.radial_velocity->standard_error.value_or(0.0);
        const double share = 100.0 * results.spillage->bins[i].spilled.mass / results.spillage->fates.placed.mass;
        const bool below_ring = flow.bin.z_max == 0.0;
        (below_ring ? top : others).push_back({velocity, share, error});
        (below_ring ? top_name : names).push_back(text::bin_text(flow.bin.name));
        slowest = std::min(slowest, velocity - error);
        fastest = std::max(fastest, velocity + error);
        highest = std::max(highest, 1.1 * share);
    }
    Plot plot{{"top_bin", k_half, k_height, ""},
              json::array(),
              {{"xaxis", axis("mean radial velocity, m/s (outwards positive)")},
               {"yaxis", axis("spilled there, % of the placed mass")},
               {"hovermode", "closest"}}};
    plot.layout["yaxis"]["range"] = {0, highest};
    add_onset_band(plot, slowest, fastest);
    plot.script.commands += fmt::format(
        "set xlabel \"mean radial velocity, m/s (outwards positive)\"\nset ylabel \"spilled there, % of the placed mass\"\nset yrange "
        "[0:{}]\n"
        "set key outside top center horizontal\n",
        num(highest));
    std::vector<std::string> curves;
    const auto add = [&](const PlotRows& rows, const json& bins, const char* name, const char* colour, const char* style,
                         const json& marker) {
        if (rows.empty()) return;
        const std::string block = fmt::format("bins{}", curves.size());
        plot.script.commands += data_block(block, rows);
        curves.push_back(fmt::format("${} using 1:2:3 with xerrorbars {} lc rgb \"{}\" title \"{}\"", block, style, colour, name));
        json trace = curve(rows, 0, 1, name, colour);
        trace.update({{"mode", "markers"},
                      {"marker", marker},
                      {"text", bins},
                      {"cliponaxis", false},
                      {"error_x", {{"array", column(rows, 2)}, {"width", 0}, {"thickness", 1.2}}},
                      {"hovertemplate", "%{text}<br>%{x:.3f} m/s, %{y:.2f} %<extra></extra>"}});
        plot.traces.push_back(trace);
    };
    add(others, names, "other bins", palette::outflow, "pt 6 ps 0.8 lw 1.2",
        {{"symbol", "circle-open"}, {"size", 8}, {"color", palette::outflow}});
    add(top, top_name, "bin below the ring", palette::spilled, "pt 7 ps 1.2 lw 1.6", {{"size", 11}, {"color", palette::spilled}});
    plot.script.commands += curves.empty() ? "plot NaN notitle\n" : fmt::format("plot {}\n", fmt::join(curves, ", "));
    return plot;
}

Plot fates_plot(const Table& fates, const Spillage& spillage, double revolution) {
    PlotRows rows;  // time, borders between the areas from below, then the amounts
    for (const std::size_t i : rows_with_rock(fates, spillage)) {
        const Fates now = fates_at(fates, i);
        const double spilled = now.spilled.mass, inside = spilled + now.in_cutter.mass, never = inside + now.never_entered.mass;
        rows.push_back({(now.time - spillage.feed_start) / revolution, spilled, inside, never, now.placed.mass, now.in_cutter.mass,
                        now.never_entered.mass, now.sucked_up.mass});
    }
    Plot plot{{"fates", k_half, k_height, data_block("fates", rows)},
              {stacked_area(rows, 1, "spilled", palette::spilled), stacked_area(rows, 5, "in cutter", palette::in_cutter),
               stacked_area(rows, 6, "never entered", palette::never_entered), stacked_area(rows, 7, "sucked up", palette::sucked_up)},
              {{"xaxis", axis(revolutions_title("since the first rock", revolution))},
               {"yaxis", axis("placed rock, kg")},
               {"legend", {{"traceorder", "reversed"}}}}};
    plot.script.commands += fmt::format(
        "set xlabel \"{}\"\nset ylabel \"placed rock, kg\"\n"
        "set xrange [0:*] noextend\nset yrange [0:*]\nset key outside top center horizontal samplen 1.5\nset grid front\n",
        revolutions_title("since the first rock", revolution));
    plot.script.commands += fmt::format(
        "plot $fates using 1:4:5 with filledcurves lc rgb \"{}\" title \"sucked up\", "
        "$fates using 1:3:4 with filledcurves lc rgb \"{}\" title \"never entered\", "
        "$fates using 1:2:3 with filledcurves lc rgb \"{}\" title \"in cutter\", "
        "$fates using 1:(0):2 with filledcurves lc rgb \"{}\" title \"spilled\"\n",
        palette::sucked_up, palette::never_entered, palette::in_cutter, palette::spilled);
    return plot;
}

Plot ratio_plot(const Table& fates, const Spillage& spillage, double revolution) {
    PlotRows bounds, ratios;
    for (const std::size_t i : rows_with_rock(fates, spillage)) {
        const Fates now = fates_at(fates, i);
        const SpillageRatios at = ratios_of(now);
        const double x = (now.time - spillage.feed_start) / revolution;
        if (at.ratio_min) bounds.push_back({x, 100.0 * *at.ratio_min, 100.0 * *at.ratio_max});
        if (at.ratio) ratios.push_back({x, 100.0 * *at.ratio});
    }
    Plot plot{{"ratio", k_half, k_height, data_block("bounds", bounds)},
              json::array(),
              {{"xaxis", axis(revolutions_title("since the first rock", revolution))}, {"yaxis", axis("spillage ratio, % by mass")}}};
    plot.layout["yaxis"]["range"] = {0, 100};
    plot.script.commands += fmt::format(
        "set xlabel \"{}\"\nset ylabel \"spillage ratio, % by mass\"\n"
        "set xrange [0:*] noextend\nset yrange [0:100]\nset key outside top center horizontal samplen 1.5\nset grid front\n",
        revolutions_title("since the first rock", revolution));
    std::vector<std::string> curves;
    if (!bounds.empty()) {
        curves.emplace_back("$bounds using 1:2:3 with filledcurves lc rgb \"#dfe4e9\" title \"between the bounds\"");
        json lower = curve(bounds, 0, 1, "lower bound", "#b8c1ca"), upper = curve(bounds, 0, 2, "upper bound", "#b8c1ca");
        upper.update({{"fill", "tonexty"}, {"fillcolor", "#dfe4e9"}});
        for (json* bound : {&lower, &upper}) {
            (*bound)["line"]["width"] = 1;
            (*bound)["hovertemplate"] = "%{y:.2f} %";
            plot.traces.push_back(*bound);
        }
    }
    if (!ratios.empty()) {
        json ratio = curve(ratios, 0, 1, "spilled / (spilled + sucked up)", palette::spilled);
        ratio["hovertemplate"] = "%{y:.2f} %";
        plot.traces.push_back(ratio);
        plot.script.commands += data_block("ratios", ratios);
        curves.push_back(
            fmt::format("$ratios using 1:2 with lines lw 2.2 lc rgb \"{}\" title \"spilled / (spilled + sucked up)\"", palette::spilled));
    }
    plot.script.commands += curves.empty() ? "plot NaN notitle\n" : fmt::format("plot {}\n", fmt::join(curves, ", "));
    return plot;
}

Plot first_exit_plot(const std::vector<double>& azimuths) {
    std::array<int, k_sectors> counts{};
    for (const double azimuth : azimuths) {
        const double turn = azimuth / (2.0 * k_pi) - std::floor(azimuth / (2.0 * k_pi));
        ++counts[std::min(static_cast<std::size_t>(turn * k_sectors), counts.size() - 1)];
    }
    const double largest = std::max(1, *std::max_element(counts.begin(), counts.end()));
    // Seen from the hub, a right-handed turn about hub-to-ring goes clockwise; azimuth 0 points down.
    const auto point = [](double radius, double azimuth) {
        return std::vector<double>{-radius * std::sin(azimuth), -radius * std::cos(azimuth)};
    };
    PlotRows sectors, middles;
    json texts = json::array();
    for (int k = 0; k < k_sectors; ++k) {
        const int count = counts[static_cast<std::size_t>(k)];
        const double radius = count / largest;
        if (k > 0) sectors.push_back({k_gap, k_gap});
        sectors.push_back({0.0, 0.0});
        for (int step = 0; step <= 6; ++step) sectors.push_back(point(radius, 2.0 * k_pi * (k + (0.5 + step) / 7.0) / k_sectors));
        sectors.push_back({0.0, 0.0});
        middles.push_back(point(0.5 * std::max(radius, 0.3), 2.0 * k_pi * (k + 0.5) / k_sectors));
        texts.push_back(fmt::format("{} to {}°: {} rock{}", k * 360 / k_sectors, (k + 1) * 360 / k_sectors, count, count == 1 ? "" : "s"));
    }
    const std::array<std::pair<double, const char*>, 4> marks{
        {{0.0, "0° lowest"}, {90.0, "90°"}, {180.0, "180° highest"}, {270.0, "270°"}}};
    Plot plot{{"first_exit", 430, 420, ""},
              {{{"type", "scatter"},
                {"mode", "lines"},
                {"fill", "toself"},
                {"x", column(sectors, 0)},
                {"y", column(sectors, 1)},
                {"line", {{"width", 0}}},
                {"fillcolor", palette::spilled},
                {"hoverinfo", "skip"}},
               {{"type", "scatter"},
                {"mode", "markers"},
                {"x", column(middles, 0)},
                {"y", column(middles, 1)},
                {"text", texts},
                {"hovertemplate", "%{text}<extra></extra>"},
                {"marker", {{"size", 24}, {"opacity", 0}}}}},
              rose_layout(largest)};
    std::string& commands = plot.script.commands;
    commands +=
        "unset key\nunset border\nunset tics\nunset grid\nset margins 1,1,1,1\nset size ratio -1\nset xrange [-1.42:1.42]\nset yrange "
        "[-1.36:1.36]\n";
    for (const double ring : {0.5, 1.0}) {
        commands +=
            fmt::format("set object circle at 0,0 size {} fc rgb \"#c3cad1\" fs empty border rgb \"#c3cad1\" lw 1 behind\n", num(ring));
        commands += fmt::format("set label \"{:g}\" at {},{} textcolor rgb \"{}\" font \",11\" left offset 0.3,0.4 front\n", ring * largest,
                                num(ring * std::sin(0.65)), num(ring * std::cos(0.65)), palette::faint);
    }
    for (const auto& [degrees, text] : marks) {
        const auto at = point(degrees == 90.0 || degrees == 270.0 ? 1.22 : 1.16, degrees * k_pi / 180.0);
        commands +=
            fmt::format("set label \"{}\" at {},{} center textcolor rgb \"{}\" front\n", text, num(at[0]), num(at[1]), palette::ink);
        plot.layout["annotations"].push_back(rose_label(text, at[0], at[1], palette::ink, 12.5));
    }
    // A sector a block: gnuplot ends a closed curve at an empty line.
    for (auto& row : sectors) row = std::isnan(row[0]) ? std::vector<double>{} : row;
    commands +=
        data_block("sectors", sectors) + fmt::format("plot $sectors using 1:2 with filledcurves closed lc rgb \"{}\"\n", palette::spilled);
    return plot;
}

Plot torque_plot(const Table& loads, const RotorLoads& rotor, double revolution, bool with_rock) {
    std::vector<double> flow = loads.number("torque_pressure_n_m");
    for (std::size_t i = 0; i < flow.size(); ++i) flow[i] += loads.number("torque_viscous_n_m")[i];
    const PlotRows rows = averaged_over_revolutions(loads.number("time_s"), {flow, loads.number("torque_rock_n_m")}, revolution);
    Plot plot{{"torque", k_half, k_height, data_block("loads", rows)},
              {curve(rows, 0, 1, "flow", palette::flow_load)},
              {{"xaxis", axis(revolutions_title("of the run", revolution))}, {"yaxis", axis("torque on the cutter about the axis, N m")}}};
    if (with_rock) plot.traces.push_back(curve(rows, 0, 2, "rock", palette::rock_load));
    plot.script.commands += fmt::format(
        "set xlabel \"{}\"\nset ylabel \"torque on the cutter about the axis, N m\"\n"
        "set xrange [0:*] noextend\nset key outside top center horizontal samplen 2\nset xzeroaxis lt 1 lc rgb \"{}\"\n",
        revolutions_title("of the run", revolution), palette::faint);
    std::vector<std::string> curves{fmt::format("$loads using 1:2 with lines lw 1.8 lc rgb \"{}\" title \"flow\"", palette::flow_load)};
    if (with_rock) curves.push_back(fmt::format("$loads using 1:3 with lines lw 1.8 lc rgb \"{}\" title \"rock\"", palette::rock_load));
    const auto mean_line = [&](const std::optional<TimeAverage>& average, const char* name, const char* colour) {
        if (!average) return;
        const double from = average->start / revolution, to = average->end / revolution;
        plot.script.commands += fmt::format("set arrow from {0},{1} to {2},{1} nohead dt 2 lw 1.5 lc rgb \"{3}\" front\n", num(from),
                                            num(average->mean), num(to), colour);
        plot.traces.push_back(dashed_line(from, to, average->mean, name, colour));
    };
    mean_line(rotor.torque_flow, "mean of the flow", palette::flow_load);
    if (with_rock) mean_line(rotor.torque_rock, "mean of the rock", palette::rock_load);
    for (json& trace : plot.traces) trace["hovertemplate"] = "%{y:.4g} N m";
    plot.script.commands += fmt::format("plot {}\n", fmt::join(curves, ", "));
    return plot;
}

Plot balance_plot(const Table& balance, double revolution, bool with_rock) {
    struct Curve {
        const char* column;
        const char* title;
        const char* colour;
    };
    std::vector<Curve> curves{{"flow_balance_error", "flow balance", palette::flow_load},
                              {"interface_imbalance", "rotor interface", palette::outflow}};
    if (with_rock) {
        curves.push_back({"solid_volume_error", "solid volume", palette::spilled});
        curves.push_back({"momentum_exchange_error", "momentum exchange", palette::rock_load});
    }
    PlotRows rows;
    for (const std::size_t i : thinned(0, balance.rows() - 1)) {
        std::vector<double> row{balance.number("time_s")[i] / revolution};
        for (const Curve& error : curves) {
            const double value = std::abs(balance.number(error.column)[i]);
            row.push_back(value > 0.0 ? value : k_gap);  // zero has no place on a logarithmic axis
        }
        rows.push_back(row);
    }
    Plot plot{{"balance", k_half, k_height, data_block("balance", rows)},
              json::array(),
              {{"xaxis", axis(revolutions_title("of the run", revolution))}, {"yaxis", axis("relative error per step")}}};
    plot.layout["yaxis"].update({{"type", "log"}, {"range", {-17, 0}}, {"dtick", 4}, {"exponentformat", "power"}});
    plot.script.commands += fmt::format(
        "set xlabel \"{}\"\nset ylabel \"relative error per step\"\n"
        "set logscale y\nset format y \"%.0e\"\nset xrange [0:*] noextend\nset key outside top center horizontal samplen 2\n"
        "set yrange [1e-17:1]\nset ytics 1e4\nunset mytics\n",
        revolutions_title("of the run", revolution));
    std::vector<std::string> plots;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        plots.push_back(
            fmt::format("$balance using 1:{} with lines lw 1.4 lc rgb \"{}\" title \"{}\"", c + 2, curves[c].colour, curves[c].title));
        json trace = curve(rows, 0, c + 1, curves[c].title, curves[c].colour);
        trace["line"]["width"] = 1.4;
        trace["hovertemplate"] = "%{y:.2e}";
        plot.traces.push_back(trace);
    }
    plot.script.commands += fmt::format("plot {}\n", fmt::join(plots, ", "));
    return plot;
}

const std::vector<CostPart>& cost_parts() {
    static const std::vector<CostPart> parts{{"fluid", "fluid", "#3b5b76", "white"},
                                             {"mesh_motion", "mesh motion and rotor interface", "#8fabc1", palette::ink},
                                             {"mapping", "mapping between rock and water", "#00795c", "white"},
                                             {"dem", "rock (DEM)", "#a34b86", "white"},
                                             {"output", "output", "#d9c27c", palette::ink}};
    return parts;
}

Plot cost_plot(const Cost& cost) {
    Plot plot{{"cost", k_wide, 90, k_bar_style}, json::array(), bar_layout(0.0)};
    plot.script.commands += "set yrange [0:1]\n";
    double from = 0.0;
    int index = 1;
    for (const CostPart& part : cost_parts()) {
        const double percent = 100.0 * cost.share.at(part.key);
        plot.script.commands += bar_segment(index++, from, from + percent, part.colour, part.text_colour);
        plot.traces.push_back(bar_trace(percent, part.title, part.colour, part.text_colour));
        from += percent;
    }
    plot.script.commands += "plot NaN notitle\n";
    return plot;
}

}  // namespace cutterflow::postproc
