#include "postproc/pages/report_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "postproc/analysis/text.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/pages/onset_band.hpp"
#include "postproc/pages/velocity_figures.hpp"

namespace cutterflow::postproc {
namespace {

constexpr std::size_t k_points = 500;  ///< of a curve over time; more cannot be seen
constexpr double k_bins_per_revolution = 100.0;
constexpr double k_gap = std::numeric_limits<double>::quiet_NaN();  ///< breaks a curve
constexpr int k_wide = 1116;                                        ///< as wide as the page, so that letters have their size

/// A bar of 100 %, without scales of its own.
Plot percent_bar(const std::string& name, int height, double lowest) {
    Plot plot;
    plot.name = name;
    plot.width = k_wide;
    plot.height = height;
    plot.tips = Tips::at_point;
    plot.legend = Legend::none;
    plot.x.tip = {".2f", " %"};
    plot.x.from = 0.0;
    plot.x.to = 100.0;
    plot.x.step = 10.0;
    plot.x.tick_suffix = " %";
    plot.x.grid = false;
    plot.y.from = lowest;
    plot.y.to = 1.0;
    plot.y.visible = false;
    return plot;
}

/// A part of that bar, labelled with its percentage where there is room.
Bar percent_part(double from, double percent, const char* name, const char* colour, const char* label_colour) {
    return {from,
            from + percent,
            0.5,
            1.0,
            colour,
            fmt::format("{}: {:.2f} %", name, percent),
            percent >= 4.0 ? fmt::format("{:.1f} %", percent) : "",
            label_colour};
}

/// A plot over revolutions.
Plot over_time(const std::string& name, const char* since, double revolution, const std::string& y_title, const TipFormat& y_tip) {
    Plot plot;
    plot.name = name;
    plot.x.title = fmt::format("revolutions {} (1 revolution = {:.3g} s)", since, revolution);
    plot.x.from = 0.0;
    plot.y.title = y_title;
    plot.y.tip = y_tip;
    return plot;
}

Series curve(const std::string& name, const char* colour, std::vector<double> x, std::vector<double> y, double width = 2.0) {
    Series series{name, colour, std::move(x), std::move(y)};
    series.line_width = width;
    return series;
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

/// Means of a value of each time step over equal stretches of 1/100 revolution. \return a column of times in revolutions, then the means
std::vector<std::vector<double>> averaged_over_revolutions(const std::vector<double>& times,
                                                           const std::vector<std::vector<double>>& columns, double revolution) {
    std::vector<std::vector<double>> means(columns.size() + 1);
    const auto stretch_of = [&](double time) { return std::floor(time / revolution * k_bins_per_revolution); };
    for (std::size_t i = 0; i < times.size();) {
        const double stretch = stretch_of(times[i]);
        std::vector<double> sums(columns.size() + 1);
        const std::size_t first = i;
        for (; i < times.size() && stretch_of(times[i]) == stretch; ++i) {
            sums[0] += times[i] / revolution;
            for (std::size_t c = 0; c < columns.size(); ++c) sums[c + 1] += columns[c][i];
        }
        for (std::size_t c = 0; c < sums.size(); ++c) means[c].push_back(sums[c] / static_cast<double>(i - first));
    }
    return means;
}

/// Production, undecided and spillage as one bar of the placed mass, with the ratio between its bounds.
Figure outcome(const Spillage& spillage) {
    const Fates& fates = spillage.fates;
    const double placed = fates.placed.mass;
    Plot plot = percent_bar("outcome", 130, -0.62);
    double from = 0.0;
    const std::array<std::tuple<const RockAmount*, const char*, const char*, const char*>, 4> parts{{
        {&fates.spilled, "spilled", palette::spilled, "white"},
        {&fates.in_cutter, "in cutter", palette::in_cutter, palette::ink},
        {&fates.never_entered, "never entered", palette::never_entered, palette::ink},
        {&fates.sucked_up, "sucked up", palette::sucked_up, "white"},
    }};
    for (const auto& [amount, name, colour, label_colour] : parts) {
        if (amount->count == 0) continue;
        const double percent = placed > 0.0 ? 100.0 * amount->mass / placed : 0.0;
        plot.bars.push_back(percent_part(from, percent, name, colour, label_colour));
        from += percent;
    }
    const SpillageRatios& ratios = spillage.ratios;
    if (ratios.ratio_min) {
        const double low = 100.0 * *ratios.ratio_min, high = 100.0 * *ratios.ratio_max;
        Series bounds{"bound of the spillage ratio", palette::ink, {low, high}, {-0.3, -0.3}};
        bounds.line_width = 2.0;
        plot.series.push_back(bounds);
        for (const double end : {low, high}) plot.series.push_back(curve("", palette::ink, {end, end}, {-0.42, -0.18}));
    }
    if (ratios.ratio) {
        Series dot{"spillage ratio", palette::ink, {100.0 * *ratios.ratio}, {-0.3}};
        dot.mark = Mark::disc;
        dot.mark_size = 9.0;
        plot.series.push_back(dot);
    }
    return {plot,
            fate_legend(fates) +
                "Share of the placed mass. Bar below: the spillage ratio (dot) between its bounds; undecided rock separates them.",
            ""};
}

/// What shares of spilled rock are over.
const char* supplied_text(const Results& results) {
    return results.fed ? "the fed mass" : "the placed mass";
}

/// Spilled share of the supplied mass per bin (with rock) and radial outflow on the upper axis, in the bins' order along the axis.
Figure bins(const Results& results) {
    Plot plot;
    plot.name = "bins";
    plot.tips = Tips::at_y;
    plot.legend = Legend::none;
    Series outflow{"mean radial velocity", palette::outflow, {}, {}};
    outflow.line_width = 1.5;
    outflow.mark = Mark::disc;
    outflow.mark_size = 6.0;
    outflow.upper_axis = true;
    double largest_share = 0.0, lowest = 0.0, highest = 0.0;
    const std::size_t count = results.outflow.empty() ? results.exits->bins.size() : results.outflow.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double y = -static_cast<double>(i);
        const std::string& name = results.outflow.empty() ? results.exits->bins[i].bin.name : results.outflow[i].bin.name;
        plot.y.ticks.push_back({y, tic_text(name)});
        if (results.exits && results.exits->supplied > 0.0) {
            const double share = 100.0 * results.exits->bins[i].spilled.mass / results.exits->supplied;
            largest_share = std::max(largest_share, share);
            plot.bars.push_back({0.0, share, y, 0.72, palette::spilled, fmt::format("{:.2f} % of {}", share, supplied_text(results))});
        }
        if (!results.outflow.empty() && results.outflow[i].radial_velocity) {
            const TimeAverage& velocity = *results.outflow[i].radial_velocity;
            const double error = velocity.standard_error.value_or(0.0);
            outflow.x.push_back(velocity.mean);
            outflow.y.push_back(y);
            outflow.x_low.push_back(velocity.mean - error);
            outflow.x_high.push_back(velocity.mean + error);
            lowest = std::min(lowest, velocity.mean - error);
            highest = std::max(highest, velocity.mean + error);
        }
    }
    const TwinRange range = twin_range(largest_share, lowest, highest);
    plot.height = 110 + 20 * static_cast<int>(count);
    plot.y.title = "distance below the ring, mm";
    plot.y.from = 0.4 - static_cast<double>(count);
    plot.y.to = 0.6;
    plot.y.grid = false;
    plot.x.from = range.low_1;
    plot.x.to = range.high_1;
    plot.x.zero_line = true;
    plot.x.visible = !plot.bars.empty();
    if (plot.x.visible) {
        plot.x.title = fmt::format("bars: spilled, % of {}", supplied_text(results));
        plot.x.colour = palette::spilled;
        // Negative shares have no meaning; the axis has room for them because both zeros stand at one place.
        const double step = round_step(range.high_1);
        for (double share = 0.0; share < range.high_1; share += step) plot.x.ticks.push_back({share, fmt::format("{:g}", share)});
    }
    if (!outflow.x.empty()) {
        plot.upper_x.emplace();
        plot.upper_x->title = "points: mean radial velocity, m/s (outwards positive)";
        plot.upper_x->tip = {".3f", " m/s"};
        plot.upper_x->colour = palette::outflow;
        plot.upper_x->from = range.low_2;
        plot.upper_x->to = range.high_2;
        plot.series.push_back(outflow);
    }
    const std::string sampled =
        "sampled just outside the contour of revolution, averaged over azimuth and time (whiskers: standard error by batch means). “gap” "
        "lies between ring and backplate.";
    return {plot,
            results.spillage ? "Where rock left the head for the last time, and the radial velocity there: " + sampled
                             : "Radial velocity just outside the contour of revolution, averaged over azimuth and time (whiskers: standard "
                               "error by batch means). “gap” lies between ring and backplate.",
            ""};
}

std::string top_bin_of(const LastExits& exits) {
    std::vector<geometry::AxialBin> bins;
    for (const BinSpillage& item : exits.bins) bins.push_back(item.bin);
    return top_bin(bins, [&](const std::string& name) {
        const auto of_bin = [&](const BinSpillage& item) { return item.bin.name == name; };
        return std::find_if(exits.bins.begin(), exits.bins.end(), of_bin)->spilled.mass / exits.supplied;
    });
}

/// Spilled share of the supplied mass against the radial velocity, a point a bin, that of the top bin in front.
Figure top_bin_figure(const Results& results) {
    Plot plot;
    plot.name = "top_bin";
    plot.tips = Tips::at_point;
    plot.x.title = "mean radial velocity, m/s (outwards positive)";
    plot.x.tip = {".3f", " m/s"};
    plot.y.title = fmt::format("spilled there, % of {}", supplied_text(results));
    plot.y.tip = {".2f", " %"};
    Series others{"other bins", palette::outflow, {}, {}}, top{"top bin", palette::spilled, {}, {}};
    others.mark = Mark::ring;
    top.mark = Mark::disc;
    top.mark_size = 11.0;
    const std::string name_of_top = top_bin_of(*results.exits);
    double slowest = 0.0, fastest = 0.0, highest = 1.0;
    for (std::size_t i = 0; i < results.outflow.size(); ++i) {
        const BinOutflow& flow = results.outflow[i];
        if (!flow.radial_velocity) continue;
        const double velocity = flow.radial_velocity->mean, error = flow.radial_velocity->standard_error.value_or(0.0);
        const double share = 100.0 * results.exits->bins[i].spilled.mass / results.exits->supplied;
        Series& series = flow.bin.name == name_of_top ? top : others;
        series.x.push_back(velocity);
        series.y.push_back(share);
        series.x_low.push_back(velocity - error);
        series.x_high.push_back(velocity + error);
        series.point_names.push_back(text::bin_text(flow.bin.name));
        slowest = std::min(slowest, velocity - error);
        fastest = std::max(fastest, velocity + error);
        highest = std::max(highest, 1.1 * share);
    }
    add_onset_band(plot, slowest, fastest);
    plot.y.from = 0.0;
    plot.y.to = highest;
    plot.series = {others, top};
    return {plot,
            fmt::format("Rock that left the head for the last time in a bin, against the radial velocity there (whiskers: standard error "
                        "by batch means). The top bin, {}, is the uppermost below the ring plane through which a hundredth or more of the "
                        "rock left: the ring’s own steel closes what it reaches over. ",
                        text::bin_text(name_of_top)) +
                onset_band_text(),
            ""};
}

/// Mass of the placed rock by fate over revolutions since the first rock.
Figure fates_over_time(const Table& fates, const Spillage& spillage, double revolution) {
    std::vector<double> x, zero, spilled, inside, never, placed;
    for (const std::size_t i : rows_with_rock(fates, spillage)) {
        const Fates now = fates_at(fates, i);
        x.push_back((now.time - spillage.feed_start) / revolution);
        zero.push_back(0.0);
        spilled.push_back(now.spilled.mass);
        inside.push_back(spilled.back() + now.in_cutter.mass);
        never.push_back(inside.back() + now.never_entered.mass);
        placed.push_back(now.placed.mass);
    }
    Plot plot = over_time("fates", "since the first rock", revolution, "placed rock, kg", {".3f", " kg"});
    plot.y.from = 0.0;
    plot.areas = {{"sucked up", palette::sucked_up, x, never, placed, true},
                  {"never entered", palette::never_entered, x, inside, never, true},
                  {"in cutter", palette::in_cutter, x, spilled, inside, true},
                  {"spilled", palette::spilled, x, zero, spilled, true}};
    return {plot,
            "Mass of the placed rock by fate. A fate is the last state of the rock’s centre, with a hysteresis of a "
            "quarter of its diameter; sucked up is final.",
            ""};
}

/// Spillage ratio between its bounds over revolutions since the first rock.
Figure ratio_over_time(const Table& fates, const Spillage& spillage, double revolution) {
    Plot plot = over_time("ratio", "since the first rock", revolution, "spillage ratio, % by mass", {".2f", " %"});
    plot.y.from = 0.0;
    plot.y.to = 100.0;
    Area bounds{"between the bounds", "#dfe4e9", {}, {}, {}};
    Series ratio = curve("spilled / (spilled + sucked up)", palette::spilled, {}, {}, 2.2);
    for (const std::size_t i : rows_with_rock(fates, spillage)) {
        const Fates now = fates_at(fates, i);
        const SpillageRatios at = ratios_of(now);
        const double x = (now.time - spillage.feed_start) / revolution;
        if (at.ratio_min) {
            bounds.x.push_back(x);
            bounds.low.push_back(100.0 * *at.ratio_min);
            bounds.high.push_back(100.0 * *at.ratio_max);
        }
        if (at.ratio) {
            ratio.x.push_back(x);
            ratio.y.push_back(100.0 * *at.ratio);
        }
    }
    if (!bounds.x.empty()) plot.areas.push_back(bounds);
    plot.series.push_back(ratio);
    return {plot, "Spillage ratio over time with its bounds: lower, all undecided rock is sucked up; upper, all is spilled.", ""};
}

/// Azimuths between which the bank stands beside the ring, from the lowest side to the bank's top; none without a bank, nor of one of a
/// file, whose top the study does not tell.
std::optional<std::pair<double, double>> bank_sector(const RunData& run) {
    const OperatingPoint& point = run.operating_point;
    if (!point.has_bank || point.bank_of_file || !(point.cut_height > 0.0)) return std::nullopt;
    const double inclination = point.inclination_deg * k_pi / 180.0, c = std::cos(inclination), s = std::sin(inclination);
    const geometry::Contour& head = run.contour;
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < head.z().size(); ++i) lowest = std::min(lowest, head.z()[i] * s - head.radius()[i] * c);
    const double top = lowest - point.standing_out + point.cut_height;
    const double reach = (head.ring_radius() + point.standing_out) * c;
    const double up_to = reach > 0.0 ? std::acos(std::clamp(-top / reach, -1.0, 1.0)) : k_pi;
    return bank_is_at_90(point).value_or(false) ? std::pair(0.0, up_to) : std::pair(-up_to, 0.0);
}

/// Shares of the mass that left, by quarter of the azimuth; empty without a swing direction.
std::string quarters_text(const LastExits& exits) {
    if (!exits.quarters) return "";
    const ExitQuarters& quarters = *exits.quarters;
    const double mass = quarters.bank_side.mass + quarters.top.mass + quarters.trailing_side.mass + quarters.bottom.mass;
    const auto share = [&](const RockAmount& amount) { return text::percent(amount.mass / mass); };
    return fmt::format(
        " By quarters of 90°: {} on the side of the bank, to which the head swings (about {}°), {} at the top, {} on the trailing side, {} "
        "at the bottom.",
        share(quarters.bank_side), quarters.bank_at_90 ? 90 : 270, share(quarters.top), share(quarters.trailing_side),
        share(quarters.bottom));
}

std::string bank_text(const OperatingPoint& point, bool is_drawn) {
    if (is_drawn) return " Brown: where the bank stands beside the ring, up to its top.";
    return point.has_bank && point.bank_of_file ? " The bank, of bank.file, is not drawn." : "";
}

/// Mass by azimuth of the last exit, seen from the hub, lowest side down.
Figure last_exit(const LastExits& exits, const RunData& run, bool in_window) {
    const std::optional<std::pair<double, double>> bank = bank_sector(run);
    constexpr std::size_t count = k_last_exit_sectors, steps_of_arc = 13;
    double largest = 0.0;
    for (const RockAmount& sector : exits.sectors) largest = std::max(largest, sector.mass);
    Plot plot;
    plot.name = "last_exit";
    plot.width = 430;
    plot.height = 420;
    plot.tips = Tips::at_point;
    plot.legend = Legend::none;
    plot.equal_scales = true;
    plot.x.from = -1.42;
    plot.x.to = 1.42;
    plot.y.from = -1.36;
    plot.y.to = 1.36;
    plot.x.visible = plot.y.visible = false;
    // Seen from the hub, a right-handed turn about hub-to-ring goes clockwise; azimuth 0 points down.
    const auto add = [](auto& shape, double radius, double azimuth) {
        shape.x.push_back(-radius * std::sin(azimuth));
        shape.y.push_back(-radius * std::cos(azimuth));
    };
    Polygon sectors{palette::spilled, {}, {}};
    Series middles{"", palette::spilled, {}, {}};
    const auto azimuth_at = [](std::size_t sector, double share) { return 2.0 * k_pi * (static_cast<double>(sector) + share) / count; };
    for (std::size_t k = 0; k < count; ++k) {
        const RockAmount& sector = exits.sectors[k];
        const double radius = sector.mass / largest;
        if (k > 0) add(sectors, k_gap, 0.0);
        add(sectors, 0.0, 0.0);
        for (std::size_t step = 0; step < steps_of_arc; ++step)
            add(sectors, radius, azimuth_at(k, (0.5 + static_cast<double>(step)) / steps_of_arc));
        add(sectors, 0.0, 0.0);
        add(middles, 0.5 * std::max(radius, 0.3), azimuth_at(k, 0.5));
        middles.point_names.push_back(fmt::format("{} to {}°: {:.3g} kg, {} rock{}", k * 360 / count, (k + 1) * 360 / count, sector.mass,
                                                  sector.count, sector.count == 1 ? "" : "s"));
    }
    plot.polygons.push_back(sectors);
    if (bank) {
        constexpr int steps = 40;
        Polygon soil{palette::soil, {}, {}};
        const auto at = [&](int step) { return bank->first + (bank->second - bank->first) * step / steps; };
        for (int step = 0; step <= steps; ++step) add(soil, 1.03, at(step));
        for (int step = steps; step >= 0; --step) add(soil, 1.1, at(step));
        plot.polygons.push_back(soil);
    }
    plot.series.push_back(middles);
    for (const double ring : {0.5, 1.0}) {
        plot.circles.push_back({ring, "#c3cad1"});
        plot.texts.push_back(
            {fmt::format("{:.3g} kg", ring * largest), ring * std::sin(0.65) + 0.06, ring * std::cos(0.65) + 0.04, palette::faint, 11.0});
    }
    const std::array<std::pair<double, const char*>, 4> marks{
        {{0.0, "0° lowest"}, {90.0, "90°"}, {180.0, "180° highest"}, {270.0, "270°"}}};
    for (const auto& [degrees, name] : marks) {
        const double radius = degrees == 90.0 || degrees == 270.0 ? 1.22 : 1.16, azimuth = degrees * k_pi / 180.0;
        plot.texts.push_back({name, -radius * std::sin(azimuth), -radius * std::cos(azimuth)});
    }
    return {
        plot,
        fmt::format("Mass of rock by the azimuth at which it left the head for the last time{} (sectors of 30°, rock that came back or was "
                    "sucked up left out). Seen from the hub, the lowest side down.",
                    in_window ? ", in the window of the production" : "") +
            quarters_text(exits) + bank_text(run.operating_point, bank.has_value()),
        "rose"};
}

/// Torque of flow and rock over revolutions of the run, averaged over 1/100 revolution.
Figure torque(const Table& loads, const RotorLoads& rotor, double revolution, bool with_rock) {
    std::vector<double> flow = loads.number("torque_pressure_n_m");
    for (std::size_t i = 0; i < flow.size(); ++i) flow[i] += loads.number("torque_viscous_n_m")[i];
    const auto means = averaged_over_revolutions(loads.number("time_s"), {flow, loads.number("torque_rock_n_m")}, revolution);
    Plot plot = over_time("torque", "of the run", revolution, "torque on the cutter about the axis, N m", {".4g", " N m"});
    plot.y.zero_line = true;
    plot.series.push_back(curve("flow", palette::flow_load, means[0], means[1]));
    if (with_rock) plot.series.push_back(curve("rock", palette::rock_load, means[0], means[2]));
    const auto add_mean = [&](const std::optional<TimeAverage>& average, const char* name, const char* colour) {
        if (!average) return;
        plot.series.push_back(
            curve(name, colour, {average->start / revolution, average->end / revolution}, {average->mean, average->mean}, 1.5));
        plot.series.back().dashed = true;
    };
    add_mean(rotor.torque_flow, "mean of the flow", palette::flow_load);
    if (with_rock) add_mean(rotor.torque_rock, "mean of the rock", palette::rock_load);
    return {plot,
            "Torque that flow and rock put on the cutter about the axis (right-handed, hub to ring), mean over 1/100 revolution; dashed: "
            "mean over whole revolutions.",
            ""};
}

/// Balance errors over revolutions of the run, on a logarithmic axis.
Figure balances(const Table& balance, double revolution, bool with_rock) {
    Plot plot = over_time("balance", "of the run", revolution, "relative error per step", {".2e", ""});
    plot.y.logarithmic = true;
    plot.y.from = 1e-17;
    plot.y.to = 1.0;
    plot.y.step = 1e4;
    const std::vector<std::size_t> rows = thinned(0, balance.rows() - 1);
    const auto add = [&](const char* column, const char* name, const char* colour) {
        Series series = curve(name, colour, {}, {}, 1.4);
        for (const std::size_t i : rows) {
            const double value = std::abs(balance.number(column)[i]);
            series.x.push_back(balance.number("time_s")[i] / revolution);
            series.y.push_back(value > 0.0 ? value : k_gap);  // zero has no place on a logarithmic axis
        }
        plot.series.push_back(series);
    };
    add("flow_balance_error", "flow balance", palette::flow_load);
    add("interface_imbalance", "rotor interface", palette::outflow);
    add("interface_mismatch", "rotor interface, by face", palette::in_cutter);
    if (with_rock) {
        add("solid_volume_error", "solid volume", palette::spilled);
        add("momentum_error", "momentum", palette::rock_load);
    }
    return {plot, "Errors of the balances at every step, relative.", ""};
}

/// A part of the cost as plot and legend show it.
struct CostPart {
    const char* key;  ///< in Cost::share
    const char* title;
    const char* colour;
    const char* text_colour;  ///< on it
};
constexpr CostPart k_cost_parts[] = {{"fluid", "fluid", "#3b5b76", "white"},
                                     {"mesh_motion", "mesh motion and rotor interface", "#8fabc1", palette::ink},
                                     {"mapping", "mapping between rock and water", "#00795c", "white"},
                                     {"dem", "rock (DEM)", "#a34b86", "white"},
                                     {"output", "output", "#d9c27c", palette::ink}};

/// Shares of the wall time as one bar.
Figure cost_shares(const Cost& cost) {
    Plot plot = percent_bar("cost", 90, 0.0);
    double from = 0.0;
    for (const CostPart& part : k_cost_parts) {
        const double percent = 100.0 * cost.share.at(part.key);
        plot.bars.push_back(percent_part(from, percent, part.title, part.colour, part.text_colour));
        from += percent;
    }
    return {plot, cost_legend(cost) + "Share of the time steps’ wall time by part of the solver (slowest rank).", ""};
}

bool has_exits(const LastExits& exits) {
    return std::any_of(exits.sectors.begin(), exits.sectors.end(), [](const RockAmount& sector) { return sector.count > 0; });
}

bool has_outflow(const Results& results) {
    return std::any_of(results.outflow.begin(), results.outflow.end(),
                       [](const BinOutflow& bin) { return bin.radial_velocity.has_value(); });
}

}  // namespace

