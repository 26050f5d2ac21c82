#include "postproc/analysis/steel/steel_work.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/head/head_names.hpp"
#include "postproc/analysis/results.hpp"
#include "postproc/run/vtp_arrays.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* k_rerun = "Repeat the run with this version of Cutterflow";
constexpr double k_worn_share = 0.01;  // of the area, above which a value counts as the highest
constexpr int k_pieces = 4;            // of a triangle's sides, for its share in each bin

double area_of(const Triangle& triangle) {
    return 0.5 * (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).norm();
}

/// One wall's work over time, 0 at the time from which it counts.
struct WorkSeries {
    std::string wall;
    double since = 0.0;
    std::vector<double> time, impact, sliding;
};

/// Of each wall, in the file's order. Rows of before a start that counted anew do not count.
std::vector<WorkSeries> series_of(const Table& rows) {
    std::vector<WorkSeries> all;
    for (std::size_t row = 0; row < rows.rows(); ++row) {
        const std::string& wall = rows.text("wall")[row];
        const double since = rows.number("since_s")[row];
        auto of_wall = std::find_if(all.begin(), all.end(), [&](const WorkSeries& series) { return series.wall == wall; });
        if (of_wall == all.end()) of_wall = all.insert(all.end(), {wall, since, {since}, {0.0}, {0.0}});
        if (since != of_wall->since) *of_wall = {wall, since, {since}, {0.0}, {0.0}};
        if (rows.number("time_s")[row] <= of_wall->time.back()) continue;
        of_wall->time.push_back(rows.number("time_s")[row]);
        of_wall->impact.push_back(rows.number("impact_j")[row]);
        of_wall->sliding.push_back(rows.number("sliding_j")[row]);
    }
    return all;
}

/// Rock that came and rock that was delivered in the window.
void set_masses(const Results& results, const RunData& run, SteelWork& work) {
    if (!results.fed) {
        work.fed = results.spillage->fates.placed.mass;
        work.delivered = results.spillage->fates.sucked_up.mass;
        return;
    }
    const Table& ledger = run.rock->ledger;
    work.fed = gain_over(ledger.number("time_s"), ledger.number("fed_kg"), work.from, work.to);
    work.delivered = gain_over(ledger.number("time_s"), ledger.number("delivered_kg"), work.from, work.to);
}

/// Middles of the parts of a triangle whose sides are cut into equal pieces.
std::vector<Vec3> middles_of(const Triangle& triangle) {
    const Vec3 a = (triangle[1] - triangle[0]) / k_pieces, b = (triangle[2] - triangle[0]) / k_pieces;
    std::vector<Vec3> middles;
    for (int i = 0; i < k_pieces; ++i) {
        for (int j = 0; i + j < k_pieces; ++j) {
            const Vec3 corner = triangle[0] + i * a + j * b;
            middles.emplace_back(corner + (a + b) / 3.0);
            if (i + j + 1 < k_pieces) middles.emplace_back(corner + 2.0 * (a + b) / 3.0);
        }
    }
    return middles;
}

std::vector<EnergyOfBin> energy_by_bin(const WorkedSurface& cutter, const std::vector<geometry::AxialBin>& bins) {
    std::vector<EnergyOfBin> energies;
    for (const geometry::AxialBin& bin : bins) energies.push_back({bin, 0.0, {}});
    for (std::size_t t = 0; t < cutter.triangles.size(); ++t) {
        const std::vector<Vec3> middles = middles_of(cutter.triangles[t]);
        const double area = area_of(cutter.triangles[t]) / static_cast<double>(middles.size());
        for (const Vec3& middle : middles) {
            EnergyOfBin& bin = energies.at(geometry::bin_of(bins, middle.z()));
            bin.area += area;
            bin.energy.impact += area * cutter.per_area[t].impact;
            bin.energy.sliding += area * cutter.per_area[t].sliding;
        }
    }
    return energies;
}

/// The value that k_worn_share of the area exceeds.
double highest_of(const WorkedSurface& surface, double SteelEnergy::*part) {
    std::vector<std::pair<double, double>> values;  // and areas
    double area = 0.0;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        values.emplace_back(surface.per_area[t].*part, area_of(surface.triangles[t]));
        area += values.back().second;
    }
    std::sort(values.rbegin(), values.rend());
    double above = 0.0;
    for (const auto& [value, of_triangle] : values) {
        above += of_triangle;
        if (above >= k_worn_share * area) return value;
    }
    return 0.0;
}

void set_map(const RunData& run, SteelWork& work) {
    const fs::path file = run.directory / "postProcessing/rock" / ("wall_work_" + std::string(names::cutter_patch) + ".vtp");
    if (!fs::exists(file)) return;
    work.cutter = read_worked_surface(file);
    work.bins = energy_by_bin(*work.cutter, run.bins);
    work.highest = SteelEnergy{highest_of(*work.cutter, &SteelEnergy::impact), highest_of(*work.cutter, &SteelEnergy::sliding)};
}

