#include "cases/sweep/surface_sweep.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "cases/scenes/free_surface/surface_study.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/mistakes.hpp"

namespace cutterflow::cases {

namespace {

constexpr const char* k_seed = "bodies.seed";

bool has_jitter(const ParameterValues& values) {
    const std::vector<ParameterValues>& bodies = values.tables("bodies");
    return std::any_of(bodies.begin(), bodies.end(), [](const ParameterValues& table) { return table.number("bodies.jitter_m") > 0.0; });
}

}  // namespace

std::vector<SweepPoint> surface_sweep_points(const std::filesystem::path& study, const std::vector<KeyAxis>& axes,
                                             const RepeatRange& repeats) {
    const ParameterTable& table = surface_study_table();
    const ParameterValues values = read_placed_surface_study(study);  // the points lie in other folders
    require_free_seed(axes, k_seed, repeats);
    std::vector<SweepPoint> points;
    Mistakes mistakes;
    for (const KeySetting& setting : key_settings(table, values, axes)) {
        mistakes.gather([&] {
            require_random(has_jitter(setting.values), repeats.count, safe_name(study.stem().string()) + setting.name,
                           "the jitter of the bodies' places", "Give [[bodies]] a jitter_m above 0");
        });
        for (int repeat = repeats.first; repeat < repeats.first + repeats.count; ++repeat) {
            KeySetting one{safe_name(study.stem().string()) + setting.name, setting.values};
            if (repeats.are_numbered()) {
                one.name += fmt::format("_repeat{}", repeat + 1);
                set_key(one.values, table, *find_key(table, k_seed),
                        [&](const ParameterValues& bodies) { return bodies.integer(k_seed) + repeat; });
            }
            one.values.set("name", fmt::format("{}: {}", values.text("name"), one.name));
            const std::string text = commented_toml(table, &one.values);
            try {
                require_surface_study(text, one.name);
            } catch (const UserError& error) {
                for (const Mistake& mistake : error.mistakes()) mistakes.add(of_point(mistake, one.name));
            }
            points.push_back({one.name, text, "", {}});
        }
    }
    mistakes.refuse();
    return points;
}

}  // namespace cutterflow::cases
