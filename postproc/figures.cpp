#include "postproc/figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "postproc/palette.hpp"

namespace cutterflow::postproc {
namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t k_points = 500;  ///< of a curve over time; more cannot be seen
constexpr double k_bins_per_revolution = 100.0;
constexpr int k_sectors = 24;
constexpr int k_wide = 1116, k_half = 540, k_height = 330;  ///< as large as the page shows them, so that letters have their size

/// A horizontal bar from 0 to 100 %.
constexpr const char* k_bar_style =
    "unset key\nunset grid\nset border 0\nunset ytics\nset xtics 0,10,100 format \"%g %%\" font \",14\"\nset lmargin 3\nset rmargin 3\nset "
    "tmargin 0.4\n"
    "set bmargin 1.6\nset xrange [0:100]\n";

std::string num(double value) {
    return fmt::format("{:.6g}", value);
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
Rows averaged_over_revolutions(const std::vector<double>& times, const std::vector<std::vector<double>>& columns, double revolution) {
    Rows rows;
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
        std::vector<std::string> row{num(time / static_cast<double>(count) / revolution)};
        for (const double sum : sums) row.push_back(num(sum / static_cast<double>(count)));
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

}  // namespace

PlotScript outcome_plot(const Spillage& spillage) {
    const double placed = spillage.fates.placed.mass;
    const auto percent = [&](const RockAmount& amount) { return placed > 0.0 ? 100.0 * amount.mass / placed : 0.0; };
    const Fates& fates = spillage.fates;
    PlotScript plot{"outcome", k_wide, 130, k_bar_style};
    plot.commands += "set yrange [-0.62:1]\n";
    double from = 0.0;
    int index = 1;
    const std::array<std::tuple<const RockAmount*, const char*, const char*>, 4> parts{{
        {&fates.spilled, palette::spilled, "white"},
        {&fates.in_cutter, palette::in_cutter, palette::ink},
        {&fates.never_entered, palette::never_entered, palette::ink},
        {&fates.sucked_up, palette::sucked_up, "white"},
    }};
    for (const auto& [amount, colour, text_colour] : parts) {
        if (amount->count == 0) continue;
        plot.commands += bar_segment(index++, from, from + percent(*amount), colour, text_colour);
        from += percent(*amount);
    }
    if (spillage.ratios.ratio_min) {
        const double low = 100.0 * *spillage.ratios.ratio_min, high = 100.0 * *spillage.ratios.ratio_max;
        plot.commands += fmt::format("set arrow 1 from {},-0.3 to {},-0.3 heads size screen 0.004,90 lw 2 lc rgb \"{}\" front\n", num(low),
                                     num(high), palette::ink);
    }
    plot.commands += spillage.ratios.ratio ? fmt::format("plot \"-\" using 1:2 with points pt 7 ps 0.9 lc rgb \"{}\"\n{} -0.3\ne\n",
                                                         palette::ink, num(100.0 * *spillage.ratios.ratio))
                                           : "plot NaN notitle\n";
    return plot;
}

PlotScript bins_plot(const Results& results) {
    Rows bars, velocities, tics;
    double largest_share = 0.0, lowest = 0.0, highest = 0.0;
    const std::size_t count = results.outflow.empty() ? results.spillage->bins.size() : results.outflow.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double y = -static_cast<double>(i);
        const std::string& name = results.outflow.empty() ? results.spillage->bins[i].bin.name : results.outflow[i].bin.name;
        tics.push_back({fmt::format("{} {}", quoted(tic_text(name)), num(y))});
        if (results.spillage && results.spillage->fates.placed.mass > 0.0) {
            const double share = 100.0 * results.spillage->bins[i].spilled.mass / results.spillage->fates.placed.mass;
            largest_share = std::max(largest_share, share);
            bars.push_back({num(0.5 * share), num(y), num(0.5 * share), "0.36"});
        }
        if (!results.outflow.empty() && results.outflow[i].radial_velocity) {
            const TimeAverage& velocity = *results.outflow[i].radial_velocity;
            const double error = velocity.standard_error.value_or(0.0);
            lowest = std::min(lowest, velocity.mean - error);
            highest = std::max(highest, velocity.mean + error);
            velocities.push_back({num(velocity.mean), num(y), num(error)});
        }
    }
    const TwinRange range = twin_range(largest_share, lowest, highest);
    PlotScript plot{"bins", k_half, 110 + 20 * static_cast<int>(count), ""};
    if (!bars.empty()) plot.commands += data_block("bars", bars);
    if (!velocities.empty()) plot.commands += data_block("velocities", velocities);
    std::vector<std::string> labels;
    for (const auto& row : tics) labels.push_back(row.front());
    plot.commands += fmt::format("set yrange [{}:0.6]\nset ytics ({}) scale 0\nset xrange [{}:{}]\nset x2range [{}:{}]\n",
                                 num(-static_cast<double>(count) + 0.4), fmt::join(labels, ", "), num(range.low_1), num(range.high_1),
                                 num(range.low_2), num(range.high_2));
    plot.commands += "set ylabel \"distance below the ring, mm\"\nset grid noytics\nunset key\n";
    plot.commands += fmt::format("set arrow 1 from 0,graph 0 to 0,graph 1 nohead lc rgb \"{}\" lw 1 front\n", palette::faint);
    std::vector<std::string> curves;
    if (!bars.empty()) {
        plot.commands +=
            fmt::format("set xlabel \"bars: spilled, % of the placed mass\" textcolor rgb \"{}\"\nset xtics 0,{} textcolor rgb \"{}\"\n",
                        palette::spilled, num(round_step(range.high_1)), palette::spilled);
        curves.push_back(fmt::format("$bars using 1:2:3:4 with boxxyerror lc rgb \"{}\" notitle", palette::spilled));
    } else {
        plot.commands += "unset xtics\n";
    }
    if (!velocities.empty()) {
        plot.commands += fmt::format(
            "set x2tics nomirror out scale 0.5 textcolor rgb \"{0}\"\n"
            "set x2label \"points: mean radial velocity, m/s (outwards positive)\" textcolor rgb \"{0}\"\n",
            palette::outflow);
        curves.push_back(fmt::format("$velocities using 1:2 axes x2y1 with lines lw 1.5 lc rgb \"{}\" notitle", palette::outflow));
        curves.push_back(
            fmt::format("$velocities using 1:2:3 axes x2y1 with xerrorbars pt 7 ps 0.55 lw 1.2 lc rgb \"{}\" notitle", palette::outflow));
    }
    plot.commands += curves.empty() ? "plot NaN notitle\n" : fmt::format("plot {}\n", fmt::join(curves, ", "));
    return plot;
}

PlotScript fates_plot(const Table& fates, const Spillage& spillage, double revolution) {
    Rows rows;
    for (const std::size_t i : rows_with_rock(fates, spillage)) {
        const Fates now = fates_at(fates, i);
        const double spilled = now.spilled.mass, inside = spilled + now.in_cutter.mass, never = inside + now.never_entered.mass;
        rows.push_back({num((now.time - spillage.feed_start) / revolution), num(spilled), num(inside), num(never), num(now.placed.mass)});
    }
    PlotScript plot{"fates", k_half, k_height, data_block("fates", rows)};
    plot.commands += fmt::format(
        "set xlabel \"revolutions since the first rock (1 revolution = {:.3g} s)\"\nset ylabel \"placed rock, kg\"\n"
        "set xrange [0:*] noextend\nset yrange [0:*]\nset key outside top center horizontal samplen 1.5\nset grid front\n",
        revolution);
    plot.commands += fmt::format(
        "plot $fates using 1:4:5 with filledcurves lc rgb \"{}\" title \"sucked up\", "
        "$fates using 1:3:4 with filledcurves lc rgb \"{}\" title \"never entered\", "
        "$fates using 1:2:3 with filledcurves lc rgb \"{}\" title \"in cutter\", "
        "$fates using 1:(0):2 with filledcurves lc rgb \"{}\" title \"spilled\"\n",
        palette::sucked_up, palette::never_entered, palette::in_cutter, palette::spilled);
    return plot;
}

PlotScript ratio_plot(const Table& fates, const Spillage& spillage, double revolution) {
    Rows bounds, ratios;
    for (const std::size_t i : rows_with_rock(fates, spillage)) {
        const Fates now = fates_at(fates, i);
        const SpillageRatios at = ratios_of(now);
        const std::string x = num((now.time - spillage.feed_start) / revolution);
        if (at.ratio_min) bounds.push_back({x, num(100.0 * *at.ratio_min), num(100.0 * *at.ratio_max)});
        if (at.ratio) ratios.push_back({x, num(100.0 * *at.ratio)});
    }
    PlotScript plot{"ratio", k_half, k_height, data_block("bounds", bounds)};
    plot.commands += fmt::format(
        "set xlabel \"revolutions since the first rock (1 revolution = {:.3g} s)\"\nset ylabel \"spillage ratio, % by mass\"\n"
        "set xrange [0:*] noextend\nset yrange [0:100]\nset key outside top center horizontal samplen 1.5\nset grid front\n",
        revolution);
    std::vector<std::string> curves;
    if (!bounds.empty()) curves.emplace_back("$bounds using 1:2:3 with filledcurves lc rgb \"#dfe4e9\" title \"between the bounds\"");
    if (!ratios.empty()) {
        plot.commands += data_block("ratios", ratios);
        curves.push_back(
            fmt::format("$ratios using 1:2 with lines lw 2.2 lc rgb \"{}\" title \"spilled / (spilled + sucked up)\"", palette::spilled));
    }
    plot.commands += curves.empty() ? "plot NaN notitle\n" : fmt::format("plot {}\n", fmt::join(curves, ", "));
    return plot;
}

PlotScript first_exit_plot(const std::vector<double>& azimuths) {
    std::array<int, k_sectors> counts{};
    for (const double azimuth : azimuths) {
        const double turn = azimuth / (2.0 * k_pi) - std::floor(azimuth / (2.0 * k_pi));
        ++counts[std::min(static_cast<std::size_t>(turn * k_sectors), counts.size() - 1)];
    }
    const double largest = std::max(1, *std::max_element(counts.begin(), counts.end()));
    // Seen from the hub, a right-handed turn about hub-to-ring goes clockwise; azimuth 0 points down.
    const auto point = [](double radius, double azimuth) {
        return std::vector<std::string>{num(-radius * std::sin(azimuth)), num(-radius * std::cos(azimuth))};
    };
    Rows sectors;
    for (int k = 0; k < k_sectors; ++k) {
        const double radius = counts[static_cast<std::size_t>(k)] / largest;
        sectors.push_back({"0", "0"});
        for (int step = 0; step <= 6; ++step) sectors.push_back(point(radius, 2.0 * k_pi * (k + (0.5 + step) / 7.0) / k_sectors));
        sectors.push_back({"0", "0"});
        sectors.push_back({""});
    }
    PlotScript plot{"first_exit", 430, 420, data_block("sectors", sectors)};
    plot.commands +=
        "unset key\nunset border\nunset tics\nunset grid\nset margins 1,1,1,1\nset size ratio -1\nset xrange [-1.42:1.42]\nset yrange "
        "[-1.36:1.36]\n";
    for (const double ring : {0.5, 1.0}) {
        plot.commands +=
            fmt::format("set object circle at 0,0 size {} fc rgb \"#c3cad1\" fs empty border rgb \"#c3cad1\" lw 1 behind\n", num(ring));
        plot.commands += fmt::format("set label \"{:g}\" at {},{} textcolor rgb \"{}\" font \",11\" left offset 0.3,0.4 front\n",
                                     ring * largest, num(ring * std::sin(0.65)), num(ring * std::cos(0.65)), palette::faint);
    }
    const std::array<std::pair<double, const char*>, 4> marks{
        {{0.0, "0° lowest"}, {90.0, "90°"}, {180.0, "180° highest"}, {270.0, "270°"}}};
    for (const auto& [degrees, text] : marks) {
        const auto at = point(degrees == 90.0 || degrees == 270.0 ? 1.22 : 1.16, degrees * k_pi / 180.0);
        plot.commands += fmt::format("set label \"{}\" at {},{} center textcolor rgb \"{}\" front\n", text, at[0], at[1], palette::ink);
    }
    plot.commands += fmt::format("plot $sectors using 1:2 with filledcurves closed lc rgb \"{}\"\n", palette::spilled);
    return plot;
}

PlotScript torque_plot(const Table& loads, const RotorLoads& rotor, double revolution, bool with_rock) {
    std::vector<double> flow = loads.number("torque_pressure_n_m");
    for (std::size_t i = 0; i < flow.size(); ++i) flow[i] += loads.number("torque_viscous_n_m")[i];
    const Rows rows = averaged_over_revolutions(loads.number("time_s"), {flow, loads.number("torque_rock_n_m")}, revolution);
    PlotScript plot{"torque", k_half, k_height, data_block("loads", rows)};
    plot.commands += fmt::format(
        "set xlabel \"revolutions of the run (1 revolution = {:.3g} s)\"\nset ylabel \"torque on the cutter about the axis, N m\"\n"
        "set xrange [0:*] noextend\nset key outside top center horizontal samplen 2\nset xzeroaxis lt 1 lc rgb \"{}\"\n",
        revolution, palette::faint);
    std::vector<std::string> curves{fmt::format("$loads using 1:2 with lines lw 1.8 lc rgb \"{}\" title \"flow\"", palette::flow_load)};
    if (with_rock) curves.push_back(fmt::format("$loads using 1:3 with lines lw 1.8 lc rgb \"{}\" title \"rock\"", palette::rock_load));
    const auto mean_line = [&](const std::optional<TimeAverage>& average, const char* colour) {
        if (!average) return;
        plot.commands += fmt::format("set arrow from {0},{1} to {2},{1} nohead dt 2 lw 1.5 lc rgb \"{3}\" front\n",
                                     num(average->start / revolution), num(average->mean), num(average->end / revolution), colour);
    };
    mean_line(rotor.torque_flow, palette::flow_load);
    if (with_rock) mean_line(rotor.torque_rock, palette::rock_load);
    plot.commands += fmt::format("plot {}\n", fmt::join(curves, ", "));
    return plot;
}

PlotScript balance_plot(const Table& balance, double revolution, bool with_rock) {
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
    Rows rows;
    for (const std::size_t i : thinned(0, balance.rows() - 1)) {
        std::vector<std::string> row{num(balance.number("time_s")[i] / revolution)};
        for (const Curve& curve : curves) {
            const double value = std::abs(balance.number(curve.column)[i]);
            row.push_back(value > 0.0 ? num(value) : "NaN");  // zero has no place on a logarithmic axis
        }
        rows.push_back(row);
    }
    PlotScript plot{"balance", k_half, k_height, data_block("balance", rows)};
    plot.commands += fmt::format(
        "set xlabel \"revolutions of the run (1 revolution = {:.3g} s)\"\nset ylabel \"relative error per step\"\n"
        "set logscale y\nset format y \"%.0e\"\nset xrange [0:*] noextend\nset key outside top center horizontal samplen 2\n"
        "set yrange [1e-17:1]\nset ytics 1e4\nunset mytics\n",
        revolution);
    std::vector<std::string> plots;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        plots.push_back(
            fmt::format("$balance using 1:{} with lines lw 1.4 lc rgb \"{}\" title \"{}\"", c + 2, curves[c].colour, curves[c].title));
    }
    plot.commands += fmt::format("plot {}\n", fmt::join(plots, ", "));
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

PlotScript cost_plot(const Cost& cost) {
    PlotScript plot{"cost", k_wide, 90, k_bar_style};
    plot.commands += "set yrange [0:1]\n";
    double from = 0.0;
    int index = 1;
    for (const CostPart& part : cost_parts()) {
        const double percent = 100.0 * cost.share.at(part.key);
        plot.commands += bar_segment(index++, from, from + percent, part.colour, part.text_colour);
        from += percent;
    }
    plot.commands += "plot NaN notitle\n";
    return plot;
}

}  // namespace cutterflow::postproc
