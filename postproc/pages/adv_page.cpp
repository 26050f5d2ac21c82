#include "postproc/pages/adv_page.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "postproc/analysis/text.hpp"
#include "postproc/draw/gnuplot.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/draw/page.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using html::escape;

constexpr std::array<const char*, 3> k_colours{palette::outflow, palette::sucked_up, palette::spilled};
constexpr std::array<Mark, 3> k_marks{Mark::disc, Mark::square, Mark::triangle};

const AdvVelocity& velocity_of(const AdvResult& result, AdvComponent component) {
    return result.velocity[static_cast<std::size_t>(component)];
}

/// Half the height of a model value's bar: what position and chance together leave open.
double bar_of(const AdvVelocity& v) {
    return std::hypot(v.position_bar.value_or(0.0), 2.0 * v.statistical_error.value_or(0.0));
}

/// Model against measurement for the points inside or outside the head.
Figure scatter(const AdvComparison& comparison, bool inside) {
    Plot plot;
    plot.name = inside ? "inside" : "outside";
    plot.height = 480;
    plot.tips = Tips::at_point;
    plot.equal_scales = true;
    plot.x.title = "measured, m/s";
    plot.x.tip = {".3f", " m/s", "measured "};
    plot.y.title = "model, m/s";
    plot.y.tip = {".3f", " m/s", "model "};
    Series equal{"model = measured", palette::faint, {}, {}};
    equal.line_width = 1.0;
    plot.series.push_back(equal);
    double low = 0.0, high = 0.0;
    for (const AdvComponent c : k_adv_components) {
        const auto index = static_cast<std::size_t>(c);
        Series series{adv_component_name(c), k_colours[index], {}, {}};
        series.mark = k_marks[index];
        for (const AdvResult& result : comparison.points) {
            const AdvVelocity& v = velocity_of(result, c);
            if (result.inside != inside || !v.measured || !v.model) continue;
            series.x.push_back(*v.measured);
            series.y.push_back(*v.model);
            series.y_low.push_back(*v.model - bar_of(v));
            series.y_high.push_back(*v.model + bar_of(v));
            series.point_names.push_back(result.point.name);
            low = std::min({low, *v.measured, series.y_low.back()});
            high = std::max({high, *v.measured, series.y_high.back()});
        }
        if (!series.x.empty()) plot.series.push_back(series);
    }
    const double margin = 0.05 * std::max(high - low, 1e-3), from = low - margin, to = high + margin;
    plot.x.from = plot.y.from = from;
    plot.x.to = plot.y.to = to;
    plot.series.front().x = plot.series.front().y = {from, to};
    return {plot,
            fmt::format("{} the head. On the line model and measurement agree. Bars: position error and two standard errors of the mean "
                        "in time, root of the sum of squares.",
                        inside ? "Inside" : "Outside"),
            ""};
}

bool has_pairs(const AdvComparison& comparison, bool inside) {
    return agreement(comparison, inside).count > 0;
}

std::string plots(const AdvComparison& comparison, const Page& page) {
    if (!has_pairs(comparison, true) && !has_pairs(comparison, false))
        return "<p class=\"notice\">The file holds no measured velocities: only the model’s stand below.</p>\n";
    if (!gnuplot_is_installed()) return "<p class=\"notice\">Plots are missing: the program gnuplot was not found.</p>\n";
    std::string content;
    for (const bool inside : {true, false})
        if (has_pairs(comparison, inside)) content += page.draw(scatter(comparison, inside));
    return "<div class=\"figures\">" + content + "</div>\n";
}

std::string velocity_cell(const std::optional<double>& value) {
    return value ? fmt::format("{:.3f}", *value) : std::string(text::k_dash);
}

