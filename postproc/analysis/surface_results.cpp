#include "postproc/analysis/surface_results.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/json_document.hpp"

namespace cutterflow::postproc {

namespace {

constexpr const char* k_remedy = "Take a run directory of cutterflow run with a study of kind free_surface";

const std::vector<JsonField> k_scene_fields = {{"name", JsonKind::text, true},         {"width_m", JsonKind::number, true},
                                               {"height_m", JsonKind::number, true},   {"cell_m", JsonKind::number, true},
                                               {"columns", JsonKind::whole, true},     {"rows", JsonKind::whole, true},
                                               {"end_s", JsonKind::number, true},      {"bodies", JsonKind::whole, true},
                                               {"diameter_m", JsonKind::number, true}, {"contact_gap_m", JsonKind::number, true}};

void read_pipe(const SurfaceRows& rows, SurfaceResults& results) {
    const Table& levels = rows.levels;
    const double bodies = rows.scene.at("bodies").get<double>();
    bool went_down = false;
    for (std::size_t n = 0; n < levels.rows(); ++n) {
        const double time = levels.number("time_s")[n], left = levels.number("bodies_in_pipe")[n];
        if (bodies > 0.0 && left <= 0.5 * bodies && time < results.half_out_s) results.half_out_s = time;
        if (bodies > 0.0 && left == 0.0 && time < results.all_out_s) results.all_out_s = time;
        const double drop = levels.number("level_m")[n] - levels.number("level_in_pipe_m")[n];
        if (drop > results.greatest_drop_m) {
            results.greatest_drop_m = drop;
            results.drop_at_s = time;
        }
        const double flow = levels.number("mouth_flow_m3_s")[n];
        went_down = went_down || flow < 0.0;
        if (went_down && drop > 0.0 && flow > 0.0 && time < results.reversal_s) results.reversal_s = time;
        if (time >= results.reversal_s && levels.number("rise_in_pipe_m_s")[n] > 0.0) results.rises_with_bodies = true;
    }
}

/// Each process counts its own core seconds, in rows that a later one may replace.
double core_seconds_of_starts(const std::filesystem::path& run_directory, const TableRules& rules) {
    double sum = 0.0;
    for (const auto& [start, folder] : start_folders(run_directory, "balance")) {
        if (!std::filesystem::exists(folder / "balance.csv")) continue;
        const Table balance = read_table(folder / "balance.csv", rules);
        if (!balance.empty()) sum += balance.number("core_s").back();
    }
    return sum;
}

}  // namespace

const std::vector<double>* counted(const Table& table, const std::string& column) {
    const auto& columns = table.columns();
    return std::find(columns.begin(), columns.end(), column) == columns.end() ? nullptr : &table.number(column);
}

SurfaceRows read_surface_rows(const std::filesystem::path& run_directory) {
    if (!std::filesystem::exists(run_directory / "scene.json"))
        throw UserError(fmt::format("{} has no scene.json", run_directory.string()), "It is written when a free-surface run is set up",
                        k_remedy);
    SurfaceRows rows;
    rows.scene = read_json_document(run_directory / "scene.json", k_scene_fields, k_remedy);
    const TableRules of_balance{{"time_s", "volume_error", "energy_j", "pushed_out", "pressure_iterations", "core_s"}, {}, {}, k_remedy};
    rows.balance = read_joined_table(run_directory, "balance", "balance.csv", of_balance);
    rows.core_s = core_seconds_of_starts(run_directory, of_balance);
    rows.levels = read_joined_table(run_directory, "levels", "levels.csv",
                                    {{"time_s", "level_m", "level_in_pipe_m", "mouth_flow_m3_s", "hole_flow_m3_s", "bodies_in_pipe",
                                      "rise_in_pipe_m_s", "mean_x_m", "mean_z_m", "farthest_x_m"},
                                     {},
                                     {},
                                     k_remedy});
    if (rows.has_bodies())
        rows.bodies = read_joined_table(run_directory, "bodies", "bodies.csv", {{"time_s", "id", "x_m", "z_m"}, {}, {}, k_remedy}, {"id"});
    rows.gauges = read_joined_table(run_directory, "gauges", "gauges.csv",
                                    {{"time_s", "level_m", "pressure_pa"}, {"gauge"}, {"pressure_pa"}, k_remedy}, {"gauge"});
    if (rows.levels.empty())
        throw UserError(fmt::format("{} has no rows yet", run_directory.string()), "A report needs at least one step", "Let the run go on");
    return rows;
}

SurfaceResults surface_results(const SurfaceRows& rows) {
    SurfaceResults results;
    results.core_s = rows.core_s;
    results.end_s = rows.levels.number("time_s").back();
    if (const std::vector<double>* counts = counted(rows.balance, "through_walls"))
        results.through_walls = std::accumulate(counts->begin(), counts->end(), 0.0);
    for (std::size_t n = 0; n < rows.balance.rows(); ++n) {
        const double error = rows.balance.number("volume_error")[n];
        if (std::abs(error) > std::abs(results.volume_error)) results.volume_error = error;
    }
    const double wall = rows.scene.at("width_m").get<double>() - rows.scene.at("contact_gap_m").get<double>();
    for (std::size_t n = 0; rows.has_bodies() && n < rows.levels.rows(); ++n) {
        if (rows.levels.number("farthest_x_m")[n] < wall) continue;
        results.arrival_s = rows.levels.number("time_s")[n];
        break;
    }
    if (rows.has_pipe()) read_pipe(rows, results);
    return results;
}

nlohmann::json to_json(const SurfaceResults& results) {
    const auto time = [](double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr); };
    return {{"schema", "cutterflow.surface/1"},
            {"end_s", results.end_s},
            {"core_s", results.core_s},
            {"volume_error", results.volume_error},
            {"through_walls", results.through_walls},
            {"arrival_s", time(results.arrival_s)},
            {"half_out_s", time(results.half_out_s)},
            {"all_out_s", time(results.all_out_s)},
            {"greatest_drop_m", results.greatest_drop_m},
            {"drop_at_s", results.drop_at_s},
            {"reversal_s", time(results.reversal_s)},
            {"rises_with_bodies", results.rises_with_bodies}};
}

}  // namespace cutterflow::postproc
