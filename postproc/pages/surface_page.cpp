#include "postproc/pages/surface_page.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "geometry/base/json_document.hpp"
#include "geometry/base/progress.hpp"
#include "geometry/base/run_files.hpp"
#include "postproc/analysis/surface_results.hpp"
#include "postproc/draw/gnuplot.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/draw/page.hpp"

namespace cutterflow::postproc {

namespace {

namespace fs = std::filesystem;

constexpr int k_snapshots = 6;
constexpr int k_picture_width = 560;  // [px]
constexpr const char* k_not_modelled =
    "Not modelled: the third dimension, air and trapped bubbles, surface tension, turbulence, leakage at the ends of the cylinders.";

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

/// Numbers of a data array of a VTK file that was written as text.
std::vector<double> array_of(const std::string& text, const std::string& name) {
    const std::size_t head = text.find("Name=\"" + name + "\"");
    if (head == std::string::npos) return {};
    const char* at = text.c_str() + text.find('>', head) + 1;
    const char* end = text.c_str() + text.find("</DataArray>", head);
    std::vector<double> values;
    while (at < end) {
        char* next = nullptr;
        const double value = std::strtod(at, &next);
        if (next == at || next > end) break;
        values.push_back(value);
        at = next;
    }
    return values;
}

struct Snapshot {
    double time = 0.0;
    fs::path file;
};

/// As many as asked for, evenly over the times that were written.
std::vector<Snapshot> snapshots(const fs::path& run_directory) {
    std::vector<Snapshot> all;
    const fs::path folder = run_directory / "postProcessing/water/vtk";
    if (!fs::is_directory(folder)) return all;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().stem().string();
        if (entry.path().extension() == ".vti") all.push_back({std::strtod(name.c_str() + name.find('_') + 1, nullptr), entry.path()});
    }
    std::sort(all.begin(), all.end(), [](const Snapshot& a, const Snapshot& b) { return a.time < b.time; });
    std::vector<Snapshot> chosen;
    const std::size_t count = std::min<std::size_t>(all.size(), k_snapshots);
    for (std::size_t n = 0; n < count; ++n) chosen.push_back(all[count > 1 ? n * (all.size() - 1) / (count - 1) : 0]);
    return chosen;
}

Colour mixed(const Colour& a, const Colour& b, double share) {
    return {a.red + share * (b.red - a.red), a.green + share * (b.green - a.green), a.blue + share * (b.blue - a.blue)};
}

struct Disc {
    double x = 0.0, z = 0.0;
};

/// Bodies at the time of a snapshot.
std::vector<Disc> bodies_at(const SurfaceRows& rows, double time) {
    std::vector<Disc> discs;
    for (std::size_t n = 0; rows.has_bodies() && n < rows.bodies.rows(); ++n) {
        if (std::abs(rows.bodies.number("time_s")[n] - time) < 1e-6)
            discs.push_back({rows.bodies.number("x_m")[n], rows.bodies.number("z_m")[n]});
    }
    return discs;
}

/// Water by its share of a cell, darker where it is faster; solids and bodies over it.
Image picture(const SurfaceRows& rows, const Snapshot& snapshot, double fastest) {
    const auto number = [&](const char* key) { return rows.scene.at(key).get<double>(); };
    const int columns = rows.scene.at("columns").get<int>(), lines = rows.scene.at("rows").get<int>();
    const std::string text = read_file(snapshot.file);
    const std::vector<double> fraction = array_of(text, "water_fraction"), open = array_of(text, "open_volume"),
                              velocity = array_of(text, "velocity_m_s");
    Image image;
    image.width = k_picture_width;
    image.height = std::max(1, static_cast<int>(std::lround(k_picture_width * number("height_m") / number("width_m"))));
    const std::vector<Disc> discs = bodies_at(rows, snapshot.time);
    const double radius = 0.5 * number("diameter_m"), pixel = number("width_m") / image.width, cell_size = number("cell_m");
    const Colour air = colour_of(palette::field[0]), wall = colour_of(palette::faint), body = colour_of(palette::in_cutter),
                 edge = colour_of(palette::ink);
    const Colour slow = colour_of(palette::field[1]), fast = colour_of(palette::field[4]);
    for (int row = 0; row < image.height; ++row) {
        for (int n = 0; n < image.width; ++n) {
            const double x = (n + 0.5) * pixel, z = (image.height - row - 0.5) * pixel;
            const int i = std::min(columns - 1, static_cast<int>(x / cell_size)), k = std::min(lines - 1, static_cast<int>(z / cell_size));
            const std::size_t cell = static_cast<std::size_t>(k) * columns + i;
            Colour colour = air;
            if (cell < fraction.size() && 3 * cell + 2 < velocity.size()) {
                const double speed = std::hypot(velocity[3 * cell], velocity[3 * cell + 2]);
                colour = mixed(air, mixed(slow, fast, std::min(1.0, speed / fastest)), std::clamp(2.0 * fraction[cell] - 0.5, 0.0, 1.0));
                if (cell < open.size() && open[cell] < 0.5) colour = wall;
            }
            for (const Disc& disc : discs) {
                const double distance = std::hypot(x - disc.x, z - disc.z);
                if (distance < radius) colour = distance > radius - 1.2 * pixel ? edge : body;
            }
            for (const double part : {colour.red, colour.green, colour.blue})
                image.rgb.push_back(static_cast<std::uint8_t>(std::lround(255.0 * part)));
        }
    }
    return image;
}

std::string pictures(const Page& page, const SurfaceRows& rows, const fs::path& run_directory) {
    std::string markup;
    const double fastest = std::sqrt(9.81 * rows.scene.at("height_m").get<double>());
    int number = 0;
    for (const Snapshot& snapshot : snapshots(run_directory)) {
        markup += html::figure(fmt::format("<img style=\"width: 100%\" alt=\"water and bodies at {0:.3f} s\" src=\"{1}\">", snapshot.time,
                                           page.address(picture(rows, snapshot, fastest), fmt::format("water_{}", number++))),
                               fmt::format("{:.3f} s", snapshot.time));
    }
    return markup;
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
    const auto mean = [&](const char* column) {
        double sum = 0.0;
        for (const double value : rows.balance.number(column)) sum += value;
        return sum / static_cast<double>(std::max<std::size_t>(1, rows.balance.rows()));
    };
    std::vector<std::vector<std::string>> lines{
        {"simulated time", fmt::format("{:.4f} of {:g} s", results.end_s, rows.scene.at("end_s").get<double>())},
        {"steps", fmt::format("{}", rows.balance.rows())},
        {"core seconds", fmt::format("{:.1f}", results.core_s)},
        {"iterations of the pressure, mean of a step", fmt::format("{:.1f}", mean("pressure_iterations"))},
        {"particles put out of solids, mean of a step", fmt::format("{:.1f}", mean("pushed_out"))}};
    if (fs::exists(run_directory / names::prediction)) {
        const nlohmann::json predicted =
            read_json_document(run_directory / names::prediction, {{"steps", JsonKind::number, true}, {"core_s", JsonKind::number, true}},
                               "Run it again, or remove the file");
        lines.push_back({"steps predicted", fmt::format("{:.0f}", predicted.at("steps").get<double>())});
        lines.push_back({"core seconds predicted", fmt::format("{:.0f}", predicted.at("core_s").get<double>())});
    }
    return html::table({"quantity", "value"}, lines, true);
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
                             html::section("Water and bodies", "<div class=\"figures\">" + pictures(page, rows, run_directory) + "</div>") +
                             html::section("In time", "<div class=\"figures\">" + plots + "</div>") +
                             html::section("Balances and cost", cost_table(rows, results, run_directory)) +
                             fmt::format("<p>{}</p>", k_not_modelled);
    page.write(title, body, "");
    return file;
}

}  // namespace cutterflow::postproc
