/// \file Events `ramp`: the flow through a boundary grows or falls to another one.
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/scenes/room/reader/room_readers.hpp"
#include "cases/scenes/room/reader/room_reading.hpp"

namespace cutterflow::cases {

namespace {

std::vector<std::string> names_of_flows(const RoomScene& scene) {
    std::vector<std::string> names;
    for (const RoomBoundary& boundary : scene.boundaries)
        if (std::holds_alternative<ThroughFlow>(boundary.flow)) names.push_back(boundary.name);
    return names;
}

/// Null with a mistake.
ThroughFlow* ramped_flow(RoomReading& room, const ParameterValues& event, const std::string& where) {
    if (!event.has("event.boundary")) {
        room.refuse(where, "do = \"ramp\" without boundary", "The flow through a boundary changes", "Give the name of one");
        return nullptr;
    }
    for (RoomBoundary& boundary : room.scene.boundaries)
        if (boundary.name == event.text("event.boundary"))
            if (auto* flow = std::get_if<ThroughFlow>(&boundary.flow)) return flow;
    const std::vector<std::string> names = names_of_flows(room.scene);
    room.refuse(event.where("event.boundary"), fmt::format("event.boundary = \"{}\"", event.text("event.boundary")),
                names.empty() ? std::string("No boundary has an inflow or an outflow")
                              : fmt::format("Boundaries with an inflow or an outflow are {}", fmt::join(names, ", ")),
                names.empty() ? "Give one a boundary.name and a flow" : "Name one of them");
    return nullptr;
}

/// Mean speed through the part at the end of the ramp [m/s].
std::optional<double> final_speed(RoomReading& room, const ParameterValues& event, const ThroughFlow& flow, const std::string& where) {
    const bool speed = event.has("event.speed_m_s"), discharge = event.has("event.discharge_m3_s");
    if (speed == discharge) {
        room.refuse(where,
                    fmt::format("do = \"ramp\" with {} speed_m_s {} discharge_m3_s", speed ? "both" : "neither", speed ? "and" : "nor"),
                    "It ends at a speed or at a discharge", speed ? "Remove one of them" : "Add one of them");
        return std::nullopt;
    }
    return speed ? event.number("event.speed_m_s") : event.number("event.discharge_m3_s") / flow.area;
}

void read_ramp(RoomReading& room, const ParameterValues& event) {
    const std::string where = event.where("event.do");
    const std::optional<EventSpan> span = room.event_span(event);
    ThroughFlow* flow = ramped_flow(room, event, where);
    if (flow == nullptr) return;
    const std::optional<double> speed = final_speed(room, event, *flow, where);
    if (!span || !speed) return;
    const auto [last, before] = flow->speed.back();
    if (span->from < last)
        return room.refuse(event.where("event.from_s"),
                           fmt::format("event.from_s = {:g} of a ramp of {}", span->from, event.text("event.boundary")),
                           fmt::format("Its flow changes until {:g} s: by ramp_s, a table or an earlier ramp", last),
                           "Ramps of a boundary follow one another, in the order of the file");
    if (span->from > last) flow->speed.emplace_back(span->from, before);
    flow->speed.emplace_back(span->to, *speed);
}

}  // namespace

void read_ramps(RoomReading& room) {
    for (const ParameterValues& event : room.values.tables("event"))
        if (event.text("event.do") == "ramp") read_ramp(room, event);
}

}  // namespace cutterflow::cases