json per(double energy, double amount) {
    return amount > 0.0 ? json(energy / amount) : json(nullptr);
}

json wall_json(const EnergyOfWall& wall, const SteelWork& work) {
    return {{"name", wall.wall},
            {"impact_w", per(wall.energy.impact, work.duration())},
            {"sliding_w", per(wall.energy.sliding, work.duration())},
            {"impact_j_per_kg_fed", per(wall.energy.impact, work.fed)},
            {"sliding_j_per_kg_fed", per(wall.energy.sliding, work.fed)},
            {"impact_j_per_kg_delivered", per(wall.energy.impact, work.delivered)},
            {"sliding_j_per_kg_delivered", per(wall.energy.sliding, work.delivered)}};
}

json bin_json(const EnergyOfBin& bin, const SteelWork& work) {
    const double area_time = bin.area * work.map_duration();
    json object = axial_bin_json(bin.bin);
    object.update({{"area_m2", bin.area},
                   {"impact_j", bin.energy.impact},
                   {"sliding_j", bin.energy.sliding},
                   {"impact_w_m2", per(bin.energy.impact, area_time)},
                   {"sliding_w_m2", per(bin.energy.sliding, area_time)}});
    return object;
}

}  // namespace

SteelEnergy SteelWork::total() const {
    SteelEnergy sum;
    for (const EnergyOfWall& wall : walls) {
        sum.impact += wall.energy.impact;
        sum.sliding += wall.energy.sliding;
    }
    return sum;
}

WorkedSurface read_worked_surface(const fs::path& file) {
    const std::string text = read_file(file);
    const auto array = [&](const char* name) { return vtp_array(text, name).value_or(std::vector<double>()); };
    const std::vector<double> points = array("Points"), impact = array("impact_j_m2"), sliding = array("sliding_j_m2");
    const bool is_whole = text.find("</VTKFile>") != std::string::npos && points.size() == 9 * impact.size() &&
                          sliding.size() == impact.size() && !impact.empty();
    if (!is_whole)
        throw UserError({{file.string(), "it does not hold the work of rock on the triangles of a wall",
                          "Each triangle has three corners, impact_j_m2 and sliding_j_m2", k_rerun}});
    WorkedSurface surface;
    for (std::size_t t = 0; t < impact.size(); ++t) {
        const double* corners = points.data() + 9 * t;
        surface.triangles.push_back({Vec3(corners), Vec3(corners + 3), Vec3(corners + 6)});
        surface.per_area.push_back({impact[t], sliding[t]});
    }
    return surface;
}

std::optional<SteelWork> steel_work_of(const Results& results, const RunData& run) {
    if (!results.spillage) return std::nullopt;
    const std::vector<WorkSeries> all = series_of(read_joined_table(
        run.directory, "rock", "wall_work.csv", {{"time_s", "impact_j", "sliding_j", "since_s"}, {"wall"}, {}, k_rerun}, {"wall"}));
    if (all.empty()) return std::nullopt;
    SteelWork work;
    work.since = all.front().since;
    const double first = std::max(work.since, results.spillage->feed_start), last = all.front().time.back();
    work.from = results.fed ? std::max(work.since, results.fed->production.from) : first;
    work.to = results.fed ? std::min(last, results.fed->production.to) : last;
    work.map_from = first;
    work.map_to = last;
    if (!(work.to > work.from)) return std::nullopt;
    set_masses(results, run, work);
    for (const WorkSeries& series : all)
        work.walls.push_back(
            {series.wall,
             {gain_over(series.time, series.impact, work.from, work.to), gain_over(series.time, series.sliding, work.from, work.to)}});
    set_map(run, work);
    return work;
}

json steel_work_json(const std::optional<SteelWork>& work) {
    if (!work) return nullptr;
    json object{{"since_s", work->since},        {"window_start_s", work->from}, {"window_end_s", work->to},    {"walls", json::array()},
                {"map_start_s", work->map_from}, {"map_end_s", work->map_to},    {"cutter_bins", json::array()}};
    for (const EnergyOfWall& wall : work->walls) object["walls"].push_back(wall_json(wall, *work));
    for (const EnergyOfBin& bin : work->bins) object["cutter_bins"].push_back(bin_json(bin, *work));
    object["impact_highest_w_m2"] = work->highest ? per(work->highest->impact, work->map_duration()) : json(nullptr);
    object["sliding_highest_w_m2"] = work->highest ? per(work->highest->sliding, work->map_duration()) : json(nullptr);
    return object;
}

}  // namespace cutterflow::postproc
