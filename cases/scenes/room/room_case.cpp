#include "cases/scenes/room/room_case.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <fmt/format.h>

#include "cases/scenes/rock/shapes_section.hpp"
#include "cases/scenes/room/room_flow.hpp"
#include "cases/study/shape_file.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"

namespace cutterflow::cases {

namespace {

using meshing::FoamDictionary;
using meshing::FoamValue;

constexpr double k_bed_pictures = 0.1;     // between pictures of a preparation [s]
constexpr double k_bed_checkpoints = 0.5;  // [s]
constexpr int k_checkpoints_kept = 2;
constexpr double k_retry = 0.02;                                // until a grain without room is tried again [s]
constexpr std::uint64_t k_feed_sequence = 0x9e3779b97f4a7c15u;  // added to the seed: other numbers than the preparation's
constexpr double k_rest_energy = 1e-6, k_rest_speed = 0.01;
constexpr double k_rest_energy_of_run = 1e-5;  // nothing calms a bed there, which rings for seconds after its grains have come to lie
constexpr double k_calming_energy = 1e-4;      // mean of v^2/(2 g d) from which down a preparation is calmed

/// A section with every key of the struct's table.
template <class Settings>
FoamDictionary section_of(const Settings& settings) {
    FoamDictionary section;
    for (const coupling::Setting<Settings>& setting : coupling::setting_table<Settings>())
        std::visit([&](auto member) { section.add(setting.parameter.key, settings.*member); }, setting.member);
    return section;
}

struct RegionSection {
    FoamDictionary operator()(const EverywhereRegion&) const { return FoamDictionary().add("type", "everything"); }
    FoamDictionary operator()(const BoxRegion& box) const {
        return FoamDictionary().add("type", "box").add("lower", box.lower).add("upper", box.upper);
    }
    FoamDictionary operator()(const SphereRegion& sphere) const {
        return FoamDictionary().add("type", "sphere").add("centre", sphere.centre).add("radius", sphere.radius);
    }
    FoamDictionary operator()(const CylinderRegion& cylinder) const {
        return FoamDictionary().add("type", "cylinder").add("from", cylinder.from).add("to", cylinder.to).add("radius", cylinder.radius);
    }
    FoamDictionary operator()(const HalfSpaceRegion& half) const {
        return FoamDictionary().add("type", "halfSpace").add("point", half.point).add("normal", half.normal);
    }
};

FoamDictionary region_section(const Region& region) {
    return std::visit(RegionSection(), region);
}

/// Solids of a run: without those that were there for the preparation alone. \param moves  whether solids move and are taken away in it
std::vector<const RoomSolid*> solids_of(const RoomScene& scene, bool moves) {
    std::vector<const RoomSolid*> solids;
    for (const RoomSolid& solid : scene.solids)
        if (!moves || solid.removed_at != 0.0) solids.push_back(&solid);
    return solids;
}

bool has_walls(const RoomScene& scene) {
    return std::any_of(scene.sides.begin(), scene.sides.end(), [](SideForGrains side) { return side != SideForGrains::open; });
}

/// Pairs of materials that the run's walls have: the solver refuses others.
FoamDictionary contact_section(const RoomScene& scene, bool moves) {
    std::set<std::string> materials;
    for (const RoomSolid* solid : solids_of(scene, moves)) materials.insert(solid->material);
    if (has_walls(scene)) materials.insert(scene.side_material);
    FoamDictionary pairs;
    for (const RoomPair& pair : scene.pairs) {
        if (pair.other == scene.grain_material) pairs.add("rock_rock", section_of(pair.settings));
        if (materials.count(pair.other) > 0) pairs.add(coupling::k_pair_with_rock + pair.other, section_of(pair.settings));
    }
    return section_of(moves ? scene.contact : scene.bed_contact()).add("pairs", pairs);
}

FoamDictionary press_section(const RoomScene& scene, const CompressStep& compress) {
    return FoamDictionary().add("direction", compress.direction).add("force", compress.force).add("speed", press_speed(scene, compress));
}

FoamValue travel_value(const std::vector<coupling::WallTravel>& travels) {
    std::vector<FoamValue> sections;
    for (const coupling::WallTravel& travel : travels)
        sections.emplace_back(FoamDictionary().add("velocity", travel.velocity).add("from", travel.begin).add("to", travel.end));
    return sections.size() == 1 ? sections.front() : FoamValue::list(sections);
}

/// \param piece  of the preparation; null in the run
FoamValue wall_list(const RoomScene& scene, const std::string& to_run, const BedPiece* piece) {
    const bool moves = piece == nullptr;
    std::vector<FoamValue> walls;
    for (const RoomSolid* one : solids_of(scene, moves)) {
        const RoomSolid& solid = *one;
        FoamDictionary wall;
        wall.add("name", solid.name).add("file", FoamValue::quoted(to_run + surface_file(solid))).add("material", solid.material);
        if (moves && !solid.travels.empty()) wall.add("travel", travel_value(solid.travels));
        if (moves && solid.turn)
            wall.add("turn", FoamDictionary()
                                 .add("origin", solid.turn->axis.origin)
                                 .add("axis", solid.turn->axis.direction)
                                 .add("speed", solid.turn->speed)
                                 .add("from", solid.turn->begin)
                                 .add("to", solid.turn->end));
        if (moves && solid.removed_at) wall.add("removedAt", *solid.removed_at);
        if (piece && piece->compress && piece->compress->solid == solid.name) wall.add("press", press_section(scene, *piece->compress));
        walls.emplace_back(wall);
    }
    return FoamValue::list(walls);
}

/// \param lid  whether the top is closed: grains that are thrown in for a bed bounce
FoamDictionary domain_section(const RoomScene& scene, bool lid) {
    std::vector<FoamValue> walls, frictionless;
    for (std::size_t side = 0; side < scene.sides.size(); ++side) {
        const bool closed = lid && has_walls(scene) && side + 1 == scene.sides.size();
        if (scene.sides[side] == SideForGrains::open && !closed) continue;
        walls.emplace_back(coupling::k_domain_sides[side]);
        if (scene.sides[side] == SideForGrains::frictionless) frictionless.emplace_back(coupling::k_domain_sides[side]);
    }
    FoamDictionary domain;
    domain.add("type", "box").add("lower", scene.lower()).add("upper", scene.upper()).add("walls", FoamValue::list(walls));
    if (!frictionless.empty()) domain.add("frictionless", FoamValue::list(frictionless));
    if (has_walls(scene)) domain.add("material", scene.side_material);
    return domain;
}

/// Kinds of grains that are clumps; each has its shape's name.
std::vector<std::string> shape_names(const RoomScene& scene) {
    std::vector<std::string> names;
    for (const RoomGrains& grains : scene.grains)
        if (!grains.clump.empty()) names.push_back(grains.name);
    return names;
}

void add_shape_files(const RoomScene& scene, std::vector<CaseText>& files) {
    for (const std::string& name : shape_names(scene)) files.push_back({path_of_shape(name), scene.find_grains(name)->clump_text});
}

/// Of a preparation. A grain that moves as fast as k_rest_speed allows while it is slowed down lacks 1 % of its weight to balance.
FoamDictionary calming_section(const RoomScene& scene) {
    const double smallest = scene.smallest_grain(), gravity = scene.gravity_strength;
    return FoamDictionary().add("speed", std::sqrt(2.0 * k_calming_energy * gravity * smallest)).add("time", std::sqrt(smallest / gravity));
}

/// \param fed  whether grains come in that are not there at the start \param piece  of the preparation; null in the run
FoamDictionary rock_section(const RoomScene& scene, const std::string& start, bool fed, const std::string& to_run, const BedPiece* piece) {
    const bool moves = piece == nullptr;
    FoamDictionary rock;
    if (!start.empty()) rock.add("start", FoamValue::quoted(start));
    if (fed)
        rock.add("feed", FoamValue::quoted(names::rock_feed))
            .add("queue", FoamDictionary()
                              .add("interval", std::min(moves ? scene.run.longest_step : scene.bed_step, 1.0))
                              .add("retryInterval", k_retry)
                              .add("reach", 0.0));
    if (!moves && scene.gravity_strength > 0.0) rock.add("calming", calming_section(scene));
    if (const FoamDictionary shapes = shapes_section(shape_names(scene)); !shapes.empty()) rock.add("shapes", shapes);
    return rock.add("contact", contact_section(scene, moves))
        .add("walls", wall_list(scene, to_run, piece))
        .add("domain", domain_section(scene, !moves));
}

/// \param from  until when a flow grows or falls [s]; 0: never
FoamDictionary at_rest(double energy, double from) {
    FoamDictionary rest;
    rest.add("energy", energy).add("speed", k_rest_speed);
    if (from > 0.0) rest.add("from", from);
    return FoamDictionary().add("atRest", rest);
}

/// Grains that lie still before the flow has grown are not yet at rest.
double flows_change_until(const RoomScene& scene) {
    double until = 0.0;
    for (const RoomBoundary& boundary : scene.boundaries)
        if (const auto* flow = std::get_if<ThroughFlow>(&boundary.flow)) until = std::max(until, flow->changes_until());
    return until;
}

FoamDictionary event_section(const RegionEvent& event) {
    return FoamDictionary().add("do", event.what).add("at", event.at).add("region", region_section(event.region));
}

FoamDictionary event_section(const ExtractEvent& event) {
    return FoamDictionary()
        .add("do", "extract")
        .add("from", event.from)
        .add("to", event.to)
        .add("rate", event.rate)
        .add("region", region_section(event.region));
}

/// Events but for feeds, which are rows of rockFeed.csv.
std::vector<FoamValue> event_list(const std::vector<RoomEvent>& events) {
    std::vector<FoamValue> list;
    for (const RoomEvent& event : events) {
        if (const auto* in_region = std::get_if<RegionEvent>(&event)) list.emplace_back(event_section(*in_region));
        if (const auto* extract = std::get_if<ExtractEvent>(&event)) list.emplace_back(event_section(*extract));
    }
    return list;
}

FoamDictionary gate_section(const RoomGate& gate) {
    FoamDictionary section;
    section.add("name", gate.name);
    if (gate.radius > 0.0)
        section.add("centre", gate.centre).add("normal", gate.normal).add("radius", gate.radius);
    else
        section.add("lower", gate.lower).add("upper", gate.upper).add("normal", gate.normal);
    return section;
}

FoamDictionary checkpoint_section(double interval) {
    return FoamDictionary().add("interval", interval).add("keep", k_checkpoints_kept);
}

CaseText foam_text(const std::string& path, const std::string& foam_class, const FoamDictionary& contents) {
    return {path, meshing::foam_file_text(foam_class, path.substr(path.rfind('/') + 1), contents)};
}

CaseText text_of(const FoamFile& file) {
    return foam_text(file.path, file.foam_class, file.contents);
}

FoamDictionary stop_section(const RoomScene& scene) {
    if (std::holds_alternative<StopWhenAtRest>(scene.run.stop)) return at_rest(k_rest_energy_of_run, flows_change_until(scene));
    if (const auto* idle = std::get_if<StopWhenIdle>(&scene.run.stop))
        return FoamDictionary().add("idle", FoamDictionary().add("gate", idle->gate).add("duration", idle->idle));
    if (const auto* below = std::get_if<StopWhenBelow>(&scene.run.stop))
        return FoamDictionary().add("below",
                                    FoamDictionary().add("gate", below->gate).add("rate", below->rate).add("window", below->window));
    return {};
}

CaseText dry_control(double end, double longest_step, double write_interval) {
    return foam_text("system/controlDict", "dictionary",
                     FoamDictionary()
                         .add("application", "cutterFoam")
                         .add("startFrom", "startTime")
                         .add("startTime", 0)
                         .add("stopAt", "endTime")
                         .add("endTime", end)
                         .add("deltaT", longest_step)
                         .add("writeControl", "adjustable")
                         .add("writeInterval", write_interval));
}

}  // namespace

std::string surface_file(const RoomSolid& solid) {
    return "geometry/" + solid.name + ".stl";
}

std::vector<CaseText> bed_case(const RoomScene& scene, const BedPiece& piece, const std::string& start, const std::string& to_run) {
    FoamDictionary coupling;
    coupling.add("medium", "none").add("rock", rock_section(scene, start, !piece.grains.empty(), to_run, &piece));
    if (!piece.events.empty()) {
        std::vector<FoamValue> events;
        for (const RegionEvent& event : piece.events) events.emplace_back(event_section(event));
        coupling.add("events", FoamValue::list(events));
    }
    coupling.add("stop", at_rest(k_rest_energy, 0.0)).add("checkpoint", checkpoint_section(k_bed_checkpoints));
    std::vector<CaseText> files{foam_text(names::coupling_properties, "dictionary", coupling),
                                text_of(gravity_file(scene.upright_gravity())),
                                dry_control(piece.end(), std::min(scene.bed_step, k_bed_pictures), k_bed_pictures)};
    if (!piece.grains.empty()) files.push_back({names::rock_feed, grain_feed_csv(piece.grains)});
    add_shape_files(scene, files);
    return files;
}

std::vector<CaseText> grain_files(const RoomScene& scene, const std::string& start, int first_id) {
    std::mt19937_64 random(scene.run.seed + k_feed_sequence);
    const std::vector<PlacedGrain> fed = place_feeds(scene, first_id, random);
    FoamDictionary coupling;
    if (!scene.medium.present()) coupling.add("medium", "none");
    if (const std::string outlet = outlet_patch(scene); !outlet.empty()) coupling.add("patches", FoamDictionary().add("outlet", outlet));
    coupling.add("rock", rock_section(scene, start, !fed.empty(), "", nullptr));
    if (scene.medium.present()) coupling.add("kernel", section_of(scene.kernel)).add("closures", section_of(scene.closures));
    if (const std::vector<FoamValue> events = event_list(scene.events); !events.empty()) coupling.add("events", FoamValue::list(events));
    if (!scene.gates.empty()) {
        std::vector<FoamValue> gates;
        for (const RoomGate& gate : scene.gates) gates.emplace_back(gate_section(gate));
        coupling.add("gates", FoamValue::list(gates));
    }
    if (const FoamDictionary stop = stop_section(scene); !stop.empty()) coupling.add("stop", stop);
    coupling.add("checkpoint", checkpoint_section(scene.run.checkpoint_interval));
    std::vector<CaseText> files{foam_text(names::coupling_properties, "dictionary", coupling)};
    if (!fed.empty()) files.push_back({names::rock_feed, grain_feed_csv(fed)});
    add_shape_files(scene, files);
    return files;
}

std::vector<CaseText> dry_files(const RoomScene& scene) {
    return {text_of(gravity_file(scene.gravity())), dry_control(scene.run.end, scene.run.longest_step, scene.run.write_interval)};
}

std::vector<CaseText> flow_files(const RoomScene& scene, const meshing::RoomMeshPlan& plan) {
    std::vector<CaseText> files;
    for (const FoamFile& file : room_flow_files(scene, plan)) files.push_back(text_of(file));
    return files;
}

std::string bed_name(const RoomScene& scene, const std::vector<BedPiece>& pieces) {
    std::string all;
    for (const BedPiece& piece : pieces)
        for (const CaseText& file : bed_case(scene, piece, "", "")) all += file.text;
    for (const RoomSolid& solid : scene.solids)
        for (const geometry::Triangle& triangle : solid.surface.triangles)
            for (const std::uint32_t corner : triangle) {
                const Vec3& point = solid.surface.points[corner];
                all += fmt::format("{} {} {}\n", point.x(), point.y(), point.z());
            }
    return sha256(all).substr(0, 16);
}

}  // namespace cutterflow::cases
