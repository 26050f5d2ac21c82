#include "postproc/pages/measures/measure_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "postproc/analysis/measures/measure_run.hpp"
#include "postproc/draw/gnuplot.hpp"
#include "postproc/draw/html.hpp"

namespace cutterflow::postproc {

namespace {

using nlohmann::json;
using Numbers = std::vector<double>;

constexpr double k_gap = std::numeric_limits<double>::quiet_NaN();  ///< breaks a line
constexpr double k_mm = 1e3;

Numbers list(const json& values, double factor = 1.0) {
    Numbers numbers = values.get<Numbers>();
    for (double& number : numbers) number *= factor;
    return numbers;
}

double number(const json& object, const char* key) {
    return object.at(key).get<double>();
}

Series line(const std::string& name, const char* colour, Numbers x, Numbers y, double width = 1.6) {
    Series series{name, colour, std::move(x), std::move(y)};
    series.line_width = width;
    return series;
}

Series dashed(Series series) {
    series.dashed = true;
    return series;
}

Series marks(const std::string& name, const char* colour, Numbers x, Numbers y, Mark mark, double size) {
    Series series{name, colour, std::move(x), std::move(y)};
    series.mark = mark;
    series.mark_size = size;
    return series;
}

/// A plot of a measure; its name is fit for one.
Plot plot_of(const std::string& measure, Axis x, Axis y) {
    Plot plot;
    plot.name = "measure_" + measure;
    std::replace(plot.name.begin(), plot.name.end(), '-', '_');
    plot.x = std::move(x);
    plot.y = std::move(y);
    return plot;
}

/// 1, 2 or 5 times a power of ten, from `least` on.
double round_step(double least) {
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= least) return factor * power;
    return 10.0 * power;
}

/// As high as its content asks for, at equal scales and with equal ticks. \param width, height  of the content [mm], > 0
void to_scale(Plot& plot, double width, double height) {
    plot.equal_scales = true;
    plot.tips = Tips::at_point;
    plot.height = std::clamp(static_cast<int>(100.0 + 440.0 * height / width), 180, 620);
    plot.x.step = plot.y.step = round_step(width / 8.0);
}

/// Of a map whose cells' middles are given.
void to_scale(Plot& plot) {
    const auto [left, right] = std::minmax_element(plot.field->x.begin(), plot.field->x.end());
    const auto [low, high] = std::minmax_element(plot.field->y.begin(), plot.field->y.end());
    to_scale(plot, std::max(*right - *left, 1.0), std::max(*high - *low, 1.0));
}

Plot passed_plot(const std::string& name, const json& result) {
    Plot plot = plot_of(name, {"time [s]", {".3f", " s"}}, {"passed mass [kg]", {".4g", " kg"}});
    plot.series.push_back(line("passed", palette::rock_load, list(result["series"]["time_s"]), list(result["series"]["passed_kg"])));
    return plot;
}

std::optional<Plot> passed_mass_plot(const std::string& name, const json& result) {
    return passed_plot(name, result);
}

std::optional<Plot> rate_plot(const std::string& name, const json& result) {
    Plot plot = passed_plot(name, result);
    const json& fit = result["detail"];
    const Numbers ends{number(fit, "from_s"), number(fit, "to_s")};
    const double slope = number(fit, "slope_kg_s"), start = number(fit, "intercept_kg");
    plot.series.push_back(line("fitted slope", palette::spilled, ends, {start + slope * ends[0], start + slope * ends[1]}, 2.4));
    return plot;
}

std::optional<Plot> time_of_plot(const std::string& name, const json& result) {
    Plot plot = passed_plot(name, result);
    const double at = number(result, "value");
    const Numbers mass = list(result["series"]["passed_kg"]);
    plot.series.push_back(dashed(line("time", palette::spilled, {at, at}, {0.0, *std::max_element(mass.begin(), mass.end())})));
    return plot;
}

std::optional<Plot> profile_plot(const std::string& name, const json& result) {
    Plot plot = plot_of(name, {"place [mm]", {".1f", " mm"}}, {"height [mm]", {".1f", " mm"}});
    const json& series = result["series"];
    plot.series.push_back(line("measured in the run", palette::rock_load, list(series["place_m"], k_mm), list(series["height_m"], k_mm)));
    if (series.contains("given_place_m"))
        plot.series.push_back(
            dashed(line("given", palette::sucked_up, list(series["given_place_m"], k_mm), list(series["given_height_m"], k_mm))));
    return plot;
}

/// Silhouettes of all views, the first one darker, with the lines through its two sides.
std::optional<Plot> angle_plot(const std::string& name, const json& result) {
    if (result["series"]["silhouettes"].empty()) return std::nullopt;  // no grains lie above the base
    Plot plot = plot_of(name, {"distance from the axis [mm]", {".1f", " mm"}}, {"height [mm]", {".1f", " mm"}});
    const json &silhouettes = result["series"]["silhouettes"], &sides = result["detail"]["sides"];
    double reach = 0.0, top = 0.0;
    for (std::size_t n = silhouettes.size(); n-- > 0;) {
        const Numbers place = list(silhouettes[n]["place_m"], k_mm), height = list(silhouettes[n]["height_m"], k_mm);
        reach = std::max(reach, place.back() - place.front());
        top = std::max(top, *std::max_element(height.begin(), height.end()));
        plot.series.push_back(n == 0 ? line("silhouette", palette::ink, place, height)
                                     : line("", palette::never_entered, place, height, 0.6));
    }
    for (std::size_t n = 0; n < std::min<std::size_t>(2, sides.size()); ++n) {
        const double sign = n == 0 ? 1.0 : -1.0, from = number(sides[n], "from_m"), to = number(sides[n], "to_m");
        const double slope = number(sides[n], "slope"), start = number(sides[n], "intercept_m");
        plot.series.push_back(line(fmt::format("{:.1f} degrees", std::abs(number(sides[n], "angle_deg"))), palette::spilled,
                                   {sign * from * k_mm, sign * to * k_mm}, {(start + slope * from) * k_mm, (start + slope * to) * k_mm},
                                   2.4));
    }
    if (reach > 0.0) to_scale(plot, reach, top);
    return plot;
}

std::optional<Plot> cavity_plot(const std::string& name, const json& result) {
    if (!result["series"].is_object()) return std::nullopt;
    Plot plot = plot_of(name, {"x [mm]", {".1f", " mm"}}, {"y [mm]", {".1f", " mm"}});
    const json &map = result["series"], &detail = result["detail"];
    const int columns = map["columns"].get<int>(), rows = map["rows"].get<int>();
    const double cell = number(map, "cell_m");
    const Numbers height = list(map["height_m"]);
    Field field{{}, {}, {}, k_mm * number(detail, "depth_m"), "mm below", {".1f", " mm below"}};
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            field.x.push_back(k_mm * (number(map, "x0_m") + (i + 0.5) * cell));
            field.y.push_back(k_mm * (number(map, "y0_m") + (j + 0.5) * cell));
            field.value.push_back(std::max(0.0, k_mm * (number(detail, "undisturbed_m") - height[field.value.size()])));
        }
    }
    plot.field = field;
    Numbers x, y;
    for (const json& chord : detail["chords"]) {
        for (const json& end : chord) {
            x.push_back(k_mm * end[0].get<double>());
            y.push_back(k_mm * end[1].get<double>());
        }
        x.push_back(k_gap);
        y.push_back(k_gap);
    }
    plot.series.push_back(
        marks("outline", palette::spilled, list(map["outline_x_m"], k_mm), list(map["outline_y_m"], k_mm), Mark::square, 2.5));
    plot.series.push_back(line("chords", palette::ink, x, y, 0.9));
    to_scale(plot);
    return plot;
}