std::string agreement_table(const AdvComparison& comparison) {
    std::vector<std::vector<std::string>> rows;
    const auto add = [&](bool inside, std::optional<AdvComponent> component) {
        const AdvAgreement a = agreement(comparison, inside, component);
        if (a.count == 0) return;
        rows.push_back(
            {fmt::format("{} the head, {}", inside ? "inside" : "outside", component ? adv_component_name(*component) : "all components"),
             std::to_string(a.count), velocity_cell(a.bias), velocity_cell(a.rmse), velocity_cell(a.slope), text::percent(a.hit_rate)});
    };
    for (const bool inside : {true, false}) {
        add(inside, std::nullopt);
        for (const AdvComponent c : k_adv_components) add(inside, c);
    }
    if (rows.empty()) return "";
    return html::section(
        "Agreement",
        html::table({"", "values", "bias [m/s]", "RMSE [m/s]", "slope", "hit rate"}, rows, true) +
            "<p>Bias: mean of model less measurement. RMSE: root of the mean of its square. Slope: of the line through the origin, "
            "Σ PO / Σ O², model P, measurement O. Hit rate: share with |P − O| at most a quarter of |O|, or at most the position bar plus "
            "two "
            "standard errors.</p>\n");
}

/// A row a point: its name and place in the first cell, and in every other one three lines, one a component.
std::string point_table(const AdvComparison& comparison) {
    std::vector<std::vector<std::string>> rows;
    for (const AdvResult& result : comparison.points) {
        const Cylindrical& place = result.point.place;
        std::vector<std::string> row{
            fmt::format("{}<br>{:.0f} mm, {:.1f}°, {:.0f} mm<br>{}, {}, {}", escape(result.point.name), 1e3 * place.radius,
                        place.azimuth * 180.0 / k_pi, 1e3 * place.axial, result.point.rotating ? "rotating" : "still",
                        result.inside ? "inside" : "outside", text::percent(result.wet_share)),
            "",
            "",
            "",
            "",
            ""};
        for (const AdvComponent c : k_adv_components) {
            const AdvVelocity& v = velocity_of(result, c);
            const std::string line = c == k_adv_components.front() ? "" : "<br>";
            row[1] += line + adv_component_name(c);
            row[2] += line + velocity_cell(v.measured);
            row[3] += line + velocity_cell(v.model);
            row[4] += line + velocity_cell(v.position_bar);
            row[5] += line + velocity_cell(v.statistical_error);
        }
        rows.push_back(row);
    }
    return html::section("Points", html::table({"point<br>r, θ, z<br>frame, place by the head, share of time in water", "component",
                                                "measured [m/s]", "model [m/s]", "position ± [m/s]", "standard error [m/s]"},
                                               rows, true));
}

}  // namespace

fs::path write_adv_report(const AdvComparison& comparison, const fs::path& run_directory) {
    const fs::path file = run_directory / names::adv_page;
    const Page page(file, PageForm::live);
    const std::string title =
        fmt::format("{}: measured and computed velocities", escape(comparison.run.empty() ? "Cutter head" : comparison.run));
    std::string body =
        fmt::format("<header><h1>{}</h1><p>{:g} rpm, {:g} m³/s</p></header>\n", title, comparison.speed_rpm, comparison.discharge);
    body += fmt::format(
        "<p>The model is averaged over a cylinder {:g} mm across and {:g} mm long along the rotor’s axis, the volume of the instrument, "
        "and over the last {} "
        "whole revolution{}; while steel covers a place it does not count. Position ±: by how much the model’s mean changes within {:g} mm "
        "in the "
        "steepest direction. Standard error: of the mean in time, by batch means over the revolutions. Velocities at rotating points are "
        "relative to the "
        "head. Tangential is positive by the right hand about the axis from hub to ring.</p>\n",
        1e3 * comparison.probe.diameter, 1e3 * comparison.probe.length, comparison.revolutions, comparison.revolutions == 1 ? "" : "s",
        1e3 * comparison.probe.position_error);
    body += plots(comparison, page) + agreement_table(comparison) + point_table(comparison);
    write_file(run_directory / names::adv_json, adv_json(comparison).dump(2) + "\n");
    page.write(title, body, fmt::format("The same numbers for programs: adv.json ({}).", k_adv_schema));
    return file;
}

}  // namespace cutterflow::postproc
