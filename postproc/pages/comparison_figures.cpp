#include "postproc/pages/comparison_figures.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <boost/math/tools/minima.hpp>

#include "postproc/analysis/best_speed.hpp"
#include "postproc/analysis/choices.hpp"
#include "postproc/analysis/text.hpp"
#include "postproc/pages/delivered_map.hpp"
#include "postproc/pages/onset_band.hpp"

namespace cutterflow::postproc {
namespace {

/// Colours of settings, in order; told apart with any colour vision.
constexpr const char* k_colours[] = {"#0072b2", "#d55e00", "#00795c", "#a34b86", "#8a6d00", "#26303a", "#56b4e9", "#9aa3ab"};

/// Bounds when there are some, else the interval, else the value itself.
std::pair<double, double> range_of(const Estimate& estimate) {
    if (estimate.low) return {*estimate.low, *estimate.high};
    const double half = estimate.half_width.value_or(0.0);
    return {*estimate.value - half, *estimate.value + half};
}

/// A point with the range of its value. \param factor  from the quantity's unit to the plot's
void add_point(Series& series, const Comparison& comparison, std::size_t setting, double x, const Estimate& estimate, double factor) {
    const auto [low, high] = range_of(estimate);
    series.x.push_back(x);
    series.y.push_back(factor * *estimate.value);
    series.y_low.push_back(factor * low);
    series.y_high.push_back(factor * high);
    series.point_names.push_back(fmt::format("setting {}: {}", setting + 1, comparison.settings[setting].label));
}

/// A plot of shares with a tool tip for every point.
Plot share_plot(const std::string& name, const std::string& x_title, const std::string& y_title) {
    Plot plot;
    plot.name = name;
    plot.tips = Tips::at_point;
    plot.x.title = x_title;
    plot.y.title = y_title;
    plot.y.tip = {".2f", " %"};
    plot.y.from = 0.0;
    plot.y.to = 100.0;
    return plot;
}

/// Curves beyond this number leave no room for a legend; colours then stand in the table of settings.
constexpr std::size_t k_most_in_legend = 8;

Figure with_legend_that_fits(Plot plot, const std::string& caption) {
    constexpr std::size_t in_two_lines = 4;
    constexpr int px_a_curve = 16;
    if (plot.series.size() > k_most_in_legend)
        plot.legend = Legend::none;
    else if (plot.series.size() > in_two_lines)
        plot.height += px_a_curve * static_cast<int>(plot.series.size());
    return {plot, caption, ""};
}

constexpr const char* k_share_title = "% by mass";
constexpr double k_percent = 100.0;

struct Share {
    const char* key;
    const char* name;
    const char* colour;
};
constexpr Share k_shares[] = {{"ratio", "spillage ratio", palette::spilled}, {"production", "production", palette::sucked_up}};

/// Whether a setting's hold-up still changes, of one repeat or more: its spillage has bounds and no value.
bool still_changes(const Comparison& comparison, std::size_t setting) {
    const Estimate& spillage = quantity_of(comparison, quantity::k_spillage, setting);
    return scope_of(comparison).fed_by_cutting && !spillage.value && spillage.low;
}

Mark open_form(Mark mark) {
    switch (mark) {
        case Mark::diamond:
            return Mark::open_diamond;
        case Mark::square:
            return Mark::open_square;
        case Mark::triangle:
            return Mark::open_triangle;
        default:
            return Mark::ring;
    }
}

/// The same quantity where the hold-up still changes: open marks that no line joins.
Series form_of_changing(Series series) {
    series.name += ", hold-up still changes";
    series.mark = open_form(series.mark);
    series.line_width = 0.0;
    return series;
}

/// Said where there are such marks.
std::string changing_text(const Comparison& comparison) {
    for (std::size_t i = 0; i < comparison.settings.size(); ++i)
        if (still_changes(comparison, i))
            return " Open marks, joined by no line: the hold-up still changes, and this is no steady production.";
    return "";
}

void add_drawn(Plot& plot, const std::vector<Series>& all) {
    for (const Series& series : all)
        if (!series.x.empty()) plot.series.push_back(series);
}

/// Spillage and production, setting by setting.
Plot shares_plot(const Comparison& comparison) {
    Plot plot = share_plot("shares", "setting", k_share_title);
    double shift = -0.06;
    for (const Share& share : k_shares) {
        Series series{share.name, share.colour, {}, {}};
        series.mark = Mark::disc;
        Series changing = form_of_changing(series);
        const Quantity& quantity = *find_quantity(comparison, share.key);
        for (std::size_t i = 0; i < comparison.settings.size(); ++i)
            if (quantity.settings[i].value)
                add_point(still_changes(comparison, i) ? changing : series, comparison, i, static_cast<double>(i + 1) + shift,
                          quantity.settings[i], k_percent);
        add_drawn(plot, {series, changing});
        shift = 0.06;
    }
    plot.x.from = 0.5;
    plot.x.to = static_cast<double>(comparison.settings.size()) + 0.5;
    plot.x.step = 1.0;
    return plot;
}

bool varies(const Quantity& quantity) {
    std::set<double> values;
    for (const Estimate& estimate : quantity.settings) {
        if (estimate.value) values.insert(*estimate.value);
    }
    return values.size() > 1;
}

/// What a trend is drawn against: a quantity, and the study's key that varies along its curves.
struct Against {
    Quantity quantity;
    std::string key;
    std::string name;  ///< of the plot
    std::string x_title;
    TipFormat tip;
    std::string what;  ///< in a caption
};

/// Settings of a group by increasing value of a quantity.
std::vector<std::size_t> members(const std::vector<std::string>& groups, const std::string& group, const Quantity& operating) {
    std::vector<std::size_t> settings;
    for (std::size_t i = 0; i < groups.size(); ++i)
        if (groups[i] == group && operating.settings[i].value) settings.push_back(i);
    std::stable_sort(settings.begin(), settings.end(),
                     [&](std::size_t a, std::size_t b) { return *operating.settings[a].value < *operating.settings[b].value; });
    return settings;
}

/// Whether a curve along a key would join two settings of different values.
bool joins_settings(const Comparison& comparison, const Quantity& of_key) {
    const std::vector<std::string> groups = told_apart(comparison, {of_key.key});
    for (const std::string& group : std::set<std::string>(groups.begin(), groups.end())) {
        const std::vector<std::size_t> joined = members(groups, group, of_key);
        if (joined.size() > 1 && of_key.settings[joined.front()].value < of_key.settings[joined.back()].value) return true;
    }
    return false;
}

/// A quantity as it is drawn in a trend.
struct Drawn {
    const char* key;
    std::string name;
    const char* colour;
    double factor;  ///< from the quantity's unit to the plot's
};

/// Quantities against an operating one, a curve for all settings that differ in its key alone; marks tell curves apart, and colours too
/// where one quantity is drawn.
void add_trends(Plot& plot, const Comparison& comparison, const Against& against, const std::vector<Drawn>& quantities) {
    constexpr Mark marks[] = {Mark::disc, Mark::diamond, Mark::square, Mark::triangle};
    const std::vector<std::string> groups = told_apart(comparison, {against.key});
    std::size_t count = 0;
    for (const std::string& group : std::set<std::string>(groups.begin(), groups.end())) {
        for (const Drawn& drawn : quantities) {
            Series series{
                drawn.name + (group.empty() ? "" : ", " + group), quantities.size() > 1 ? drawn.colour : setting_colour(count), {}, {}};
            series.mark = marks[count % std::size(marks)];
            series.line_width = 1.2;
            Series changing = form_of_changing(series);
            const Quantity& quantity = *find_quantity(comparison, drawn.key);
            for (const std::size_t i : members(groups, group, against.quantity))
                if (quantity.settings[i].value)
                    add_point(still_changes(comparison, i) ? changing : series, comparison, i, *against.quantity.settings[i].value,
                              quantity.settings[i], drawn.factor);
            add_drawn(plot, {series, changing});
        }
        ++count;
    }
}

/// Spillage and production.
Plot trend_plot(const Comparison& comparison, const Against& against) {
    Plot plot = share_plot(against.name, against.x_title, k_share_title);
    plot.x.tip = against.tip;
    std::vector<Drawn> quantities;
    for (const Share& share : k_shares) quantities.push_back({share.key, share.name, share.colour, k_percent});
    add_trends(plot, comparison, against, quantities);
    return plot;
}

/// What heads that are fed all the time deliver, as soil in the bank.
Plot delivered_plot(const Comparison& comparison, const Against& against) {
    Plot plot;
    plot.name = "delivered_" + against.name;
    plot.tips = Tips::at_point;
    plot.x.title = against.x_title;
    plot.x.tip = against.tip;
    plot.y.title = "delivered, soil in situ, m³/h";
    plot.y.tip = {".3g", " m³/h"};
    plot.y.from = 0.0;
    add_trends(plot, comparison, against, {{quantity::k_delivered, "delivered", palette::sucked_up, 1.0}});
    return plot;
}

void add_measured_point(Series& series, const std::string& test, double speed, const std::optional<MeasuredShare>& share) {
    if (!share) return;
    const double error = share->error.value_or(0.0);
    series.x.push_back(speed);
    series.y.push_back(100.0 * share->value);
    series.y_low.push_back(100.0 * (share->value - error));
    series.y_high.push_back(100.0 * (share->value + error));
    series.point_names.push_back(fmt::format("measured: {}", test));
}

/// Tests against the rotor's speed, as crosses in the colours of the shares.
void add_measured_points(Plot& plot, const Comparison& comparison) {
    constexpr Mark marks[] = {Mark::cross, Mark::plus};
    std::size_t count = 0;
    for (const MeasuredSeries& measured : comparison.measured) {
        Series spillage{"spillage, " + measured.name, palette::spilled, {}, {}};
        Series production{"production, " + measured.name, palette::sucked_up, {}, {}};
        spillage.mark = production.mark = marks[count++ % std::size(marks)];
        for (const MeasuredPoint& point : measured.points) {
            add_measured_point(spillage, measured.name, point.speed_rpm, point.spillage);
            add_measured_point(production, measured.name, point.speed_rpm, point.production);
        }
        add_drawn(plot, {spillage, production});
    }
}

/// A value of each setting of a series, linear between its speeds.
double between(const std::vector<double>& speeds, const std::vector<double>& values, double speed) {
    const auto after = std::upper_bound(speeds.begin(), speeds.end(), speed);
    const auto i =
        static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(after - speeds.begin(), 1, static_cast<std::ptrdiff_t>(speeds.size()) - 1));
    return values[i - 1] + (speed - speeds[i - 1]) / (speeds[i] - speeds[i - 1]) * (values[i] - values[i - 1]);
}

/// 1 - P = 1 - (1 - S_out) exp(-(n_0/n)^2): below its speed n_0 rock falls through between two blades.
double hypothesis(double outflow, double speed, double fall_through) {
    return 1.0 - (1.0 - outflow) * std::exp(-fall_through * fall_through / (speed * speed));
}

/// S_out at the speeds of a series, linear between them.
struct OutflowLine {
    std::vector<double> speeds, shares;
    bool reaches(double speed) const { return speed >= speeds.front() && speed <= speeds.back(); }
    double at(double speed) const { return between(speeds, shares, speed); }
};

OutflowLine outflow_line(const Comparison& comparison, const SpeedSeries& series, const Quantity& mixed) {
    OutflowLine line;
    const Quantity& speed = *find_quantity(comparison, quantity::k_speed);
    for (const std::size_t i : series.settings) {
        if (!mixed.settings[i].value) continue;
        line.speeds.push_back(*speed.settings[i].value);
        line.shares.push_back(*mixed.settings[i].value);
    }
    return line;
}

/// A test's spillage.
std::optional<double> measured_spillage(const MeasuredPoint& point) {
    if (point.spillage) return point.spillage->value;
    return point.production ? std::optional<double>(1.0 - point.production->value) : std::nullopt;
}

/// The speed n_0 [rpm] with which the hypothesis is nearest to the tests of a series' discharge and speeds, by least squares; none with
/// fewer than two of them: a curve of one parameter goes through any one point.
std::optional<double> measured_fall_through(const Comparison& comparison, const SpeedSeries& series, const OutflowLine& outflow) {
    const OperatingPoint& point = comparison.runs[comparison.settings[series.settings.front()].runs.front()].run.operating_point;
    std::vector<std::pair<double, double>> tests;  // speed, spillage
    for (const MeasuredSeries& measured : comparison.measured)
        for (const MeasuredPoint& test : measured.points)
            if (const auto spillage = measured_spillage(test); spillage && outflow.reaches(test.speed_rpm) && has_discharge_of(point, test))
                tests.emplace_back(test.speed_rpm, *spillage);
    if (tests.size() < 2) return std::nullopt;
    const auto error = [&](double fall_through) {
        double sum = 0.0;
        for (const auto& [speed, spillage] : tests) sum += std::pow(hypothesis(outflow.at(speed), speed, fall_through) - spillage, 2);
        return sum;
    };
    // Far above all speeds everything falls through and the error is flat: the minimum is looked for between the best of some and its
    // neighbours.
    constexpr int places = 300, bits = 24;  // bits of the double's 53: the minimum of a parabola is not known better
    const double step = 3.0 * outflow.speeds.back() / places;
    int best = 0;
    for (int k = 1; k <= places; ++k)
        if (error(k * step) < error(best * step)) best = k;
    return boost::math::tools::brent_find_minima(error, std::max(0, best - 1) * step, (best + 1) * step, bits).first;
}

Series hypothesis_line(const OutflowLine& outflow, double fall_through, const std::string& of) {
    constexpr int points = 60;
    Series dashed{fmt::format("hypothesis, n₀ = {:.3g} rpm from the measured points{}", fall_through, of), palette::faint, {}, {}};
    dashed.line_width = 1.4;
    dashed.dashed = true;
    for (int k = 0; k <= points; ++k) {
        const double speed = outflow.speeds.front() + (outflow.speeds.back() - outflow.speeds.front()) * k / points;
        dashed.x.push_back(speed);
        dashed.y.push_back(k_percent * hypothesis(outflow.at(speed), speed, fall_through));
    }
    return dashed;
}

struct DrawnLines {
    bool outflow = false, hypothesis = false;
};

/// Beside what heads that are fed all the time spill: what neutral rock would, from each run's own outflow, and, where there are tests to
/// fit it to, a hypothesis of what falls through at low speed.
DrawnLines add_outflow_lines(Plot& plot, const Comparison& comparison) {
    const Quantity* mixed = find_quantity(comparison, "well_mixed_spillage");
    DrawnLines drawn;
    if (!mixed) return drawn;
    for (const SpeedSeries& series : speed_series(comparison)) {
        const OutflowLine outflow = outflow_line(comparison, series, *mixed);
        if (series.same_speed || outflow.speeds.size() < 2) continue;
        drawn.outflow = true;
        const std::string of = series.what.empty() ? "" : ", " + series.what;
        Series line{"S_out: neutral rock" + of, palette::outflow, outflow.speeds, {}};
        line.line_width = 1.4;
        for (const double share : outflow.shares) line.y.push_back(k_percent * share);
        plot.series.push_back(line);
        const std::optional<double> fall_through = measured_fall_through(comparison, series, outflow);
        if (!fall_through) continue;
        plot.series.push_back(hypothesis_line(outflow, *fall_through, of));
        drawn.hypothesis = true;
    }
    return drawn;
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
               const TipFormat& tip) {
    const std::vector<std::string> bins = bins_of(comparison, what, unit);
    Plot plot;
    plot.name = what;
    plot.height = 90 + 22 * static_cast<int>(bins.size());
    plot.tips = Tips::at_y;
    plot.legend_title = "setting";
    plot.x.title = x_title;
    plot.x.tip = tip;
    plot.x.zero_line = true;
    plot.y.from = 0.4 - static_cast<double>(bins.size());
    plot.y.to = 0.6;
    plot.y.grid = false;
    for (const std::string& bin : bins) plot.y.ticks.push_back({-static_cast<double>(plot.y.ticks.size()), text::bin_text(bin)});
    for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
        Series series{fmt::format("{}", i + 1), setting_colour(i), {}, {}};
        series.mark = Mark::disc;
        series.mark_size = 6.0;
        series.line_width = 1.4;
        for (std::size_t b = 0; b < bins.size(); ++b) {
            const Estimate& estimate = find_quantity(comparison, bin_key(what, bins[b], unit))->settings[i];
            if (!estimate.value) continue;
            const double value = factor * *estimate.value, half = factor * estimate.half_width.value_or(0.0);
            series.x.push_back(value);
            series.y.push_back(-static_cast<double>(b));
            series.x_low.push_back(value - half);
            series.x_high.push_back(value + half);
            series.point_names.push_back(comparison.settings[i].label);
        }
        if (!series.x.empty()) plot.series.push_back(series);
    }
    return plot;
}

