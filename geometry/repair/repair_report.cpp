#include "geometry/repair/repair_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace cutterflow::geometry::repair {
namespace {

using nlohmann::json;

json state_json(const SoundnessReport& report) {
    return {{"points", report.points},
            {"triangles", report.triangles},
            {"volume_m3", report.volume},
            {"area_m2", report.area},
            {"components", report.components.size()},
            {"degenerate_triangles", report.degenerate_triangles.count},
            {"duplicate_triangles", report.duplicate_triangles.count},
            {"border_edges", report.border_edges.count},
            {"non_manifold_edges", report.non_manifold_edges.count},
            {"misoriented_edges", report.misoriented_edges.count},
            {"non_manifold_points", report.non_manifold_points.count},
            {"self_intersections", report.self_intersections.count},
            {"sound", report.sound()}};
}

std::string state_text(const SoundnessReport& r) {
    return fmt::format(
        "{} triangles, {} component(s), volume {:.6g} m3, area {:.6g} m2; open edges {}, edges of many {}, misoriented {}, touching points "
        "{}, "
        "crossing pairs {}, flat {}, duplicate {}",
        r.triangles, r.components.size(), r.volume, r.area, r.border_edges.count, r.non_manifold_edges.count, r.misoriented_edges.count,
        r.non_manifold_points.count, r.self_intersections.count, r.degenerate_triangles.count, r.duplicate_triangles.count);
}

}  // namespace

json to_json(const RepairOutcome& outcome, const std::string& file, const UnitDecision& unit) {
    json steps = json::array();
    for (const RepairStep& step : outcome.steps)
        steps.push_back({{"name", step.name},
                         {"counted", step.counted},
                         {"count", step.count},
                         {"volume_change_m3", step.volume_change},
                         {"area_change_m2", step.area_change},
                         {"remark", step.remark}});
    json result{{"schema", "cutterflow.repair/1"},
                {"file", file},
                {"unit", {{"name", name_of(unit.unit)}, {"detected", unit.detected}, {"reason", unit.reason}}},
                {"limits",
                 {{"weld_distance_m", outcome.limits.weld_distance},
                  {"hole_size_m", outcome.limits.hole_size},
                  {"volume_change", outcome.limits.volume_change},
                  {"area_change", outcome.limits.area_change},
                  {"overlap", outcome.limits.overlap}}},
                {"before", state_json(outcome.before)},
                {"steps", steps},
                {"repaired", outcome.repaired()}};
    if (outcome.repaired()) {
        result["after"] = state_json(outcome.after);
        return result;
    }
    result["refusals"] = json::array();
    for (const Mistake& mistake : outcome.refusals)
        result["refusals"].push_back({{"what", mistake.what}, {"rule", mistake.rule}, {"remedy", mistake.remedy}});
    return result;
}

std::string to_text(const RepairOutcome& outcome, const std::string& file, const UnitDecision& unit) {
    std::string text = fmt::format("file    {}\nunit    {}\nbefore  {}\n", file, unit.reason, state_text(outcome.before));
    text += fmt::format("{:<28}{:>9}  {:<28}{:>16}{:>16}\n", "step", "count", "of", "volume, m3", "area, m2");
    for (const RepairStep& step : outcome.steps)
        text += fmt::format("{:<28}{:>9}  {:<28}{:>+16.4g}{:>+16.4g}{}{}\n", step.name, step.count, step.counted, step.volume_change,
                            step.area_change, step.remark.empty() ? "" : "  ", step.remark);
    if (outcome.repaired()) text += fmt::format("after   {}\n", state_text(outcome.after));
    return text;
}

}  // namespace cutterflow::geometry::repair
