/// \file Tables [[prepare]] and [[event]]: what is done to the grains, before the run and in it.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cases/scenes/room/grain_placement.hpp"
#include "cases/scenes/room/reader/room_readers.hpp"
#include "cases/scenes/room/reader/room_reading.hpp"
#include "cases/scenes/room/vec3_of.hpp"

namespace cutterflow::cases {

namespace {

constexpr double k_longest_settling = 20.0;  // [s]

const RoomGrains* grains_of(RoomReading& room, const ParameterValues& values, const std::string& key, const std::string& where) {
    if (!values.has(key)) {
        room.refuse(where, fmt::format("{} is missing", key), "It names a kind of grains", "Add it");
        return nullptr;
    }
    const RoomGrains* grains = room.scene.find_grains(values.text(key));
    if (grains == nullptr) {
        std::vector<std::string> names;
        for (const ParameterValues& one : room.values.tables("grains")) names.push_back(one.text("grains.name"));
        room.refuse_unknown(values, key, names, "grains");
    }
    return grains;
}

/// Of a box or an upright cylinder [m].
double narrowest(const Region& region) {
    if (const auto* box = std::get_if<BoxRegion>(&region)) return (box->upper - box->lower).minCoeff();
    const auto& cylinder = std::get<CylinderRegion>(region);
    return std::min(2.0 * cylinder.radius, cylinder.to.z() - cylinder.from.z());
}

/// Whether one pour or feed is small enough.
bool require_few_enough(RoomReading& room, const RoomGrains& grains, double mass, const char* what, const std::string& where) {
    const double count = std::round(mass / grains.mean_mass());
    if (count <= k_most_grains) return true;
    room.refuse(where, fmt::format("a {} of {:.0f} grains", what, count), fmt::format("A {} has at most {:.0f}", what, k_most_grains),
                fmt::format("{} less, or larger grains", std::string(what) == "pour" ? "Pour" : "Feed"));
    return false;
}

/// Its ends are cut to the room, as a box is; its side is not.
std::optional<Region> cylinder_in_room(RoomReading& room, CylinderRegion cylinder, const std::string& key, const std::string& where) {
    const Vec3 lower = room.scene.lower(), upper = room.scene.upper();
    const double reach = cylinder.radius - room.scene.tolerance();
    if ((cylinder.from.head<2>().array() - reach < lower.head<2>().array()).any() ||
        (cylinder.from.head<2>().array() + reach > upper.head<2>().array()).any()) {
        room.refuse(
            where,
            fmt::format("{}: a cylinder of radius {:g} m about {} reaches out of the room", key, cylinder.radius, text_of(cylinder.from)),
            room.room_rule(), "Move it, or give a smaller radius");
        return std::nullopt;
    }
    cylinder.from.z() = std::max(cylinder.from.z(), lower.z());
    cylinder.to.z() = std::min(cylinder.to.z(), upper.z());
    return cylinder;
}

/// A box or upright cylinder, in which grains begin; the room without one.
/// \param key  that gives it, for messages
std::optional<Region> region_for_grains(RoomReading& room, const std::optional<Region>& given, const std::string& key,
                                        const std::string& where) {
    if (!given) return BoxRegion{room.scene.lower(), room.scene.upper()};
    if (const auto* box = std::get_if<BoxRegion>(&*given)) {
        if (const BoxRegion cut{box->lower.cwiseMax(room.scene.lower()), box->upper.cwiseMin(room.scene.upper())};
            (cut.lower.array() < cut.upper.array()).all())
            return cut;
    } else if (const auto* cylinder = std::get_if<CylinderRegion>(&*given)) {
        const bool upright = cylinder->from.head<2>() == cylinder->to.head<2>();
        if (!upright || cylinder->from.z() > cylinder->to.z()) {
            room.refuse(where, fmt::format("a cylinder from {} to {}", text_of(cylinder->from), text_of(cylinder->to)),
                        "Grains begin in an upright cylinder, from below to above", "Correct it");
            return std::nullopt;
        }
        if (room.meets_room(*given)) return cylinder_in_room(room, *cylinder, key, where);
    } else {
        room.refuse(where, "grains begin in a region of this kind", "They begin in a box or an upright cylinder", "Use one of them");
        return std::nullopt;
    }
    room.require_in_room(*given, key, where);
    return std::nullopt;
}

/// Whether a step has a region, right or wrong.
bool names_region(const ParameterValues& values) {
    return !values.where("prepare.region").empty() || !values.where("prepare.above_m").empty() || !values.where("prepare.below_m").empty();
}

/// None without a region, and with a mistake.
std::optional<Region> region_of_step(RoomReading& room, const ParameterValues& values, const std::string& where) {
    const bool has_above = values.has("prepare.above_m"), has_below = values.has("prepare.below_m");
    std::optional<Region> region = room.read_region(values, "prepare.region", where);
    if (has_above + has_below + region.has_value() > 1) {
        room.refuse(where, "more than one of region, above_m and below_m", "A step has one region", "Remove all but one");
        return std::nullopt;
    }
    if (has_above) region = above(values.number("prepare.above_m"));
    if (has_below) region = below(values.number("prepare.below_m"));
    return region;
}

/// Null with a mistake, or when the solid's own mistakes are told.
const RoomSolid* pressed_solid(RoomReading& room, const ParameterValues& values, const std::string& where) {
    if (!values.has("prepare.solid")) {
        room.refuse(where, "do = \"compress\" without solid", "A solid presses on the grains", "Name it");
        return nullptr;
    }
    const RoomSolid* solid = room.scene.find_solid(values.text("prepare.solid"));
    if (solid == nullptr)
        room.refuse_unknown(values, "prepare.solid", {room.solid_names.begin(), room.solid_names.end()}, "solids");
    else
        room.refuse_in_medium(*solid, values.where("prepare.solid"), "is pressed");
    return solid;
}

void read_compress(RoomReading& room, const ParameterValues& values, const std::string& where) {
    const auto pressure = room.required(values, "prepare.pressure_pa", "do = \"compress\"", "prepare.do");
    const RoomSolid* solid = pressed_solid(room, values, where);
    const Vec3 given = values.has("prepare.direction") ? vec3_of(values, "prepare.direction") : Vec3(-Vec3::UnitZ());
    if (given.norm() == 0.0)
        room.refuse(values.where("prepare.direction"), "prepare.direction = [0, 0, 0]", "It must not be zero", "Correct it");
    if (!pressure || solid == nullptr || given.norm() == 0.0) return;
    const Vec3 direction = given.normalized();
    room.scene.preparation.emplace_back(CompressStep{solid->name, direction, *pressure,
                                                     *pressure * geometry::area_seen_along(solid->surface, direction),
                                                     number_or(values, "prepare.longest_s", k_longest_settling)});
}

/// The lowest part of a box or an upright cylinder.
Region lowest_of(Region region, double height) {
    if (auto* box = std::get_if<BoxRegion>(&region)) box->upper.z() = box->lower.z() + height;
    if (auto* cylinder = std::get_if<CylinderRegion>(&region)) cylinder->to.z() = cylinder->from.z() + height;
    return region;
}

void read_pour(RoomReading& room, const ParameterValues& values, const std::optional<Region>& given, const std::string& where) {
    const RoomGrains* grains = grains_of(room, values, "prepare.grains", where);
    const bool wrong = !given && names_region(values);
    const std::optional<Region> region = wrong ? std::nullopt : region_for_grains(room, given, "prepare.region", where);
    const bool depth = values.has("prepare.depth_m"), mass = values.has("prepare.mass_kg"), count = values.has("prepare.count");
    if (depth + mass + count != 1)
        return room.refuse(where, fmt::format("a pour with {} of depth_m, mass_kg and count", depth + mass + count), "It has one of them",
                           "Correct it");
    if (grains == nullptr || !region) return;
    PourStep pour{grains->name, *region, 0.0, where};
    if (depth)
        pour.mass = grains->mean_density() * k_packed_share * free_volume(room.scene, lowest_of(*region, values.number("prepare.depth_m")));
    if (pour.mass == 0.0 && depth)
        return room.refuse(values.where("prepare.depth_m"), fmt::format("prepare.depth_m = {:g}", values.number("prepare.depth_m")),
                           "It counts from the lower end of the region, and solids take all of that",
                           "Raise the lower end to where grains come to lie");
    if (mass) pour.mass = values.number("prepare.mass_kg");
    if (count) {
        pour.count = static_cast<std::size_t>(values.integer("prepare.count"));
        pour.mass = static_cast<double>(*pour.count) * grains->mean_mass();
    }
    if (!require_few_enough(room, *grains, pour.mass, "pour", where)) return;
    if (const double widest = grains->girth() * grains->largest(); widest > narrowest(*region))
        return room.refuse(where, fmt::format("grains of up to {:.3g} m in a region of {:.3g} m", widest, narrowest(*region)),
                           "A grain begins in its region as a whole", "Pour smaller grains, or give a larger region");
    const double bulk = pour.mass / (grains->mean_density() * k_packed_share), place = free_volume(room.scene, *region);
    if (bulk > place)
        return room.refuse(where, fmt::format("poured grains fill {:.3g} m3", bulk),
                           fmt::format("Their region holds {:.3g} m3 beside the solids", place), "Pour less, or give a larger region");
    room.scene.preparation.emplace_back(pour);
}

void read_step(RoomReading& room, const ParameterValues& values) {
    const std::string& what = values.text("prepare.do");
    const std::string where = values.where("prepare.do");
    if (what != "pour")
        room.refuse_keys(values, {"prepare.grains", "prepare.depth_m", "prepare.mass_kg", "prepare.count"}, "It belongs to do = \"pour\"");
    if (what != "settle" && what != "compress")
        room.refuse_keys(values, {"prepare.longest_s"}, "It belongs to do = \"settle\" and \"compress\"");
    if (what != "compress")
        room.refuse_keys(values, {"prepare.solid", "prepare.direction", "prepare.pressure_pa"}, "It belongs to do = \"compress\"");
    if (what == "settle") {
        room.refuse_keys(values, {"prepare.above_m", "prepare.below_m", "prepare.region"}, "All grains settle");
        room.scene.preparation.emplace_back(SettleStep{number_or(values, "prepare.longest_s", k_longest_settling)});
        return;
    }
    if (what == "compress") {
        room.refuse_keys(values, {"prepare.above_m", "prepare.below_m", "prepare.region"}, "A solid compresses what is in its way");
        return read_compress(room, values, where);
    }
    const std::optional<Region> region = region_of_step(room, values, where);
    if (what == "pour") return read_pour(room, values, region, where);
    if (!names_region(values))
        return room.refuse(where, fmt::format("do = \"{}\" without a region", what), "It is about a part of the room",
                           "Add above_m, below_m or region");
    if (!region) return;
    room.require_in_room(*region, fmt::format("do = \"{}\"", what), where);
    if (what == "trim") room.scene.preparation.emplace_back(TrimStep{*region});
    if (what == "freeze") room.scene.preparation.emplace_back(FreezeStep{*region, where});
}

void require_ordered_preparation(RoomReading& room) {
    bool poured = false;
    const auto& steps = room.values.tables("prepare");
    for (const ParameterValues& step : steps) {
        const std::string& what = step.text("prepare.do");
        if (what != "pour" && !poured) {
            room.refuse(step.where("prepare.do"), fmt::format("do = \"{}\" before anything is poured", what), "The first step pours",
                        "Move it");
            return;
        }
        poured = true;
    }
}

/// Keys that some events alone have.
void refuse_keys_of_other_events(RoomReading& room, const ParameterValues& values) {
    const std::string& what = values.text("event.do");
    const bool of_grains = what == "feed" || what == "extract", of_parts = what == "move" || what == "ramp";
    if (of_grains || of_parts)
        room.refuse_keys(values, {"event.at_s"}, fmt::format("do = \"{}\" lasts from from_s to to_s", what));
    else
        room.refuse_keys(values, {"event.from_s", "event.to_s", "event.rate_kg_s"}, fmt::format("do = \"{}\" happens at at_s", what));
    if (of_parts) room.refuse_keys(values, {"event.rate_kg_s"}, "It belongs to do = \"feed\" and \"extract\"");
    if (of_parts) room.refuse_keys(values, {"event.region"}, "It belongs to what is done to grains");
    if (what != "feed") room.refuse_keys(values, {"event.grains"}, "It belongs to do = \"feed\"");
    if (what != "move") room.refuse_keys(values, {"event.solid", "event.velocity_m_s"}, "It belongs to do = \"move\"");
    if (what != "ramp")
        room.refuse_keys(values, {"event.boundary", "event.speed_m_s", "event.discharge_m3_s"}, "It belongs to do = \"ramp\"");
}

void read_event(RoomReading& room, const ParameterValues& values) {
    const std::string& what = values.text("event.do");
    const std::string where = values.where("event.do");
    refuse_keys_of_other_events(room, values);
    if (what == "move" || what == "ramp") return;  // read_moves, read_ramps
    const std::optional<Region> region = room.read_region(values, "event.region", where);
    if (!region && values.where("event.region").empty() && what != "feed")
        room.refuse(where, fmt::format("do = \"{}\" without a region", what), "It is about a part of the room", "Add region");
    if (region && what != "feed") room.require_in_room(*region, fmt::format("do = \"{}\"", what), where);
    if (what != "feed" && what != "extract") {
        const auto at = room.required(values, "event.at_s", fmt::format("do = \"{}\"", what), "event.do");
        if (at) room.require_in_run(*at, "event.at_s", values);
        if (at && region) room.scene.events.emplace_back(RegionEvent{what, *at, *region});
        return;
    }
    const std::optional<EventSpan> span = room.event_span(values);
    const auto rate = room.required(values, "event.rate_kg_s", what, "event.do");
    if (what == "extract") {
        if (span && rate && region) room.scene.events.emplace_back(ExtractEvent{span->from, span->to, *rate, *region});
        return;
    }
    const RoomGrains* grains = grains_of(room, values, "event.grains", where);
    const std::optional<Region> place = region_for_grains(room, region, "event.region", where);
    if (!span || !rate || grains == nullptr || !place) return;
    if (!require_few_enough(room, *grains, *rate * (span->to - span->from), "feed", values.where("event.rate_kg_s"))) return;
    room.scene.events.emplace_back(FeedEvent{grains->name, span->from, span->to, *rate, *place, where});
}

}  // namespace

void read_preparation(RoomReading& room) {
    for (const ParameterValues& step : room.values.tables("prepare")) read_step(room, step);
    require_ordered_preparation(room);
}

void read_events(RoomReading& room) {
    for (const ParameterValues& event : room.values.tables("event")) read_event(room, event);
}

}  // namespace cutterflow::cases
