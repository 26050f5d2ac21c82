#include "postproc/analysis/measures/measure_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/json_document.hpp"
#include "postproc/run/run_reader.hpp"
#include "postproc/run/vtp_arrays.hpp"

namespace cutterflow::postproc {

namespace {

namespace fs = std::filesystem;

constexpr double k_no_cell = 1e100;  // below what OpenFOAM writes for a place in no cell
constexpr const char* k_run_again = "Run it again with this version";

/// Numbers of an ascii data array of a .vtp file.
std::vector<double> array_of(const std::string& text, const std::string& name, const fs::path& file) {
    std::optional<std::vector<double>> numbers = vtp_array(text, name);
    if (!numbers)
        throw UserError({{file.string(), fmt::format("the picture has no {}", name),
                          "A picture of grains has places, diameters, densities "
                          "and velocities",
                          k_run_again}});
    return std::move(*numbers);
}

/// Pictures of the series that the run shows: a resumed start leaves those of the part that it replaces out of rocks.pvd, not out of the
/// folder. Without a series, those of the folder. \param rock  postProcessing/rock
std::vector<fs::path> pictures_in(const fs::path& rock) {
    std::vector<fs::path> files;
    if (fs::exists(rock / "rocks.pvd")) {
        const std::string text = read_file(rock / "rocks.pvd"), before = "file=\"";
        for (std::size_t at = text.find(before); at != std::string::npos; at = text.find(before, at)) {
            at += before.size();
            files.push_back(rock / text.substr(at, text.find('"', at) - at));
        }
    } else if (fs::is_directory(rock / "vtk")) {
        for (const auto& entry : fs::directory_iterator(rock / "vtk")) files.push_back(entry.path());
    }
    return files;
}

Table joined_with(const fs::path& run, const std::string& what, const std::string& file, const TableRules& rules,
                  const std::vector<std::string>& identity = {}) {
    const auto folders = start_folders(run, what);
    const bool there = std::any_of(folders.begin(), folders.end(), [&](const auto& folder) { return fs::exists(folder.second / file); });
    if (!there)
        throw UserError({{run.string(), fmt::format("there is no postProcessing/{}/<time>/{}", what, file), "The measure is made from it",
                          "Let the run record it, or remove the measure"}});
    return read_joined_table(run, what, file, rules, identity);
}

}  // namespace

Grains read_picture(const fs::path& file) {
    const std::string text = read_file(file);
    const std::vector<double> places = array_of(text, "Points", file), speeds = array_of(text, "velocity", file);
    Grains grains;
    grains.diameter = array_of(text, "diameter", file);
    grains.density = array_of(text, "density", file);
    const std::size_t n = grains.diameter.size();
    if (grains.density.size() != n || places.size() != 3 * n || speeds.size() != 3 * n)
        throw UserError(
            {{file.string(), "the picture's arrays differ in length", "Every grain has a place, a velocity, a diameter and a density",
              "Remove the picture that a killed run left behind"}});
    for (std::size_t i = 0; i < n; ++i) {
        grains.position.emplace_back(places[3 * i], places[3 * i + 1], places[3 * i + 2]);
        grains.velocity.emplace_back(speeds[3 * i], speeds[3 * i + 1], speeds[3 * i + 2]);
    }
    return grains;
}

MeasureSource::MeasureSource(fs::path run_directory) : directory_(std::move(run_directory)) {}

const std::vector<double>& MeasureSource::picture_times() const {
    if (!times_.empty()) return times_;
    std::vector<std::pair<double, fs::path>> found;
    for (const fs::path& file : pictures_in(directory_ / "postProcessing/rock")) {
        const std::string name = file.stem().string();
        if (file.extension() == ".vtp" && name.rfind("rocks_", 0) == 0 && fs::exists(file))
            found.emplace_back(std::strtod(name.c_str() + 6, nullptr), file);
    }
    if (found.empty())
        throw UserError(
            {{directory_.string(), "there is no picture of grains in postProcessing/rock/vtk", "The measure is made from pictures",
              "Let the run write pictures (run.write_interval_s), or let it come to its first one"}});
    std::sort(found.begin(), found.end());
    for (auto& [time, file] : found) {
        times_.push_back(time);
        pictures_.push_back(std::move(file));
    }
    return times_;
}

std::size_t MeasureSource::picture_near(std::optional<double> time) const {
    const std::vector<double>& times = picture_times();
    if (!time) return times.size() - 1;
    const auto nearest =
        std::min_element(times.begin(), times.end(), [&](double a, double b) { return std::abs(a - *time) < std::abs(b - *time); });
    return static_cast<std::size_t>(nearest - times.begin());
}

const Grains& MeasureSource::grains(std::size_t picture) const {
    picture_times();
    if (!last_ || last_->first != picture) last_ = {picture, read_picture(pictures_.at(picture))};
    return last_->second;
}

double MeasureSource::end() const {
    const Table cost = read_joined_table(directory_, "cost", "cost.csv", {{"time_s"}, {}, {}, k_run_again});
    return cost.empty() ? 0.0 : cost.number("time_s").back();
}

/// A gate that nothing crossed has no rows; a room's file names all that it has.
void MeasureSource::require_gate(const std::string& gate) const {
    const fs::path room = directory_ / "room.json";
    if (!fs::exists(room)) return;
    const nlohmann::json gates = read_json_document(room, {}, k_run_again).value("gates", nlohmann::json());
    if (!gates.is_array()) return;  // of an older version
    if (std::find(gates.begin(), gates.end(), gate) != gates.end()) return;
    throw UserError({{directory_.string(), fmt::format("the run has no gate {}", gate),
                      gates.empty() ? std::string("It has none") : fmt::format("Its gates are {}", gates.dump()),
                      gates.empty() ? "Give the study a measure with a gate, and run it anew" : "Name one of them"}});
}

PassedMass MeasureSource::through_gate(const std::string& gate) const {
    require_gate(gate);
    const Table rows = joined_with(directory_, "rock", "gates.csv", {{"time_s", "id", "direction", "mass_kg"}, {"gate"}, {}, k_run_again},
                                   {"gate", "id", "direction"});
    PassedMass passed;
    for (std::size_t n = 0; n < rows.rows(); ++n) {
        if (rows.text("gate")[n] != gate) continue;
        const double sum = passed.total() + rows.number("direction")[n] * rows.number("mass_kg")[n];
        passed.time.push_back(rows.number("time_s")[n]);
        passed.mass.push_back(sum);
    }
    passed.end = std::max(end(), passed.time.empty() ? 0.0 : passed.time.back());
    return passed;
}

/// Grains of the bed, and those that were fed at that moment; they stand still here.
std::optional<Grains> MeasureSource::grains_at_start(double start) const {
    const auto folders = start_folders(directory_, "rock");
    if (folders.empty() || !fs::exists(folders.front().second / "events.csv")) return std::nullopt;
    const Table events = read_events(directory_);
    const auto &x = events.number("x_m"), &y = events.number("y_m"), &z = events.number("z_m");
    Grains grains;
    for (std::size_t n = 0; n < events.rows(); ++n) {
        const std::string& surface = events.text("surface")[n];
        if (events.number("time_s")[n] > start || (surface != "start" && surface != "feed")) continue;
        grains.add({x[n], y[n], z[n]}, Vec3::Zero(), events.number("diameter_m")[n], events.number("density_kg_m3")[n]);
    }
    return grains;
}

PassedMass MeasureSource::out_of_region(const Region& region) const {
    PassedMass passed;
    passed.steps = false;
    passed.time = picture_times();
    for (std::size_t n = 0; n < passed.time.size(); ++n) passed.mass.push_back(mass_of(grains_in(grains(n), region)));
    const auto folders = start_folders(directory_, "rock");
    const double start = folders.empty() ? 0.0 : folders.front().first;
    if (start < passed.time.front()) {
        const std::optional<Grains> first = grains_at_start(start);
        passed.whole = first.has_value();
        if (first) {
            passed.time.insert(passed.time.begin(), start);
            passed.mass.insert(passed.mass.begin(), mass_of(grains_in(*first, region)));
        }
    }
    const double first = passed.mass.front();
    for (double& mass : passed.mass) mass = first - mass;
    passed.start = passed.time.front();
    passed.end = passed.time.back();
    return passed;
}

/// [s]; without end for what stays.
double MeasureSource::removed_at(const std::string& wall) const {
    const fs::path room = directory_ / "room.json";
    if (!fs::exists(room)) return std::numeric_limits<double>::infinity();
    const nlohmann::json of_room = read_json_document(
        room, {{"solids/*/name", JsonKind::text, false}, {"solids/*/removed_at_s", JsonKind::number, false}}, k_run_again);
    for (const nlohmann::json& solid : of_room.value("solids", nlohmann::json::array()))
        if (solid.value("name", "") == wall && solid.contains("removed_at_s")) return solid.at("removed_at_s");
    return std::numeric_limits<double>::infinity();
}

/// Rows of a wall that was taken away count as long as it stood.
Signal MeasureSource::wall_force(const std::string& wall, const std::string& component) const {
    const Table rows = joined_with(directory_, "rock", "walls.csv",
                                   {{"time_s", "force_x_n", "force_y_n", "force_z_n"}, {"wall"}, {}, k_run_again}, {"wall"});
    const double end = removed_at(wall);
    Signal signal;
    for (std::size_t n = 0; n < rows.rows(); ++n) {
        if (rows.text("wall")[n] != wall || rows.number("time_s")[n] > end) continue;
        const Vec3 force(rows.number("force_x_n")[n], rows.number("force_y_n")[n], rows.number("force_z_n")[n]);
        signal.time.push_back(rows.number("time_s")[n]);
        signal.value.push_back(component == "magnitude" ? force.norm() : force[component[0] - 'x']);
    }
    if (signal.time.empty())
        throw UserError({{directory_.string(), fmt::format("walls.csv has no force on \"{}\"", wall),
                          "It has the walls that rock can meet, until they are taken away", "Correct the wall's name"}});
    return signal;
}

Signal MeasureSource::column(const std::string& table, const std::string& column) const {
    const fs::path path(table);
    const Table rows = joined_with(directory_, path.parent_path().string(), path.filename().string(),
                                   {{"time_s", column}, {}, {}, "Name a table with time_s, and one of its columns"});
    return {rows.number("time_s"), rows.number(column)};
}

Signal MeasureSource::probe_difference(const std::string& name) const {
    Signal signal;
    for (const auto& [start, folder] : start_folders(directory_, name)) {
        if (!fs::exists(folder / "p")) continue;
        std::istringstream lines(read_file(folder / "p"));
        for (std::string line; std::getline(lines, line);) {
            std::istringstream numbers(line);
            double time = 0.0, first = 0.0, second = 0.0;
            if (line.empty() || line[0] == '#' || !(numbers >> time >> first >> second)) continue;
            if (std::max(std::abs(first), std::abs(second)) > k_no_cell)
                throw UserError({{(folder / "p").string(), fmt::format("a place of {} lies in no cell of the mesh", name),
                                  "A pressure drop is that between two places in the medium", "Move upstream_m or downstream_m"}});
            while (!signal.time.empty() && signal.time.back() >= time) signal.time.pop_back(), signal.value.pop_back();
            signal.time.push_back(time);
            signal.value.push_back(first - second);
        }
    }
    if (signal.time.empty())
        throw UserError({{directory_.string(), fmt::format("there is no postProcessing/{}/<time>/p with two places", name),
                          "A pressure drop is made from the probes function object of its name",
                          "Let the run record it: a run without a medium has no pressure"}});
    return signal;
}

}  // namespace cutterflow::postproc
