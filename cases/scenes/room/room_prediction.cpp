#include "cases/scenes/room/room_prediction.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cases/scenes/room/room_flow.hpp"
#include "cases/scenes/room/solid_motion.hpp"
#include "cases/study/closure_rules.hpp"
#include "cases/study/contact_rules.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/progress.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/physics/catalogue.hpp"
#include "solver/physics/contact.hpp"
#include "solver/physics/settling.hpp"
#include "solver/ports/mapping_width.hpp"

namespace cutterflow::cases {

namespace {

constexpr double k_seconds_per_sphere_and_step = 0.65e-6;  // of a dense bed with rolling friction and walls, on one core
constexpr double k_rest = 0.5;                             // of a small bed [s]
// Of a coupled step on one core: of the flow, with grains (docs/design/003-meshing.md), and of mapping a grain to cells.
constexpr double k_seconds_per_cell_and_step = 5.9e-6 * 1.41, k_seconds_per_mapped_grain = 30e-6;
constexpr double k_travel_share = 0.25;          // of its kernel's width that a grain may travel in a step
constexpr double k_most_diameters_across = 3.0;  // below which grains may block an opening
constexpr double k_soft_overlap = 0.05;          // of a diameter, from which a bed packs and rolls otherwise than stiff grains

double spheres_of(const RoomScene& scene, const PlacedGrain& grain) {
    return grain.shape.empty() ? 1.0 : static_cast<double>(scene.find_grains(grain.shape)->spheres());
}

double mass_of(const PlacedGrain& grain) {
    return sphere_mass(grain.diameter, grain.density);
}

/// Terminal speed of the fastest grains in the medium [m/s]; 0 where none is heavier.
double fall_speed(const RoomScene& scene) {
    double fastest = 0.0;
    const auto look = [&](const GrainClass& grain) {
        if (grain.density <= scene.medium.density || scene.gravity_strength == 0.0) return;
        physics::SettlingRock falling;
        falling.rock = {grain.diameter, scene.medium.density, scene.medium.kinematic_viscosity, 1.0, scene.closures.sphericity};
        falling.density = grain.density;
        falling.gravity = scene.gravity_strength;
        falling.drag = physics::find_drag_law(scene.closures.drag);
        falling.hindrance = physics::find_hindrance_law(scene.closures.hindrance);
        fastest = std::max(fastest, physics::terminal_slip_speed(falling));
    };
    for (const RoomGrains& kind : scene.grains)
        for (const GrainClass& grain : kind.extremes()) look(grain);
    return fastest;
}

/// Courant number in the smallest cells, and the way of grains in a step.
double flow_step(const RoomScene& scene, const meshing::RoomMeshPlan& mesh) {
    const double cell = mesh.smallest_cell(), flow = fastest_flow(scene), grains = std::max(flow, fall_speed(scene));
    double step = scene.run.longest_step;
    if (flow > 0.0) step = std::min(step, scene.run.max_courant * cell / flow);
    if (grains > 0.0 && !scene.grains.empty()) {
        const double width = coupling::mapping_width(scene.kernel, scene.smallest_grain(), cell);
        step = std::min(step, k_travel_share * width / grains);
    }
    return step;
}

/// Size of the smallest cells at a solid's surface [m].
double cell_at(const RoomSolid& solid, const meshing::RoomMeshPlan& mesh) {
    double finest = mesh.background_cell();
    for (const Vec3& point : solid.surface.points) finest = std::min(finest, mesh.cell_at(point));
    return finest;
}

/// Bores that something flows through.
std::vector<Opening> flow_bores(const ParameterValues& values, const RoomScene& scene, const meshing::RoomMeshPlan& mesh) {
    std::vector<Opening> bores;
    for (const ParameterValues& boundary : values.tables("boundary")) {
        if (!boundary.has("boundary.inside")) continue;
        const RoomSolid* solid = scene.find_solid(boundary.text("boundary.inside"));
        if (solid != nullptr && solid->bore)
            bores.push_back({boundary.where("boundary.inside"), "radius of " + solid->name, solid->bore->radius, cell_at(*solid, mesh)});
    }
    return bores;
}

/// Openings in floors and spouts of solids that the medium feels.
std::vector<Opening> floor_openings(const ParameterValues& values, const RoomScene& scene, const meshing::RoomMeshPlan& mesh) {
    std::vector<Opening> openings;
    for (const ParameterValues& table : values.tables("solid")) {
        const RoomSolid* solid = scene.find_solid(table.text("solid.name"));
        if (solid != nullptr && solid->felt_by_fluid && solid->opening > 0.0)
            openings.push_back({table.where("solid.name"), "opening of " + solid->name, solid->opening, cell_at(*solid, mesh)});
    }
    return openings;
}

/// Weight of the poured grains over the floor [Pa].
double pressure_of_bed(const RoomScene& scene, const std::vector<BedPiece>& pieces) {
    double mass = 0.0;
    for (const BedPiece& piece : pieces)
        for (const PlacedGrain& grain : piece.grains) mass += mass_of(grain);
    return mass * scene.gravity_strength / (scene.size.x() * scene.size.y());
}

/// Overlap over diameter of grains that bear a pressure p [-]: Hertz contacts of diameter d that bear forces p d2,
///   delta / d = (3/2 p / E*)^(2/3),  E* = E / (2 (1 - nu^2)).
double overlap_under(const RoomScene& scene, double pressure) {
    const double poisson = scene.contact.poisson_rock, modulus = 0.5 * scene.contact.youngs_modulus / (1.0 - poisson * poisson);
    return std::pow(1.5 * pressure / modulus, 2.0 / 3.0);
}

/// Solids so fast that grains sink into them deeper than accepted.
std::vector<Mistake> impact_warnings(const ParameterValues& values, const RoomScene& scene) {
    std::vector<Mistake> warnings;
    if (scene.grains.empty()) return warnings;
    for (const ParameterValues& table : values.tables("solid")) {
        const RoomSolid* solid = scene.find_solid(table.text("solid.name"));
        if (solid == nullptr || solid->fastest() == 0.0) continue;
        const double overlap = impact_overlap(scene.contact, scene.densest_grain(), solid->fastest());
        if (overlap > physics::k_largest_overlap_ratio)
            warnings.push_back({table.where("solid.name"), fmt::format("{} moves at up to {:.3g} m/s", solid->name, solid->fastest()),
                                fmt::format("Grains that it meets sink into it by {:.2g} of their radius; {:g} is accepted", overlap,
                                            physics::k_largest_overlap_ratio),
                                "Give the grains' material a larger modulus; the contact step shrinks with its square root"});
    }
    return warnings;
}

/// Grains so soft that their bed sinks into itself, or under a solid that compresses it.
std::vector<Mistake> softness_warnings(const ParameterValues& values, const RoomScene& scene, const std::vector<BedPiece>& pieces) {
    if (pieces.empty()) return {};
    std::vector<Mistake> warnings;
    const auto look = [&](const char* what, double pressure) {
        const double overlap = overlap_under(scene, pressure);
        if (overlap < k_soft_overlap) return;
        const ParameterValues& material = values.tables("material").front();
        warnings.push_back({material.where("material.youngs_modulus_pa"),
                            fmt::format("youngs_modulus_pa = {:g}", scene.contact.youngs_modulus),
                            fmt::format("Grains under {} sink {:.2g} diameters into each other; above {:g} a bed packs and flows otherwise "
                                        "than stiff grains",
                                        what, overlap, k_soft_overlap),
                            "Give the material a larger modulus; the contact step shrinks with its square root"});
    };
    look("the poured bed", pressure_of_bed(scene, pieces));
    for (const PrepareStep& step : scene.preparation)
        if (const auto* compress = std::get_if<CompressStep>(&step)) look("the pressure of a step compress", compress->pressure);
    return warnings;
}

/// Feeds that the run's end cuts short.
std::vector<Mistake> feed_warnings(const ParameterValues& values, const RoomScene& scene) {
    std::vector<Mistake> warnings;
    for (const ParameterValues& event : values.tables("event")) {
        if (event.text("event.do") != "feed" || event.number("event.to_s") <= scene.run.end) continue;
        const double from = event.number("event.from_s"), to = event.number("event.to_s"), rate = event.number("event.rate_kg_s");
        warnings.push_back({event.where("event.to_s"), fmt::format("event.to_s = {:g} of a feed of {}", to, event.text("event.grains")),
                            fmt::format("The run ends at {:g} s: {:.4g} of the {:.4g} kg that are ordered come in", scene.run.end,
                                        rate * (scene.run.end - from), rate * (to - from)),
                            "Raise run.end_s, or end the feed earlier"});
    }
    return warnings;
}

/// Whether grains may be frozen at a time: by the preparation, or by an event until then.
bool may_be_frozen(const RoomScene& scene, double time) {
    const auto freezes = [&](const RoomEvent& event) {
        const auto* one = std::get_if<RegionEvent>(&event);
        return one != nullptr && one->what == "freeze" && one->at <= time;
    };
    return std::any_of(scene.preparation.begin(), scene.preparation.end(),
                       [](const PrepareStep& step) { return std::holds_alternative<FreezeStep>(step); }) ||
           std::any_of(scene.events.begin(), scene.events.end(), freezes);
}

std::vector<Mistake> thaw_warnings(const ParameterValues& values, const RoomScene& scene) {
    std::vector<Mistake> warnings;
    for (const ParameterValues& event : values.tables("event")) {
        if (event.text("event.do") != "thaw" || may_be_frozen(scene, event.number("event.at_s"))) continue;
        warnings.push_back({event.where("event.do"), fmt::format("do = \"thaw\" at {:g} s", event.number("event.at_s")),
                            "No step and no event freezes grains before it", "Freeze grains before it, or remove it"});
    }
    return warnings;
}

}  // namespace

std::vector<std::string> models_of(const RoomScene& scene) {
    std::vector<std::string> on;
    if (scene.medium.present()) on.push_back(fmt::format("flow of {}, {}: room.medium", scene.medium.name, scene.medium.turbulence));
    if (scene.grains.empty()) return on;
    if (scene.medium.present()) {
        const coupling::ClosureSettings& closures = scene.closures;
        on.push_back(fmt::format("drag {} x {:g}, hindrance {}, added mass {:g}: closures", closures.drag, closures.drag_modifier,
                                 closures.hindrance, closures.added_mass));
    }
    on.emplace_back("contacts of grains, spring and dashpot of Hertz with friction");
    if (std::any_of(scene.pairs.begin(), scene.pairs.end(), [](const RoomPair& pair) { return pair.settings.rolling_friction > 0.0; }))
        on.push_back(fmt::format("rolling friction ({}): contact.rolling", scene.contact.rolling_law));
    for (const RoomSolid& solid : scene.solids) {
        for (const coupling::WallTravel& travel : solid.travels)
            on.push_back(fmt::format("{} moves from {:g} to {:g} s", solid.name, travel.begin, travel.end));
        if (solid.turn)
            on.push_back(fmt::format("{} turns at {:g} rpm from {:g} to {:g} s", solid.name, solid.turn->speed / rpm_to_rad_s(1.0),
                                     solid.turn->begin, solid.turn->end));
        if (solid.removed_at) on.push_back(fmt::format("{} is taken away at {:g} s", solid.name, *solid.removed_at));
    }
    for (const PrepareStep& step : scene.preparation)
        if (const auto* compress = std::get_if<CompressStep>(&step))
            on.push_back(fmt::format("{} is pressed on the grains with {:.4g} N before the run", compress->solid, compress->force));
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

RoomPrediction predict(const RoomScene& scene, const std::vector<BedPiece>& pieces, const std::optional<meshing::RoomMeshPlan>& mesh) {
    RoomPrediction found;
    found.name = scene.name;
    found.medium = scene.medium.name;
    found.solids = scene.solids.size();
    found.contact_step = contact_step(scene, scene.contact);
    double spheres = 0.0;  // of the bed's grains
    for (const BedPiece& piece : pieces) {
        found.grains += piece.grains.size();
        for (const PlacedGrain& grain : piece.grains) {
            found.mass += mass_of(grain);
            spheres += spheres_of(scene, grain);
        }
        found.bed_time += (piece.grains.empty() ? 0.0 : piece.grains.back().time) + k_rest;
    }
    found.end = scene.run.end;
    found.fed_mass = scene.fed_mass();
    double grain_time = static_cast<double>(found.grains) * found.end, sphere_time = spheres * found.end;  // in the run
    for (const RoomEvent& event : scene.events) {
        const auto* feed = std::get_if<FeedEvent>(&event);
        if (feed == nullptr) continue;
        const RoomGrains& kind = *scene.find_grains(feed->grains);
        const double count = feed->mass(found.end) / kind.mean_mass();
        const double time = count * std::max(0.0, found.end - 0.5 * (feed->from + std::min(feed->to, found.end)));
        found.fed += count;
        grain_time += time;
        sphere_time += time * static_cast<double>(kind.spheres());
    }
    if (found.contact_step > 0.0)
        found.grain_seconds = k_seconds_per_sphere_and_step * (spheres * found.bed_time + sphere_time) / found.contact_step;
    if (mesh) {
        found.cells = mesh->predicted_cells;
        found.mesh_seconds = mesh->predicted_core_s;
        found.flow_step = flow_step(scene, *mesh);
        found.flow_seconds =
            (k_seconds_per_cell_and_step * found.cells * found.end + k_seconds_per_mapped_grain * grain_time) / found.flow_step;
    }
    found.on = models_of(scene);
    return found;
}

std::vector<Mistake> room_warnings(const ParameterValues& values, const RoomScene& scene, const std::vector<BedPiece>& pieces,
                                   const std::optional<meshing::RoomMeshPlan>& mesh) {
    std::vector<Mistake> warnings = motion_warnings(values, scene);
    for (Mistake& warning : impact_warnings(values, scene)) warnings.push_back(std::move(warning));
    for (Mistake& warning : softness_warnings(values, scene, pieces)) warnings.push_back(std::move(warning));
    for (Mistake& warning : feed_warnings(values, scene)) warnings.push_back(std::move(warning));
    for (Mistake& warning : thaw_warnings(values, scene)) warnings.push_back(std::move(warning));
    if (!mesh) return warnings;
    for (Mistake& warning : meshing::room_mesh_warnings(*mesh)) warnings.push_back(std::move(warning));
    if (scene.grains.empty()) return warnings;
    for (const Mistake& warning : hindrance_warnings(values, !scene.preparation.empty())) warnings.push_back(warning);
    const double longest = scene.longest_grain();
    std::vector<Opening> openings = floor_openings(values, scene, *mesh);
    for (const Opening& bore : flow_bores(values, scene, *mesh)) {
        openings.push_back(bore);
        if (2.0 * bore.width < k_most_diameters_across * longest)
            warnings.push_back({bore.where, fmt::format("{} = {:g}", bore.name, bore.width),
                                fmt::format("Grains {:g} m long may block an opening below {:g} lengths", longest, k_most_diameters_across),
                                "Check the diameters"});
    }
    for (const Opening& opening : openings)
        if (const auto warning = wide_kernel_warning(opening, scene.kernel, scene.largest_grain())) warnings.push_back(*warning);
    return warnings;
}

std::string to_text(const RoomPrediction& found) {
    const std::string fed = found.fed > 0.0 ? fmt::format(" and {:.0f} fed, {:.4g} kg", found.fed, found.fed_mass) : "";
    std::string text = fmt::format("{}: {} solid{}, {} grain{}, {:.4g} kg{}, medium {}\n", found.name, found.solids,
                                   found.solids == 1 ? "" : "s", found.grains, found.grains == 1 ? "" : "s", found.mass, fed, found.medium);
    if (found.contact_step > 0.0)
        text += fmt::format(
            "contact step {:.3g} s, {:.2g} steps; grains about {} on one core for a preparation of {:.2g} s and a run of {:g} s\n",
            found.contact_step, (found.bed_time + found.end) / found.contact_step, duration_text(found.grain_seconds), found.bed_time,
            found.end);
    if (found.cells > 0.0)
        text +=
            fmt::format("mesh of {:.0f} cells, about {}; flow step {:.2g} s, {:.0f} steps, about {} on one core\n", found.cells,
                        duration_text(found.mesh_seconds), found.flow_step, found.end / found.flow_step, duration_text(found.flow_seconds));
    for (const std::string& model : found.on) text += "on: " + model + "\n";
    return text;
}

nlohmann::json to_json(const RoomPrediction& found) {
    return {{"name", found.name},
            {"medium", found.medium},
            {"solids", found.solids},
            {"grains", found.grains},
            {"mass_kg", found.mass},
            {"fed", std::round(found.fed)},
            {"fed_kg", found.fed_mass},
            {"contact_step_s", found.contact_step},
            {"bed_s", found.bed_time},
            {"end_s", found.end},
            {"cells", std::round(found.cells)},
            {"flow_step_s", found.flow_step},
            {"core_s", found.core_seconds()},
            {"on", found.on}};
}

}  // namespace cutterflow::cases
