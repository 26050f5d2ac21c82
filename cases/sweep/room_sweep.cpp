#include "cases/sweep/room_sweep.hpp"

#include <map>

#include <fmt/format.h>

#include "cases/runner/room_stages.hpp"
#include "cases/scenes/room/room_study.hpp"
#include "geometry/base/error.hpp"

namespace cutterflow::cases {

namespace {

constexpr const char* k_seed = "run.seed";

/// Points that may share a bed have the same text here.
std::string bed_of(const ParameterValues& values) {
    std::string text;
    for (const auto& [key, value] : bed_inputs(values)) text += key + "=" + value + "\n";
    return text;
}

/// A bed that one point alone has is made by its own run, beside the others.
void forget_single_beds(std::vector<SweepPoint>& points) {
    std::map<std::string, int> count;
    for (const SweepPoint& point : points) ++count[point.design];
    for (SweepPoint& point : points)
        if (count[point.design] == 1) point.design.clear();
}

}  // namespace

std::vector<SweepPoint> room_sweep_points(const std::filesystem::path& study, const ParameterValues& values,
                                          const std::vector<KeyAxis>& axes, const RepeatRange& repeats, int ranks) {
    const ParameterTable& table = room_table();
    require_free_seed(axes, k_seed, repeats);
    std::vector<SweepPoint> points;
    std::vector<Mistake> mistakes;
    for (const KeySetting& setting : key_settings(table, values, axes)) {
        for (int repeat = repeats.first; repeat < repeats.first + repeats.count; ++repeat) {
            KeySetting one{safe_name(study.stem().string()) + setting.name, setting.values};
            if (repeats.are_numbered()) {
                one.name += fmt::format("_repeat{}", repeat + 1);
                one.values.set(k_seed, values.integer(k_seed) + repeat);
            }
            one.values.set("name", fmt::format("{}: {}", values.text("name"), one.name));
            const std::string text = plain_toml(table, one.values);
            try {
                require_mesh_for_ranks(room_request(parse_parameters(table, text, one.name), study.parent_path()), ranks);
            } catch (const UserError& error) {
                for (const Mistake& mistake : error.mistakes()) mistakes.push_back(of_point(mistake, one.name));
            }
            points.push_back({one.name, text, bed_of(one.values), {}, {"geometry", "bed"}});
        }
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    forget_single_beds(points);
    return points;
}

}  // namespace cutterflow::cases
