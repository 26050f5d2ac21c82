#include "postproc/pages/free_surface/surface_page.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "geometry/base/json_document.hpp"
#include "geometry/base/progress.hpp"
#include "geometry/base/run_files.hpp"
#include "postproc/analysis/surface_results.hpp"
#include "postproc/draw/gnuplot.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/draw/page.hpp"
#include "postproc/pages/free_surface/surface_pictures.hpp"

namespace cutterflow::postproc {

namespace {

namespace fs = std::filesystem;

constexpr const char* k_not_modelled =
    "Not modelled: in a plane scene the third dimension; air and trapped bubbles, surface tension, turbulence, leakage at the ends of the "
    "cylinders. Bodies hold the water at their surface (no slip); along walls and solids that stand still it slips.";
constexpr const char* k_lost_arrivals =
    "The measured curves of columns that collapse [Zhang et al. 2009] are not available here, nor those of [Chen et al. 2019], who say "
    "that cylinders arrive within half a second: no arrival is compared with them, and no number was tuned to one.";

std::string paragraph(const std::string& text) {
    return "<p>" + text + "</p>";
}

std::vector<double> scaled(std::vector<double> values, double factor) {
    for (double& value : values) value *= factor;
    return values;
}

Series line(const std::string& name, const char* colour, const std::vector<double>& x, std::vector<double> y) {
    Series series;
    series.name = name;
    series.colour = colour;
    series.x = x;
    series.y = std::move(y);
    series.line_width = 1.6;
    return series;
}

Plot plot_over_time(const std::string& name, const std::string& y_title, const std::string& digits, std::vector<Series> series) {
    Plot plot;
    plot.name = name;
    plot.x = {"time [s]", {".3f", " s"}};
    plot.y = {y_title, {digits, ""}};
    plot.series = std::move(series);
    return plot;
}

/// A curve of each gauge; those without a value (NaN) are left out.
std::vector<Series> gauge_curves(const SurfaceRows& rows, const char* column, double factor) {
    static const char* const colours[] = {palette::sucked_up, palette::spilled,   palette::outflow,
                                          palette::rock_load, palette::flow_load, palette::never_entered};
    const Table& table = rows.gauges;
    std::vector<Series> curves;
    for (std::size_t n = 0; n < table.rows(); ++n) {
        const double value = table.number(column)[n];
        if (std::isnan(value)) continue;
        const std::string& name = table.text("gauge")[n];
        auto curve = std::find_if(curves.begin(), curves.end(), [&](const Series& series) { return series.name == name; });
        if (curve == curves.end()) curve = curves.insert(curves.end(), line(name, colours[curves.size() % std::size(colours)], {}, {}));
        curve->x.push_back(table.number("time_s")[n]);
        curve->y.push_back(factor * value);
    }
    return curves;
}

/// The plots of a page; a row each.
std::vector<Figure> figures(const SurfaceRows& rows) {
    const Table &levels = rows.levels, &balance = rows.balance;
    const std::vector<double>& time = levels.number("time_s");
    const auto column = [&](const char* name, double factor) { return scaled(levels.number(name), factor); };
    std::vector<Figure> result;
    const auto add = [&](Plot plot, const std::string& caption) { result.push_back({std::move(plot), caption, ""}); };
    if (rows.has_pipe()) {
        add(plot_over_time("levels", "level [mm]", ".1f",
                           {line("in the pipe", palette::sucked_up, time, column("level_in_pipe_m", 1e3)),
                            line("outside", palette::spilled, time, column("level_m", 1e3))}),
            "Level in the pipe and outside, means over the columns of cells.");
        add(plot_over_time("flows", "flow into the pipe [L/s]", ".3f",
                           {line("mouth, upwards", palette::sucked_up, time, column("mouth_flow_m3_s", 1e3)),
                            line("holes", palette::outflow, time, column("hole_flow_m3_s", 1e3))}),
            "Flow of water through the mouth and through all holes.");
        if (rows.has_bodies()) {
            add(plot_over_time("rise", "mean upward speed [m/s]", ".3f",
                               {line("bodies in the pipe", palette::rock_load, time, column("rise_in_pipe_m_s", 1.0))}),
                "Mean vertical velocity of the bodies that are still in the pipe.");
            std::vector<double> out = levels.number("bodies_in_pipe");
            for (double& count : out) count = rows.scene.at("bodies").get<double>() - count;
            add(plot_over_time("out", "bodies below the mouth [-]", ".0f", {line("bodies", palette::rock_load, time, out)}),
                "Bodies that have left the pipe.");
        }
    } else {
        add(plot_over_time("levels", "level [mm]", ".1f", {line("mean level", palette::sucked_up, time, column("level_m", 1e3))}),
            "Mean level of the tank: where air first stands over water.");
    }
    if (auto curves = gauge_curves(rows, "level_m", 1e3); !curves.empty())
        add(plot_over_time("gauge_levels", "level [mm]", ".1f", std::move(curves)),
            "Level at the gauges: where air first stands over water.");
    if (auto curves = gauge_curves(rows, "pressure_pa", 1.0); !curves.empty())
        add(plot_over_time("gauge_pressures", "pressure [Pa]", ".0f", std::move(curves)), "Pressure at the gauges, over that of the air.");
    if (rows.has_bodies()) {
        const double width = rows.scene.at("width_m").get<double>();
        add(plot_over_time("places", "mean place over the width [-]", ".4f",
                           {line("x/L", palette::sucked_up, time, column("mean_x_m", 1.0 / width)),
                            line("z/L", palette::spilled, time, column("mean_z_m", 1.0 / width))}),
            "Mean place of all bodies.");
    }
    add(plot_over_time("volume", "occupied volume lost or won [%]", ".3f",
                       {line("volume", palette::flow_load, balance.number("time_s"), scaled(balance.number("volume_error"), 100.0))}),
        "Water that clumps occupies less than it is: at most 2 % may be lost or won.");
    add(plot_over_time("energy", "energy of the water [J]", ".4f",
                       {line("energy", palette::outflow, balance.number("time_s"), balance.number("energy_j"))}),
        "Kinetic, and in gravity from the floor.");
    return result;
}

std::string seconds(double value) {
    return std::isfinite(value) ? fmt::format("{:.3f} s", value) : std::string("not yet");
}

std::string answers(const SurfaceRows& rows, const SurfaceResults& results) {
    std::string markup;
    if (rows.has_pipe() && rows.has_bodies()) {
        markup += html::answer(palette::sucked_up, "half of the bodies out of the pipe", seconds(results.half_out_s), "");
        markup += html::answer(palette::sucked_up, "all bodies out of the pipe", seconds(results.all_out_s), "");
    } else if (rows.has_bodies()) {
        markup += html::answer(palette::sucked_up, "first body at the right wall", seconds(results.arrival_s),
                               "one body alone, chaotic: repeat with other seeds");
    }
    if (rows.has_pipe())
        markup += html::answer(
            palette::outflow, "greatest drop of the level in the pipe", fmt::format("{:.0f} mm", 1e3 * results.greatest_drop_m),
            fmt::format("below the outside, at {:.3f} s; flow turns at {}", results.drop_at_s, seconds(results.reversal_s)));
    markup +=
        html::answer(palette::flow_load, "occupied volume", fmt::format("{:+.2f} %", 100.0 * results.volume_error), "worst of all steps");
    markup += html::answer(palette::faint, "cost", duration_text(results.core_s), "on one core");
    return "<div class=\"answers\">" + markup + "</div>";
}

std::string cost_table(const SurfaceRows& rows, const SurfaceResults& results, const fs::path& run_directory) {
    const auto sum = [&](const char* column) {
        const std::vector<double>& values = rows.balance.number(column);
        return std::accumulate(values.begin(), values.end(), 0.0);
    };
    const auto mean = [&](const char* column) { return sum(column) / static_cast<double>(std::max<std::size_t>(1, rows.balance.rows())); };
    std::vector<std::vector<std::string>> lines{
        {"simulated time", fmt::format("{:.4f} of {:g} s", results.end_s, rows.scene.at("end_s").get<double>())},
        {"steps", fmt::format("{}", rows.balance.rows())},
        {"core seconds", fmt::format("{:.1f}", results.core_s)},
        {"iterations of the pressure, mean of a step", fmt::format("{:.1f}", mean("pressure_iterations"))},
        {"particles put out of solids, mean of a step", fmt::format("{:.1f}", mean("pushed_out"))}};
    const auto largest = [&](const char* column, const char* what, double factor, const char* unit) {
        if (const std::vector<double>* values = counted(rows.balance, column); values && !values->empty())
            lines.push_back({what, fmt::format("{:.2g}{}", factor * *std::max_element(values->begin(), values->end()), unit)});
    };
    largest("deepest_m", "their farthest way out", 1e3, " mm");
    largest("pressure_impulse_error_n_s", "momentum that the pressure makes in a step, largest", 1.0, " N s");
    if (rows.has_bodies()) largest("body_impulse_error", "share of the pressure's impulse that bodies did not take, largest", 1.0, "");
    if (rows.has_bodies() && counted(rows.balance, "gap_impulse_n_s"))
        lines.push_back({"momentum that the damping of gaps took out, sum", fmt::format("{:.3g} N s", sum("gap_impulse_n_s"))});
    if (rows.has_pipe()) lines.push_back({"particles through the pipe's wall", fmt::format("{:.0f}", results.through_walls)});
    if (const std::vector<double>* waters = counted(rows.balance, "enclosed_waters")) {
        const auto steps = std::count_if(waters->begin(), waters->end(), [](double count) { return count > 0.0; });
        if (steps > 0) lines.push_back({"steps with closed water, its mean pressure at 0", fmt::format("{}", steps)});
    }
    if (fs::exists(run_directory / names::prediction)) {
        const nlohmann::json predicted =
            read_json_document(run_directory / names::prediction, {{"steps", JsonKind::number, true}, {"core_s", JsonKind::number, true}},
                               "Run it again, or remove the file");
        lines.push_back({"steps predicted", fmt::format("{:.0f}", predicted.at("steps").get<double>())});
        lines.push_back({"core seconds predicted", fmt::format("{:.0f}", predicted.at("core_s").get<double>())});
    }
    return html::table({"quantity", "value"}, lines, true);
}

/// What the numbers can be compared with, and what sizes stand for those that are lost.
std::string what_is_known(const SurfaceRows& rows) {
    std::string text;
    if (rows.has_bodies()) text += paragraph(k_lost_arrivals);
    if (!rows.has_pipe()) return text;
    const auto millimetres = [&](const char* key) {
        const nlohmann::json& pipe = rows.scene.at("pipe");
        return pipe.contains(key) ? fmt::format("{:g} mm", 1e3 * pipe.at(key).get<double>()) : std::string("not recorded");
    };
    return text +
           paragraph(fmt::format(
               "Pipe: inner width {}, lower end at {}, upper end at {}. The drawing of the fall pipe of [Chen et al. 2019] is lost: its "
               "dimensions in the examples are choices (70 mm for a stack of 67 mm, 40 mm above the floor, holes of 1 mm every 20 mm "
               "as printed).",
               millimetres("inner_width_m"), millimetres("bottom_m"), millimetres("top_m")));
}

}  // namespace

bool is_surface_run(const fs::path& run_directory) {
    return fs::exists(run_directory / k_surface_scene);
}

fs::path write_surface_report(const fs::path& run_directory) {
    const SurfaceRows rows = read_surface_rows(run_directory);
    const SurfaceResults results = surface_results(rows);
    const fs::path file = run_directory / names::report_page;
    fs::create_directories(file.parent_path());
    write_file(run_directory / names::results_json, to_json(results).dump(2) + "\n");
    const Page page(file, PageForm::live);
    std::string plots;
    if (gnuplot_is_installed()) {
        for (const Figure& figure : figures(rows)) plots += page.draw(figure);
    } else {
        plots = "<p>gnuplot is not installed: no plots.</p>";
    }
    const std::string title = html::escape(rows.scene.at("name").get<std::string>());
    const std::string body = fmt::format("<header><h1>{}</h1></header>\n", title) + answers(rows, results) +
                             html::section("Water and bodies", surface_pictures(page, rows, run_directory)) +
                             html::section("In time", "<div class=\"figures\">" + plots + "</div>") +
                             html::section("Balances and cost", cost_table(rows, results, run_directory)) +
                             html::section("What this stands on", what_is_known(rows) + paragraph(k_not_modelled));
    page.write(title, body, "");
    return file;
}

}  // namespace cutterflow::postproc