/// Middles of a grid's cells, row by row.
Field grid_field(const json& series, double darkest, const std::string& unit, const TipFormat& tip) {
    Field field{{}, {}, {}, darkest, unit, tip};
    for (const double z : list(series["rows_m"], k_mm)) {
        for (const double x : list(series["columns_m"], k_mm)) {
            field.x.push_back(x);
            field.y.push_back(z);
        }
    }
    return field;
}

std::optional<Plot> void_area_plot(const std::string& name, const json& result) {
    Plot plot = plot_of(name, {"along [mm]", {".1f", " mm"}}, {"up [mm]", {".1f", " mm"}});
    const json& series = result["series"];
    Field field = grid_field(series, 1.0, "void fraction", {".2f", ""});
    field.value = list(series["void_fraction"]);
    plot.field = field;
    if (!series["outline_row_m"].empty())
        plot.series.push_back(marks("outline", palette::spilled, list(series["outline_column_m"], k_mm),
                                    list(series["outline_row_m"], k_mm), Mark::square, 2.0));
    to_scale(plot);
    return plot;
}

/// Mean speed of the grains as colours, their direction as strokes from the cells' middles.
std::optional<Plot> velocity_plot(const std::string& name, const json& result) {
    if (!result["series"].is_object()) return std::nullopt;
    Plot plot = plot_of(name, {"along [mm]", {".1f", " mm"}}, {"up [mm]", {".1f", " mm"}});
    const json& series = result["series"];
    const Numbers u = list(series["velocity_along_columns_m_s"]), w = list(series["velocity_along_rows_m_s"]);
    Field field = grid_field(series, 0.0, "m/s", {".4f", " m/s"});
    for (std::size_t n = 0; n < u.size(); ++n) field.value.push_back(std::hypot(u[n], w[n]));
    field.darkest = *std::max_element(field.value.begin(), field.value.end());
    const double cell = series["columns_m"].size() > 1 ? field.x[1] - field.x[0] : 0.0;
    Numbers x, y;
    for (std::size_t n = 0; n < u.size() && field.darkest > 0.0; ++n) {
        if (field.value[n] < 0.05 * field.darkest) continue;
        x.insert(x.end(), {field.x[n], field.x[n] + cell * u[n] / field.darkest, k_gap});
        y.insert(y.end(), {field.y[n], field.y[n] + cell * w[n] / field.darkest, k_gap});
    }
    plot.field = field;
    if (!x.empty()) plot.series.push_back(line("direction", palette::ink, x, y, 0.9));
    to_scale(plot);
    return plot;
}