std::vector<PlacedFigure> report_figures(const Results& results, const RunData& run) {
    const double revolution = run.operating_point.revolution_s();
    const std::optional<Spillage>& rock = results.spillage;
    std::vector<PlacedFigure> all;
    const auto add = [&](Place place, const Figure& figure) { all.push_back({place, figure}); };
    const bool is_batch = rock && !run.operating_point.fed_by_cutting;  // a head that is fed all the time has a production
    if (is_batch) add(Place::answer, outcome(*rock));
    if (rock || !results.outflow.empty()) add(Place::figures, bins(results));
    if (rock && has_outflow(results) && results.exits->supplied > 0.0) add(Place::figures, top_bin_figure(results));
    for (const auto& plane : {axial_plane(run), plane_under_ring(run)})
        if (plane) add(Place::figures, *plane);
    if (results.exits && has_exits(*results.exits)) add(Place::figures, last_exit(*results.exits, run, results.fed.has_value()));
    if (rock) add(Place::figures, fates_over_time(run.rock->fates, *rock, revolution));
    if (is_batch) add(Place::figures, ratio_over_time(run.rock->fates, *rock, revolution));
    const bool is_coupled = rock && !run.flow;
    add(Place::figures, torque(run.loads, results.rotor, revolution, is_coupled));
    add(Place::figures, balances(run.balance, revolution, is_coupled));
    add(Place::cost, cost_shares(results.cost));
    return all;
}

std::string fate_legend(const Fates& fates) {
    const auto entry = [](const char* colour, const char* name, const RockAmount& amount) {
        return std::pair<std::string, std::string>{colour, fmt::format("{} ({})", name, amount.count)};
    };
    return html::legend({entry(palette::spilled, "spilled", fates.spilled), entry(palette::in_cutter, "in cutter", fates.in_cutter),
                         entry(palette::never_entered, "never entered", fates.never_entered),
                         entry(palette::sucked_up, "sucked up", fates.sucked_up)});
}

std::string cost_legend(const Cost& cost) {
    std::vector<std::pair<std::string, std::string>> shares;
    double rest = 1.0;
    for (const CostPart& part : k_cost_parts) {
        const double share = cost.share.at(part.key);
        rest -= share;
        shares.emplace_back(part.colour, fmt::format("{} ({})", part.title, text::percent(share)));
    }
    shares.emplace_back("transparent", fmt::format("not assigned ({})", text::percent(std::max(0.0, rest))));
    return html::legend(shares);
}

}  // namespace cutterflow::postproc