/// What shares of spilled rock are over.
const char* supplied_text(const Comparison& comparison) {
    return scope_of(comparison).fed_by_cutting ? "the fed mass" : "the placed mass";
}

/// Of all heads: a bin counts through which enough of the rock left any of them.
std::string top_bin_of(const Comparison& comparison) {
    return top_bin(comparison.runs.front().run.bins, [&](const std::string& bin) {
        double largest = 0.0;
        if (const Quantity* spilled = find_quantity(comparison, bin_key("spilled", bin, "share")))
            for (const Estimate& share : spilled->settings) largest = std::max(largest, share.value.value_or(0.0));
        return largest;
    });
}

Plot top_bin_plot(const Comparison& comparison, const Quantity& spilled, const Quantity& outflow) {
    Plot plot =
        share_plot("top_bin", "mean radial velocity in the top bin, m/s", fmt::format("spilled there, % of {}", supplied_text(comparison)));
    plot.x.tip = {".3f", " m/s"};
    double highest = 1.0;  // [%]; where nothing is spilled the axis still shows what a little would be
    double slowest = 0.0, fastest = 0.0;
    for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
        const Estimate &x = outflow.settings[i], &y = spilled.settings[i];
        if (!x.value || !y.value) continue;
        Series series{fmt::format("{}", i + 1), setting_colour(i), {}, {}};
        series.mark = Mark::disc;
        add_point(series, comparison, i, *x.value, y, k_percent);
        const double half = x.half_width.value_or(0.0);
        series.x_low = {*x.value - half};
        series.x_high = {*x.value + half};
        highest = std::max(highest, 1.1 * series.y_high.front());
        slowest = std::min(slowest, series.x_low.front());
        fastest = std::max(fastest, series.x_high.front());
        plot.series.push_back(series);
    }
    plot.legend_title = "setting";
    plot.y.to = highest;
    add_onset_band(plot, slowest, fastest);
    return plot;
}