std::optional<Plot> spectrum_plot(const std::string& name, const json& result) {
    Plot plot = plot_of(name, {"frequency [Hz]", {".4g", " Hz"}}, {"power [signal² / Hz]", {".3g", ""}});
    const Numbers power = list(result["series"]["power"]);
    plot.series.push_back(line("power", palette::flow_load, list(result["series"]["frequency_hz"]), power));
    if (result.at("detail").at("peak_frequency_hz").is_null()) return plot;
    const double peak = number(result["detail"], "peak_frequency_hz");
    plot.series.push_back(
        dashed(line(fmt::format("{:.4g} Hz", peak), palette::spilled, {peak, peak}, {0.0, *std::max_element(power.begin(), power.end())})));
    return plot;
}

Plot signal_plot(const std::string& name, const json& result, const char* series, Axis y) {
    Plot plot = plot_of(name, {"time [s]", {".3f", " s"}}, std::move(y));
    plot.series.push_back(line("signal", palette::flow_load, list(result["series"]["time_s"]), list(result["series"][series]), 1.0));
    const double mean = number(result, "value");
    plot.series.push_back(
        line("mean", palette::spilled, {number(result["detail"], "from_s"), number(result["detail"], "to_s")}, {mean, mean}, 2.4));
    return plot;
}

std::optional<Plot> force_plot(const std::string& name, const json& result) {
    return signal_plot(name, result, "force_n", {"force [N]", {".4g", " N"}});
}

std::optional<Plot> pressure_plot(const std::string& name, const json& result) {
    return signal_plot(name, result, "pressure_pa", {"pressure drop [Pa]", {".4g", " Pa"}});
}

struct Drawing {
    const char* what;
    std::optional<Plot> (*draw)(const std::string& name, const json& result);
    bool needs_value;  ///< without a value there is nothing to draw
    const char* caption;
};

constexpr Drawing k_drawings[] = {
    {"passed_mass", passed_mass_plot, true, "mass that has passed"},
    {"rate", rate_plot, true, "mass that has passed, and the line through it in the window"},
    {"time_of", time_of_plot, true, "mass that has passed, and the time of the share"},
    {"profile", profile_plot, true, "upper envelope of the grains seen from the side"},
    {"profile_error", profile_plot, true, "upper envelope of the grains, and the given profile"},
    {"angle", angle_plot, false, "silhouettes of all views, and the lines through both sides of the first"},
    {"cavity", cavity_plot, true, "depth below the undisturbed level, outline of the area half a mean diameter below it, and chords"},
    {"void_area", void_area_plot, true, "void fraction, and the outline of the area above the threshold"},
    {"bed_velocity", velocity_plot, true, "mean velocity of the grains"},
    {"spectrum", spectrum_plot, false, "Welch's periodogram"},
    {"wall_force", force_plot, true, "force of rock on the wall, and its mean in the window"},
    {"pressure_drop", pressure_plot, true, "difference of the pressures, and its mean in the window"},
};

/// Why there is no value, or what it leaves out.
std::string remark_of(const json& detail) {
    if (detail.contains("reason")) return detail.at("reason").get<std::string>();
    return detail.value("reaches_border", false) ? "it reaches the border of what is looked at" : "";
}

}  // namespace

std::vector<Figure> measure_figures(const json& results) {
    std::vector<Figure> figures;
    for (const auto& [name, result] : results.items()) {
        const auto what = result.at("what").get<std::string>();
        const auto drawing =
            std::find_if(std::begin(k_drawings), std::end(k_drawings), [&](const Drawing& one) { return one.what == what; });
        if (drawing == std::end(k_drawings) || (drawing->needs_value && result.at("value").is_null())) continue;
        if (result.value("series", json()).is_null()) continue;  // it could not be made
        if (std::optional<Plot> plot = drawing->draw(name, result))
            figures.push_back({std::move(*plot), fmt::format("{}: {}.", html::escape(name), drawing->caption), ""});
    }
    return figures;
}

std::string measures_section(const Page& page, const json& results) {
    std::vector<std::vector<std::string>> rows;
    for (const auto& [name, result] : results.items())
        rows.push_back({html::escape(name), html::escape(result.at("what").get<std::string>()), html::escape(measure_value_text(result)),
                        html::escape(remark_of(result.at("detail")))});
    std::string body = html::scrolling(html::table({"measure", "what", "value ± standard error", "remark"}, rows, false));
    if (gnuplot_is_installed()) {
        std::string plots;
        for (const Figure& figure : measure_figures(results)) plots += page.draw(figure);
        body += "<div class=\"figures\">" + plots + "</div>";
    } else {
        body += "<p>gnuplot is not installed: no plots.</p>";
    }
    return html::section("Measures", body);
}

}  // namespace cutterflow::postproc
