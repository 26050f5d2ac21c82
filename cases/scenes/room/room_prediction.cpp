#include "cases/scenes/room/room_prediction.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/progress.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::cases {

namespace {

constexpr double k_seconds_per_grain_and_step = 0.65e-6;  // of a dense bed with rolling friction and walls, on one core
constexpr double k_rest = 0.5;                            // of a small bed [s]

double mass_of(const PlacedGrain& grain) {
    return grain.density * k_pi / 6.0 * grain.diameter * grain.diameter * grain.diameter;
}

/// Share of the smaller of Rayleigh time and Hertz time of the smallest grains.
double contact_step(const RoomScene& scene) {
    double step = std::numeric_limits<double>::infinity();
    for (const RoomGrains& kind : scene.grains) {
        const double radius = 0.5 * kind.smallest(), mass = kind.density * 4.0 / 3.0 * k_pi * radius * radius * radius;
        const double modulus = scene.contact.youngs_modulus / (1.0 - scene.contact.poisson_rock * scene.contact.poisson_rock);
        const physics::Impact impact{0.5 * mass, 0.5 * radius, 0.5 * modulus, scene.contact.max_speed};
        step = std::min({step, physics::rayleigh_time(radius, kind.density, scene.contact.youngs_modulus, scene.contact.poisson_rock),
                         physics::hertz_time(impact)});
    }
    return scene.grains.empty() ? 0.0 : scene.contact.time_step_fraction * step;
}

std::vector<std::string> models_of(const RoomScene& scene) {
    std::vector<std::string> on;
    if (scene.medium.present()) on.push_back(fmt::format("flow of {}: room.medium", scene.medium.name));
    if (scene.grains.empty()) return on;
    on.emplace_back("contacts of grains, spring and dashpot of Hertz with friction");
    if (std::any_of(scene.pairs.begin(), scene.pairs.end(), [](const RoomPair& pair) { return pair.settings.rolling_friction > 0.0; }))
        on.push_back(fmt::format("rolling friction ({}): contact.rolling", scene.contact.rolling_law));
    for (const RoomSolid& solid : scene.solids) {
        if (solid.travel) on.push_back(fmt::format("{} moves from {:g} to {:g} s", solid.name, solid.travel->begin, solid.travel->end));
        if (solid.removed_at) on.push_back(fmt::format("{} is taken away at {:g} s", solid.name, *solid.removed_at));
    }
    for (const RoomEvent& event : scene.events) {
        if (const auto* feed = std::get_if<FeedEvent>(&event))
            on.push_back(fmt::format("{} are fed at {:g} kg/s", feed->grains, feed->rate));
        if (const auto* extract = std::get_if<ExtractEvent>(&event))
            on.push_back(fmt::format("grains are extracted at {:g} kg/s", extract->rate));
        if (const auto* in_region = std::get_if<RegionEvent>(&event))
            on.push_back(fmt::format("{} at {:g} s", in_region->what, in_region->at));
    }
    return on;
}

}  // namespace

RoomPrediction predict(const RoomScene& scene, const std::vector<BedPiece>& pieces) {
    RoomPrediction found;
    found.name = scene.name;
    found.medium = scene.medium.name;
    found.solids = scene.solids.size();
    found.contact_step = contact_step(scene);
    for (const BedPiece& piece : pieces) {
        found.grains += piece.grains.size();
        for (const PlacedGrain& grain : piece.grains) found.mass += mass_of(grain);
        found.bed_time += (piece.grains.empty() ? 0.0 : piece.grains.back().time) + k_rest;
    }
    found.end = scene.run.end;
    if (found.contact_step > 0.0)
        found.core_seconds =
            k_seconds_per_grain_and_step * static_cast<double>(found.grains) * (found.bed_time + found.end) / found.contact_step;
    found.on = models_of(scene);
    return found;
}

std::string to_text(const RoomPrediction& found) {
    std::string text =
        fmt::format("{}: {} solids, {} grains, {:.4g} kg, medium {}\n", found.name, found.solids, found.grains, found.mass, found.medium);
    if (found.contact_step > 0.0)
        text += fmt::format(
            "contact step {:.3g} s, {:.2g} steps; grains about {} on one core for a preparation of {:.2g} s and a run of {:g} s\n",
            found.contact_step, (found.bed_time + found.end) / found.contact_step, duration_text(found.core_seconds), found.bed_time,
            found.end);
    for (const std::string& model : found.on) text += "on: " + model + "\n";
    return text;
}

nlohmann::json to_json(const RoomPrediction& found) {
    return {{"name", found.name},      {"medium", found.medium}, {"solids", found.solids},
            {"grains", found.grains},  {"mass_kg", found.mass},  {"contact_step_s", found.contact_step},
            {"bed_s", found.bed_time}, {"end_s", found.end},     {"core_s", found.core_seconds},
            {"on", found.on}};
}

}  // namespace cutterflow::cases
