#include "cases/replay/rock_study.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cases/scenes/cutter/study_case.hpp"
#include "cases/study/study_shapes.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/mistakes.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_other_flow = "Give the run's value, or run the study itself";

/// Relative difference of two numbers that were written as text.
constexpr double k_same = 1e-9;

bool same(const ParameterValue& a, const ParameterValue& b) {
    const double *x = std::get_if<double>(&a), *y = std::get_if<double>(&b);
    return x != nullptr && y != nullptr ? std::abs(*x - *y) <= k_same * std::max(std::abs(*x), std::abs(*y)) : a == b;
}

/// Whether the flow of that run depends on the key: soil stands where swing and ladder have it, and hauled water has the swing's speed.
bool belongs_to_flow(const Parameter& parameter, const ParameterValues& recorded) {
    if (parameter.key == "swing.direction" || parameter.key == "ladder.inclination_deg") return has_bank(recorded);
    if (parameter.key == "swing.speed_m_min") return recorded.boolean("hauling.water");
    if (parameter.stage == k_geometry_stage || parameter.stage == k_mesh_stage) return true;
    const std::string section = parameter.key.substr(0, parameter.key.find('.'));
    return section == "rotor" || section == "suction" || section == "fluid" || section == "bank" || section == "hauling";
}

/// The table of a study of which all that belongs to the recorded flow may be left out.
ParameterTable rock_study_table(const ParameterValues& recorded) {
    ParameterTable table = study_table();
    for (Parameter& parameter : table) {
        if (!belongs_to_flow(parameter, recorded)) continue;
        parameter.default_value.reset();
        parameter.optional = true;
    }
    return table;
}

/// A file that the study names in place of the flow's own. \pre study.has(key)
void check_same_file(const ReplayedFlow& flow, const ParameterValues& study, const std::string& key, const fs::path& file,
                     Mistakes& mistakes) {
    if (const auto missing = missing_file(study, key.c_str(), file.parent_path())) {
        mistakes.add(*missing);
        return;
    }
    const auto recorded = flow.files.find(key);
    if (recorded != flow.files.end() && recorded->second == sha256_of_file(file.parent_path() / study.text(key))) return;
    mistakes.add({file.string(), fmt::format("{} = {}", key, toml_text(*study.find(key))),
                  recorded == flow.files.end() ? "A replay takes the flow as the run recorded it, without such a file"
                                               : "A replay takes the flow as the run recorded it, and its file had other content",
                  "Leave the key out, or run the study itself"});
}

/// A replay records nothing.
std::vector<Mistake> check_beside_head(ParameterValues resolved, const HeadSize& head) {
    resolved.set("run.record_revolutions", 0.0);
    return check_study(resolved, head);
}

}  // namespace

ReplayedFlow planned_flow(const ParameterValues& values, const fs::path& folder, const HeadSize& head) {
    ReplayedFlow flow{values, {}, head};
    for (const Parameter& parameter : study_table())
        if (parameter.kind == ParameterKind::path && belongs_to_flow(parameter, values) && values.has(parameter.key))
            flow.files[parameter.key] = sha256_of_file((folder / values.text(parameter.key)).lexically_normal());
    return flow;
}

std::vector<Mistake> check_same_flow(const ReplayedFlow& flow, const ParameterValues& study, const fs::path& file) {
    Mistakes mistakes;
    for (const Parameter& parameter : study_table()) {
        const ParameterValue *of_run = flow.values.find(parameter.key), *of_study = study.find(parameter.key);
        if (!belongs_to_flow(parameter, flow.values) || of_study == nullptr) continue;
        if (parameter.kind == ParameterKind::path)
            check_same_file(flow, study, parameter.key, file, mistakes);
        else if (of_run != nullptr && !same(*of_run, *of_study))
            mistakes.add({file.string(), fmt::format("{} = {}", parameter.key, toml_text(*of_study)),
                          fmt::format("A replay takes the flow as the run recorded it, with {}", toml_text(*of_run)), k_other_flow});
    }
    return mistakes.take();
}

ParameterValues read_rock_study(const ReplayedFlow& flow, const fs::path& file) {
    ParameterValues values = read_parameters(rock_study_table(flow.values), file);
    const fs::path folder = fs::absolute(file).parent_path();
    move_shapes(values, [&](const std::string& path) { return (folder / path).lexically_normal().string(); });
    Mistakes mistakes(file.string());
    mistakes.gather([&] { read_shapes(values, folder); });
    mistakes.add(check_same_flow(flow, values, file));
    mistakes.require(!values.tables("feed").empty(), "no [[feed]]", "A replay places a study's rock", "Add a [[feed]]");
    for (const Parameter& parameter : study_table())
        if (belongs_to_flow(parameter, flow.values) && flow.values.has(parameter.key))
            values.set(parameter.key, *flow.values.find(parameter.key));
    mistakes.add(check_file_rules(values, file));
    const ParameterValues resolved = resolve_study(values, flow.head);
    mistakes.add(check_beside_head(resolved, flow.head));
    mistakes.refuse();
    return resolved;
}

}  // namespace cutterflow::cases