/// None of a text that is no number.
std::optional<double> number_of(const std::string& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional<double>(value) : std::nullopt;
}

/// The chosen keys with numbers, besides those that have a trend of their own, in which two settings differ alone.
std::vector<Against> other_trends(const Comparison& comparison) {
    std::vector<Against> trends;
    for (const auto& [key, values] : chosen_keys(comparison)) {
        if (key == k_rotor_speed_key || key == k_discharge_key || key == k_swing_speed_key) continue;
        Quantity quantity{key, key, "", false, {}, {}};
        for (const std::string& value : values) quantity.settings.push_back({number_of(value), {}, {}, {}});
        if (!varies(quantity) || !joins_settings(comparison, quantity)) continue;
        std::string name = key;
        std::replace_if(
            name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
        trends.push_back({quantity, key, name, key, {".4g", ""}, key});
    }
    return trends;
}

std::vector<Figure> rock_figures(const Comparison& comparison) {
    const bool fed = scope_of(comparison).fed_by_cutting;
    const std::string shares = fed ? "Spillage, 1 − delivered / fed, and production, delivered / fed, by mass"
                                   : "Spillage ratio, spilled / (spilled + sucked up), and production, sucked up / placed, by mass";
    const std::string bars = fed ? "; bars are 95 % intervals. Spillage is not drawn while the hold-up still changes; the table has its "
                                   "bounds and the hold-up." +
                                       changing_text(comparison)
                                 : "; bars are bounds: what the undecided rock could still do.";
    std::vector<Figure> figures{{shares_plot(comparison), shares + ", of every setting" + bars, ""}};
    const Quantity &speed = *find_quantity(comparison, quantity::k_speed), &flow_number = *find_quantity(comparison, "flow_number");
    const Quantity* delivered = find_quantity(comparison, quantity::k_delivered);
    const bool drawn_delivery = delivered && std::any_of(delivered->settings.begin(), delivered->settings.end(),
                                                         [](const Estimate& estimate) { return estimate.value.has_value(); });
    const auto add_trend = [&](const Against& against, bool with_measured) {
        Plot plot = trend_plot(comparison, against);
        if (with_measured) add_measured_points(plot, comparison);
        const DrawnLines lines = with_measured && fed ? add_outflow_lines(plot, comparison) : DrawnLines{};
        figures.push_back(with_legend_that_fits(
            plot,
            shares + ", against " + against.what + bars + (with_measured && !comparison.measured.empty() ? " Crosses are measured." : "") +
                (lines.outflow ? " Line: S<sub>out</sub>, what neutral rock would spill with each run’s own outflow." : "") +
                (lines.hypothesis
                     ? " Dashed, a hypothesis and no result: 1 − (1 − S<sub>out</sub>) exp(−(n<sub>0</sub>/n)²), rock that falls through "
                       "between two blades below the speed n<sub>0</sub>, which is fitted to the measured points and not to the runs."
                     : "")));
        if (drawn_delivery)
            figures.push_back(
                with_legend_that_fits(delivered_plot(comparison, against),
                                      "Soil delivered per hour, in its volume in the bank and in the model’s scale, against " +
                                          against.what + "; bars are 95 % intervals." + changing_text(comparison)));
    };
    if (varies(speed) || !comparison.measured.empty())
        add_trend({speed, k_rotor_speed_key, "speed", "rotor speed, rpm", {".3g", " rpm"}, "the rotor’s speed"}, true);
    if (const Quantity& swing = *find_quantity(comparison, quantity::k_swing); varies(swing))
        add_trend({swing, k_swing_speed_key, "swing_speed", "swing speed, m/min", {".3g", " m/min"}, "the swing speed"}, false);
    if (varies(flow_number)) {
        // At one speed the flow number varies with the discharge, along a curve.
        const char* key = varies(speed) ? k_rotor_speed_key : k_discharge_key;
        const Against against{flow_number, key, "flow_number", "flow number Q / (ω R³)", {".4f", ""}, ""};
        figures.push_back(with_legend_that_fits(trend_plot(comparison, against),
                                                shares + ", against the flow number (discharge Q, rotor speed ω, ring radius R)" + bars));
    }
    for (const Against& against : other_trends(comparison)) add_trend(against, false);
    for (const Figure& map : delivered_maps(comparison)) figures.push_back(map);
    const std::string top = top_bin_of(comparison);
    const Quantity *spilled = find_quantity(comparison, bin_key("spilled", top, "share")),
                   *outflow = find_quantity(comparison, bin_key("outflow", top, "m_s"));
    if (spilled && outflow) {
        figures.push_back(with_legend_that_fits(
            top_bin_plot(comparison, *spilled, *outflow),
            fmt::format("Rock that left the head for the last time in the top bin, the uppermost through which a hundredth or more "
                        "of the rock left any head ({}), against the mean radial velocity just outside it; a colour a setting; "
                        "bars: 95 % intervals where they are known. {}",
                        text::bin_text(top), onset_band_text())));
    }
    figures.push_back(with_legend_that_fits(
        bins_plot(comparison, "spilled", "share", 100.0, fmt::format("spilled, % of {}", supplied_text(comparison)), {".2f", " %"}),
        "Spilled mass by the axial bin of the last exit (distance below the ring; “gap” lies between ring and backplate)."));
    return figures;
}

}  // namespace

const char* setting_colour(std::size_t setting) {
    return k_colours[setting % std::size(k_colours)];
}

std::vector<Figure> comparison_figures(const Comparison& comparison) {
    std::vector<Figure> figures;
    if (find_quantity(comparison, quantity::k_spillage)) figures = rock_figures(comparison);
    if (bins_of(comparison, "outflow", "m_s").empty()) return figures;
    figures.push_back(with_legend_that_fits(
        bins_plot(comparison, "outflow", "m_s", 1.0, "mean radial velocity, m/s (outwards positive)", {".3f", " m/s"}),
        "Radial velocity just outside the contour by axial bin, averaged over azimuth and time; bars: 95 % interval by batch means."));
    return figures;
}

}  // namespace cutterflow::postproc
