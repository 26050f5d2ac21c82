#include "postproc/analysis/surface_comparison.hpp"

#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "postproc/analysis/surface_results.hpp"

namespace cutterflow::postproc {

namespace {

constexpr const char* k_schema = "cutterflow.surface_comparison/1";

struct Kind {
    const char *key, *name, *unit;
    double (*value)(const SurfaceResults&);
};

/// What is compared; a row each.
constexpr Kind k_kinds[] = {
    {"arrival_s", "first body at the right wall", "s", [](const SurfaceResults& r) { return r.arrival_s; }},
    {"half_out_s", "half of the bodies out of the pipe", "s", [](const SurfaceResults& r) { return r.half_out_s; }},
    {"all_out_s", "all bodies out of the pipe", "s", [](const SurfaceResults& r) { return r.all_out_s; }},
    {"greatest_drop_m", "greatest drop of the level in the pipe", "m", [](const SurfaceResults& r) { return r.greatest_drop_m; }},
    {"volume_error", "occupied volume lost or won", "-", [](const SurfaceResults& r) { return r.volume_error; }},
    {"core_s", "core time", "s", [](const SurfaceResults& r) { return r.core_s; }}};

std::vector<RunQuantity> quantities_of(const std::filesystem::path& run) {
    const SurfaceResults results = surface_results(read_surface_rows(run));
    std::vector<RunQuantity> quantities;
    for (const Kind& kind : k_kinds)
        quantities.push_back({kind.key, kind.name, kind.unit, kind.value(results), std::string(kind.key) != "volume_error"});
    return quantities;
}

/// By the state of its stage `run`: a stop rule may end a run before end_s. Empty of a run by hand, which has no manifest.
std::string unfinished_scene(const std::filesystem::path& run) {
    if (!std::filesystem::exists(run / names::manifest)) return "";
    const nlohmann::json manifest = nlohmann::json::parse(read_file(run / names::manifest), nullptr, false);
    const nlohmann::json::json_pointer state("/stages/run/state");
    if (!manifest.contains(state) || manifest.at(state) == "done") return "";
    const SurfaceRows rows = read_surface_rows(run);
    return unfinished_text(run, surface_results(rows).end_s, rows.scene.at("end_s").get<double>());
}

}  // namespace

std::vector<SettingResults> compare_surface_runs(const std::vector<std::filesystem::path>& runs) {
    return compare_settings(runs, k_surface_study, quantities_of, unfinished_scene);
}

nlohmann::json surface_comparison_json(const std::vector<SettingResults>& settings) {
    return setting_comparison_json(settings, k_schema);
}

std::filesystem::path write_surface_comparison(const std::vector<SettingResults>& settings, const std::filesystem::path& folder) {
    return write_setting_comparison(settings, k_schema, folder);
}

}  // namespace cutterflow::postproc
