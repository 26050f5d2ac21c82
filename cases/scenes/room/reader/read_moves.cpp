/// \file Events `move`: ways of solids beside the one that their tables give. And whether contacts bear the speeds of all solids.
#include <algorithm>

#include <fmt/format.h>

#include "cases/scenes/room/reader/room_readers.hpp"
#include "cases/scenes/room/reader/room_reading.hpp"
#include "cases/scenes/room/vec3_of.hpp"
#include "cases/study/contact_rules.hpp"

namespace cutterflow::cases {

namespace {

constexpr double k_deepest_overlap = 0.5;  // radii, of grains and a solid that hits them

/// Null with a mistake, or when the solid's own mistakes are told.
RoomSolid* moved_solid(RoomReading& room, const ParameterValues& event, const std::string& where) {
    if (!event.has("event.solid")) {
        room.refuse(where, "do = \"move\" without solid", "A solid moves", "Name it");
        return nullptr;
    }
    const std::string& name = event.text("event.solid");
    const auto solid = std::find_if(room.scene.solids.begin(), room.scene.solids.end(), [&](const auto& one) { return one.name == name; });
    if (solid != room.scene.solids.end()) return &*solid;
    room.refuse_unknown(event, "event.solid", {room.solid_names.begin(), room.solid_names.end()}, "solids");
    return nullptr;
}

void read_move(RoomReading& room, const ParameterValues& event) {
    const std::string where = event.where("event.do");
    RoomSolid* solid = moved_solid(room, event, where);
    const std::optional<EventSpan> span = room.event_span(event);
    if (!event.has("event.velocity_m_s"))
        return room.refuse(where, "event.velocity_m_s is missing for do = \"move\"", "It needs the key", "Add it");
    if (solid == nullptr) return;
    const std::string at = event.where("event.solid");
    room.refuse_in_medium(*solid, at, "moves");
    if (solid->turn)
        return room.refuse(at, fmt::format("a move of {}, which turns", solid->name), "A solid travels or turns", "Remove one of them");
    if (!span) return;
    if (solid->removed_at && *solid->removed_at <= span->from)
        return room.refuse(at, fmt::format("a move of {} from {:g} s on", solid->name, span->from),
                           fmt::format("It is taken away at {:g} s", *solid->removed_at), "Correct one of them");
    for (const coupling::WallTravel& other : solid->travels)
        if (span->from < other.end && other.begin < span->to)
            return room.refuse(at, fmt::format("a move of {} from {:g} to {:g} s", solid->name, span->from, span->to),
                               fmt::format("A solid has one velocity at a time, and it moves from {:g} to {:g} s", other.begin, other.end),
                               "Let one begin when the other ends");
    solid->travels.push_back({vec3_of(event, "event.velocity_m_s"), span->from, span->to});
    std::sort(solid->travels.begin(), solid->travels.end(), [](const auto& a, const auto& b) { return a.begin < b.begin; });
}

/// Where the study says how fast a solid moves at its fastest.
std::string place_of_speed(const RoomReading& room, const RoomSolid& solid) {
    const auto is_it = [&](const ParameterValues& table, const char* name, const char* velocity) {
        return table.has(name) && table.text(name) == solid.name && table.has(velocity) &&
               vec3_of(table, velocity).norm() == solid.fastest();
    };
    for (const ParameterValues& event : room.values.tables("event"))
        if (is_it(event, "event.solid", "event.velocity_m_s")) return event.where("event.velocity_m_s");
    const auto& tables = room.values.tables("solid");
    const auto table = std::find_if(tables.begin(), tables.end(), [&](const auto& one) { return one.text("solid.name") == solid.name; });
    return table->where(solid.turn ? "solid.turn_rpm" : "solid.velocity_m_s");
}

/// Grains and their contact step bear the solid's speed.
void allow_for_impacts(RoomReading& room, const RoomSolid& solid) {
    const double speed = solid.fastest();
    if (speed == 0.0) return;
    const std::string where = place_of_speed(room, solid);
    double& largest = room.scene.contact.max_speed;
    if (!room.values.has("dem.max_speed_m_s"))
        largest = std::max(largest, speed);
    else if (largest < speed)
        room.refuse(where, fmt::format("{} moves at up to {:.4g} m/s", solid.name, speed),
                    fmt::format("The contact step allows for impacts at up to dem.max_speed_m_s = {:g}", largest),
                    "Raise that, or leave it out");
    const double overlap = impact_overlap(room.scene.contact, room.scene.densest_grain(), speed);
    if (overlap > k_deepest_overlap)
        room.refuse(where,
                    fmt::format("{} moves at up to {:.4g} m/s: grains that it meets sink into it by {:.2g} of their radius", solid.name,
                                speed, overlap),
                    fmt::format("Grains pass through a solid when that comes to 1; up to {:g} is allowed", k_deepest_overlap),
                    "Give the grains' material a larger modulus, or the solid less speed");
}

}  // namespace

void read_moves(RoomReading& room) {
    for (const ParameterValues& event : room.values.tables("event"))
        if (event.text("event.do") == "move") read_move(room, event);
    if (room.scene.grains.empty() || room.scene.contact.youngs_modulus <= 0.0) return;
    for (const RoomSolid& solid : room.scene.solids) allow_for_impacts(room, solid);
}

}  // namespace cutterflow::cases
