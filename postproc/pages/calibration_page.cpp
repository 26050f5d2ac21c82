#include "postproc/pages/calibration_page.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/file_content.hpp"
#include "geometry/base/statistics/sample.hpp"
#include "postproc/draw/gnuplot.hpp"
#include "postproc/draw/head/isoline.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/draw/page.hpp"

namespace cutterflow::postproc {

namespace {

namespace fs = std::filesystem;
using namespace calibration;

constexpr std::size_t k_slice_points = 61;

/// Objectives of single repeats; empty when the targets have different numbers of them.
std::vector<double> objectives_of_repeats(const Calibration& calibration, const Evaluation& evaluation) {
    const std::vector<Target>& fitted = calibration.targets.fitted;
    const std::size_t repeats = evaluation.values.front().size();
    for (std::size_t t = 0; t < fitted.size(); ++t)
        if (evaluation.values[t].size() != repeats) return {};
    std::vector<double> objectives;
    for (std::size_t n = 0; n < repeats; ++n) {
        std::vector<std::vector<double>> model;
        for (std::size_t t = 0; t < fitted.size(); ++t) model.push_back(evaluation.values[t][n]);
        objectives.push_back(objective_of(*calibration.objective, fitted, model));
    }
    return objectives;
}

std::string run_tip(const Outcome& outcome, std::size_t i) {
    const std::vector<double> each = objectives_of_repeats(outcome.calibration, outcome.calibration.evaluations[i]);
    std::string tip = fmt::format("objective {:.3g}", outcome.objectives[i]);
    if (each.size() > 1)
        tip += fmt::format(", single runs {:.3g} to {:.3g}", *std::min_element(each.begin(), each.end()),
                           *std::max_element(each.begin(), each.end()));
    return tip;
}

Series points(const std::string& name, const char* colour, Mark mark, double size) {
    Series series;
    series.name = name;
    series.colour = colour;
    series.mark = mark;
    series.mark_size = size;
    return series;
}

Series line(const std::string& name, const char* colour, double width, bool dashed = false) {
    Series series;
    series.name = name;
    series.colour = colour;
    series.line_width = width;
    series.dashed = dashed;
    return series;
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

/// Deviation of single runs from the mean of their place, in the unit of the objective: half of what an error bar shows.
double deviation(const std::vector<double>& values) {
    return values.size() > 1 ? std::sqrt(sample_of(values).variance) : 0.0;
}

Axis parameter_axis(const Range& range) {
    Axis axis;
    axis.title = range.name;
    axis.tip = {".4g", ""};
    axis.from = range.low;
    axis.to = range.high;
    return axis;
}

Field objective_field(const Map& map, double darkest) {
    Field field{{}, {}, map.objective, std::max(darkest, 1e-300), "objective", {".3g", ""}};
    for (const double y : map.y)
        for (const double x : map.x) {
            field.x.push_back(x);
            field.y.push_back(y);
        }
    return field;
}

Figure map_figure(const Outcome& outcome, const Map& map) {
    const std::vector<Range>& ranges = outcome.calibration.ranges;
    Plot plot;
    plot.name = fmt::format("map_{}_{}", map.first, map.second);
    plot.width = 620;
    plot.height = 460;
    plot.x = parameter_axis(ranges[map.first]);
    plot.y = parameter_axis(ranges[map.second]);
    plot.tips = Tips::at_point;
    const double darkest = median(map.objective);
    plot.field = objective_field(map, darkest);
    for (const double share : {0.1, 0.25, 0.5, 1.0, 2.0}) {
        Series level = line("", palette::faint, 0.8);
        const Isoline found = isoline(map.x, map.y, map.objective, share * darkest);
        level.x = found.x;
        level.y = found.y;
        if (!level.x.empty()) plot.series.push_back(std::move(level));
    }
    Series edge = line("edge of the 95 % region", palette::spilled, 2.0);
    const Isoline region = isoline(map.region_x, map.region_y, map.distance, 1.0);
    edge.x = region.x;
    edge.y = region.y;
    if (!edge.x.empty()) plot.series.push_back(std::move(edge));
    Series runs = points("runs", palette::ink, Mark::ring, 8.0);
    for (std::size_t i = 0; i < outcome.objectives.size(); ++i) {
        const Eigen::VectorXd& at = outcome.calibration.evaluations[i].parameters;
        runs.x.push_back(at[static_cast<Eigen::Index>(map.first)]);
        runs.y.push_back(at[static_cast<Eigen::Index>(map.second)]);
        runs.point_names.push_back(run_tip(outcome, i));
    }
    plot.series.push_back(std::move(runs));
    Series best = points("chosen", palette::spilled, Mark::diamond, 11.0);
    best.x = {outcome.parameters[static_cast<Eigen::Index>(map.first)]};
    best.y = {outcome.parameters[static_cast<Eigen::Index>(map.second)]};
    plot.series.push_back(std::move(best));
    const std::string others = ranges.size() > 2 ? " Other parameters are at their best." : "";
    return {
        std::move(plot),
        fmt::format("Objective of the quadratic fit, light where it is least, with contours at {:.3g}, {:.3g}, {:.3g}, {:.3g} and {:.3g}; "
                    "rings are the places that were run.{}",
                    0.1 * darkest, 0.25 * darkest, 0.5 * darkest, darkest, 2.0 * darkest, others),
        ""};
}

/// The objective along one parameter, with every place that was run and the scatter of its repeats.
Figure profile_figure(const Outcome& outcome, std::size_t k) {
    const Range& range = outcome.calibration.ranges[k];
    Plot plot;
    plot.name = fmt::format("objective_{}", k);
    plot.x = parameter_axis(range);
    plot.y.title = "objective";
    plot.y.tip = {".3g", ""};
    plot.y.from = 0.0;
    plot.tips = Tips::at_point;
    if (outcome.estimate) {
        if (const ParameterInterval* interval = outcome.interval(k))
            plot.bands.push_back({interval->low, interval->high, "#fbe6da", "95 %"});
        Series fit = line("fit, others at their best", palette::sucked_up, 1.6);
        fit.x = outcome.estimate->profiles[k].x;
        fit.y = outcome.estimate->profiles[k].objective;
        plot.series.push_back(std::move(fit));
    }
    Series runs = points("runs, with the scatter of repeats", palette::ink, Mark::ring, 7.0);
    for (std::size_t i = 0; i < outcome.objectives.size(); ++i) {
        const Evaluation& evaluation = outcome.calibration.evaluations[i];
        const double half = deviation(objectives_of_repeats(outcome.calibration, evaluation));
        runs.x.push_back(evaluation.parameters[static_cast<Eigen::Index>(k)]);
        runs.y.push_back(outcome.objectives[i]);
        runs.y_low.push_back(std::max(0.0, outcome.objectives[i] - half));
        runs.y_high.push_back(outcome.objectives[i] + half);
        runs.point_names.push_back(run_tip(outcome, i));
    }
    plot.series.push_back(std::move(runs));
    return {std::move(plot),
            fmt::format("Objective against {}: all places, with the standard deviation of single runs.", html::escape(range.name)), ""};
}

/// Adds the mean and the scatter of a target's runs at one place.
void add_runs(Series& series, const Evaluation& evaluation, std::size_t t, std::size_t k) {
    std::vector<double> values;
    for (const std::vector<double>& repeat : evaluation.values[t]) values.push_back(repeat.front());
    const double mean = sample_of(values).mean, half = deviation(values);
    series.x.push_back(evaluation.parameters[static_cast<Eigen::Index>(k)]);
    series.y.push_back(mean);
    series.y_low.push_back(mean - half);
    series.y_high.push_back(mean + half);
}

/// What a fitted target's measure does along a parameter.
Figure target_figure(const Outcome& outcome, std::size_t t, std::size_t k) {
    const Calibration& calibration = outcome.calibration;
    const Target& target = calibration.targets.fitted[t];
    const Range& range = calibration.ranges[k];
    Plot plot;
    plot.name = fmt::format("target_{}_{}", t, k);
    plot.x = parameter_axis(range);
    plot.y.title = target.name;
    plot.y.tip = {".4g", ""};
    plot.tips = Tips::at_point;
    const double value = target.values.front();
    plot.areas.push_back({"target",
                          "#dcece6",
                          {range.low, range.high},
                          {value - target.tolerance, value - target.tolerance},
                          {value + target.tolerance, value + target.tolerance}});
    if (outcome.estimate) {
        const Surface surface(calibration.ranges, calibration.targets.fitted, calibration.evaluations);
        Series fit = line("fit through the chosen parameters", palette::sucked_up, 1.6);
        Eigen::VectorXd parameters = outcome.parameters;
        for (std::size_t i = 0; i < k_slice_points; ++i) {
            const double x = range.low + (range.high - range.low) * static_cast<double>(i) / (k_slice_points - 1);
            parameters[static_cast<Eigen::Index>(k)] = x;
            fit.x.push_back(x);
            fit.y.push_back(surface.model(scaled(calibration.ranges, parameters))[t][0]);
        }
        plot.series.push_back(std::move(fit));
    }
    Series runs = points("runs, with the scatter of repeats", palette::ink, Mark::ring, 7.0);
    for (const Evaluation& evaluation : calibration.evaluations) add_runs(runs, evaluation, t, k);
    plot.series.push_back(std::move(runs));
    if (outcome.answer && !outcome.answer->values[t].empty()) {
        Series answer = points("runs at the chosen parameters", palette::spilled, Mark::diamond, 11.0);
        add_runs(answer, *outcome.answer, t, k);
        plot.series.push_back(std::move(answer));
    }
    return {std::move(plot),
            fmt::format("{} against {}: mean and standard deviation of repeats.", html::escape(target.name), html::escape(range.name)), ""};
}

Figure heights_figure(const Agreement& agreement, std::size_t t) {
    Plot plot;
    plot.name = fmt::format("profile_{}", t);
    plot.x = {"place of the profile [-]", {".0f", ""}};
    plot.y = {"height [m]", {".4g", " m"}};
    Series target = line("target", palette::outflow, 2.0), model = line("runs at the chosen parameters", palette::sucked_up, 1.6, true);
    const auto add = [](Series& series, const std::vector<double>& heights) {
        for (std::size_t i = 0; i < heights.size(); ++i) {
            series.x.push_back(static_cast<double>(i + 1));
            series.y.push_back(heights[i]);
        }
    };
    add(target, agreement.target);
    add(model, agreement.model);
    plot.series = {std::move(target), std::move(model)};
    return {std::move(plot), fmt::format("{}: heights of the target and at the chosen parameters.", html::escape(agreement.name)), ""};
}

std::string answers(const Outcome& outcome) {
    std::string markup;
    for (std::size_t k = 0; k < outcome.calibration.ranges.size(); ++k) {
        const ParameterInterval* interval = outcome.interval(k);
        const bool determined = interval == nullptr || interval->determined();
        markup += html::answer(determined ? palette::sucked_up : palette::never_entered, html::escape(outcome.calibration.ranges[k].name),
                               fmt::format("{:.3g}", outcome.parameters[static_cast<Eigen::Index>(k)]), known_text(outcome, k));
    }
    markup += html::answer(palette::faint, "cost", fmt::format("{:.3g} core h", outcome.calibration.cost.core_h),
                           fmt::format("{} runs, {} failed", outcome.calibration.cost.runs, outcome.calibration.cost.failed_runs));
    return "<div class=\"answers\">" + markup + "</div>";
}

std::string agreement_table(const Outcome& outcome, bool held_out) {
    std::vector<std::vector<std::string>> rows;
    for (const Agreement& agreement : outcome.agreements) {
        if (agreement.held_out != held_out) continue;
        const bool single = agreement.target.size() == 1;
        const auto first = [&](const std::vector<double>& values) {
            return single && !values.empty() ? fmt::format("{:.4g}", values[0]) : std::string();
        };
        const auto error = [](const std::optional<double>& value) { return value ? fmt::format("{:.2g}", *value) : std::string(); };
        rows.push_back({html::escape(agreement.name), single ? first(agreement.target) : "profile",
                        fmt::format("{:.3g}", agreement.tolerance), fmt::format("{}", agreement.runs), first(agreement.model),
                        error(agreement.standard_error),
                        agreement.relative_error ? fmt::format("{:.1f} %", 100.0 * *agreement.relative_error) : "",
                        agreement.in_tolerances ? fmt::format("{:.2f}", *agreement.in_tolerances) : "", first(agreement.fit),
                        error(agreement.fit_standard_error)});
    }
    return html::scrolling(html::table({"target", "measured", "tolerance", "runs", "their mean", "standard error", "relative error",
                                        "error in tolerances", "by the fit", "standard error of the fit"},
                                       rows, true));
}

std::string held_out_section(const Outcome& outcome) {
    const bool any = std::any_of(outcome.agreements.begin(), outcome.agreements.end(), [](const Agreement& one) { return one.held_out; });
    if (!any) return "<p>No target was held out, so no run tests the chosen parameters on what they were not fitted to.</p>";
    return "<p>They were run at the chosen parameters alone.</p>" + agreement_table(outcome, true);
}

std::string direction_text(const Direction& direction, const std::vector<Range>& ranges) {
    std::vector<std::string> parts;
    for (std::size_t k = 0; k < ranges.size(); ++k)
        parts.push_back(fmt::format("{:+.2f} {}", direction.along[static_cast<Eigen::Index>(k)], html::escape(ranges[k].name)));
    return fmt::format("{}", fmt::join(parts, ", "));
}

std::string determined_section(const Outcome& outcome) {
    if (!outcome.estimate) return "<p>The places that were run do not determine a quadratic: no intervals.</p>";
    if (outcome.estimate->intervals.empty())
        return "<p>Each place was run once, and the quadratic has as many terms as there are places: it goes through all of them, and the "
               "scatter is unknown. Repeats or further places tell it.</p>";
    std::vector<std::vector<std::string>> rows;
    for (const Direction& direction : outcome.estimate->directions)
        rows.push_back({direction_text(direction, outcome.calibration.ranges), fmt::format("{:.2g}", direction.ratio),
                        direction.half_width < 100.0 ? fmt::format("{:.2f}", direction.half_width) : "over 100",
                        direction.determined() ? "determined" : "not determined"});
    std::string text = html::scrolling(html::table(
        {"direction (in half ranges)", "ratio of eigenvalues", "half of the 95 % interval, in half ranges", "by the targets"}, rows, true));
    text += "<p>A direction is not determined when its interval is as wide as the range: another measurement is needed, not more runs.</p>";
    if (outcome.estimate->contradiction > 1.0)
        text += fmt::format("<p>The targets contradict each other (least sum of squares {:.3g}): intervals are {:.2f} times as wide.</p>",
                            outcome.estimate->least_chi_squared, std::sqrt(outcome.estimate->contradiction));
    return text;
}

std::string cost_section(const Outcome& outcome) {
    const CalibrationCost& cost = outcome.calibration.cost;
    const auto of = [](const std::optional<double>& budget) { return budget ? fmt::format(" of {:.4g}", *budget) : std::string(); };
    return html::table(
        {"quantity", "value"},
        {{"method", html::escape(outcome.calibration.method)},
         {"objective", fmt::format("{}: {}", outcome.calibration.objective->name, html::escape(outcome.calibration.objective->equation))},
         {"places", fmt::format("{}", outcome.calibration.evaluations.size())},
         {"runs", fmt::format("{}{}", cost.runs, of(cost.budget_runs))},
         {"failed runs", fmt::format("{}", cost.failed_runs)},
         {"core hours", fmt::format("{:.4g}{}", cost.core_h, of(cost.budget_core_h))},
         {"ended because", html::escape(outcome.calibration.ended)}},
        true);
}

}  // namespace

std::vector<Figure> calibration_figures(const Outcome& outcome) {
    const Calibration& calibration = outcome.calibration;
    std::vector<Figure> figures;
    if (outcome.estimate)
        for (const Map& map : outcome.estimate->maps) figures.push_back(map_figure(outcome, map));
    for (std::size_t k = 0; k < calibration.ranges.size(); ++k) figures.push_back(profile_figure(outcome, k));
    for (std::size_t t = 0; t < outcome.agreements.size(); ++t) {
        if (outcome.agreements[t].target.size() > 1) {
            figures.push_back(heights_figure(outcome.agreements[t], t));
            continue;
        }
        if (outcome.agreements[t].held_out) continue;  // known at the chosen parameters alone
        for (std::size_t k = 0; k < calibration.ranges.size(); ++k) figures.push_back(target_figure(outcome, t, k));
    }
    return figures;
}

fs::path write_calibration(const Outcome& outcome, const fs::path& folder) {
    const nlohmann::json document = to_json(outcome);
    certify_objectives(document);
    write_file(folder / "calibration.json", document.dump(2) + "\n");
    const Page page(folder / "index.html", PageForm::live);
    std::string plots = "<p>gnuplot is not installed: no plots.</p>";
    if (gnuplot_is_installed()) {
        plots.clear();
        for (const Figure& figure : calibration_figures(outcome)) plots += page.draw(figure);
    }
    const std::string title = html::escape(outcome.calibration.name);
    const std::string body =
        fmt::format("<header><h1>{}</h1></header>\n", title) + answers(outcome) +
        html::section("Targets", "<p>Runs at the chosen parameters that had no part in the choice, beside the fit.</p>" +
                                     agreement_table(outcome, false)) +
        html::section("Held-out targets", held_out_section(outcome)) +
        html::section("What the targets determine", determined_section(outcome)) +
        html::section("Runs", "<div class=\"figures\">" + plots + "</div>") + html::section("Cost", cost_section(outcome));
    page.write(outcome.calibration.name, body, "");
    return folder / "index.html";
}

}  // namespace cutterflow::postproc
