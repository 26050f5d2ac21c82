/// \file Table [run].
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/scenes/room/reader/room_readers.hpp"
#include "cases/scenes/room/reader/room_reading.hpp"

namespace cutterflow::cases {

namespace {

constexpr double k_look_per_fall = 0.1;  // longest step over sqrt(d/g)
constexpr double k_most_outputs = 1e4;
constexpr double k_max_courant = 0.9;
constexpr double k_pictures = 50.0, k_checkpoints = 20.0;

/// The gate of a measure: its own, or the one that it names; empty without one.
std::string gate_of(const RoomReading& room, const std::string& measure) {
    if (room.scene.find_gate(measure) != nullptr) return measure;
    for (const ParameterValues& table : room.values.tables("measure"))
        if (table.text("measure.name") == measure && table.has("measure.gate")) return table.text("measure.gate");
    return "";
}

/// Of the stop rule's measure; empty with a mistake, or when the mistakes of the measure are told.
std::string gate_of_stop(RoomReading& room) {
    const std::string& measure = room.values.text("run.stop.measure");
    if (room.wrong_measures.count(measure) > 0) return "";  // its gate was not read
    const std::string name = gate_of(room, measure);
    if (!name.empty()) return name;
    std::vector<std::string> known;
    for (const ParameterValues& table : room.values.tables("measure"))
        if (!gate_of(room, table.text("measure.name")).empty()) known.push_back(table.text("measure.name"));
    room.refuse(room.values.where("run.stop"), fmt::format("run.stop.measure = \"{}\"", measure),
                known.empty() ? std::string("It names a measure with a gate, and the study has none")
                              : fmt::format("Only what passes gates is counted while the run goes on; measures with a gate are {}",
                                            fmt::join(known, ", ")),
                "Correct it");
    return "";
}

void read_stop(RoomReading& room) {
    const auto has = [&](const char* key) { return room.values.has(std::string("run.stop.") + key); };
    const bool idle = has("idle_s"), below = has("below_kg_s") || has("window_s"), of_gate = has("measure") || idle || below;
    const bool settled = has("settled") && room.values.boolean("run.stop.settled");
    const std::string where = room.values.where("run.stop");
    if (of_gate && settled)
        return room.refuse(where, "run.stop with a measure and settled", "A run has one stop rule", "Remove one of them");
    if (settled) room.scene.run.stop = StopWhenAtRest{};
    if (!of_gate) return;
    if (idle && below)
        room.refuse(where, "run.stop with idle_s and below_kg_s", "A run has one stop rule", "Remove one of them");
    else if (below && !(has("below_kg_s") && has("window_s")))
        room.refuse(where, "run.stop has only one of below_kg_s and window_s", "A rate is averaged over a time", "Give both");
    else if (!has("measure") || (!idle && !below))
        room.refuse(where, "run.stop has only one of measure and idle_s", "Nothing or little passes the gate of a measure for a time",
                    "Give measure, and idle_s or below_kg_s with window_s");
    if (below && has("window_s") && room.values.number("run.stop.window_s") > room.values.number("run.end_s"))
        room.refuse(room.values.where("run.stop.window_s"),
                    fmt::format("run.stop.window_s = {:g}", room.values.number("run.stop.window_s")),
                    fmt::format("The run ends at {:g} s", room.values.number("run.end_s")), "Correct one of them");
    if (!has("measure")) return;
    const std::string gate = gate_of_stop(room);
    if (gate.empty()) return;
    if (idle) room.scene.run.stop = StopWhenIdle{gate, room.values.number("run.stop.idle_s")};
    if (has("below_kg_s") && has("window_s"))
        room.scene.run.stop = StopWhenBelow{gate, room.values.number("run.stop.below_kg_s"), room.values.number("run.stop.window_s")};
}

}  // namespace

void read_run(RoomReading& room) {
    RoomRun& run = room.scene.run;
    run.end = room.values.number("run.end_s");
    run.write_interval = number_or(room.values, "run.write_interval_s", run.end / k_pictures);
    run.checkpoint_interval = number_or(room.values, "run.checkpoint_interval_s", run.end / k_checkpoints);
    for (const char* key : {"run.write_interval_s", "run.checkpoint_interval_s"})
        if (room.values.has(key) && room.values.number(key) > run.end)
            room.refuse(room.values.where(key), fmt::format("{} = {:g}", key, room.values.number(key)),
                        fmt::format("The run ends at {:g} s", run.end), "Correct one of them");
    for (const char* key : {"run.write_interval_s", "run.checkpoint_interval_s"})
        if (room.values.has(key) && room.values.number(key) < run.end / k_most_outputs)
            room.refuse(room.values.where(key), fmt::format("{} = {:g} in a run of {:g} s", key, room.values.number(key), run.end),
                        fmt::format("A run has at most {:g} of them", k_most_outputs), "Write less often");
    const double fall = room.scene.grains.empty() || room.scene.gravity_strength == 0.0
                            ? 1.0
                            : std::sqrt(room.scene.smallest_grain() / room.scene.gravity_strength);
    room.scene.bed_step = number_or(room.values, "dem.longest_step_s", k_look_per_fall * fall);
    run.longest_step = std::min(room.scene.bed_step, run.write_interval);
    run.max_courant = number_or(room.values, "run.max_courant", k_max_courant);
    if (!room.scene.medium.present())
        room.refuse_keys(room.values, {"run.max_courant"}, "Without a medium nothing flows (room.medium = \"none\")");
    run.seed = static_cast<std::uint64_t>(room.values.integer("run.seed"));
    read_stop(room);
}

void require_something(RoomReading& room) {
    if (room.values.tables("grains").empty())
        room.refuse(room.values.where("room.size_m"), "The room has no grains",
                    "Rooms are studies of grains; a flow alone is any OpenFOAM case", "Add [[grains]]");
    const bool comes = std::any_of(room.scene.events.begin(), room.scene.events.end(),
                                   [](const RoomEvent& event) { return std::holds_alternative<FeedEvent>(event); });
    const auto& events = room.values.tables("event");
    const bool feeds = std::any_of(events.begin(), events.end(), [](const auto& event) { return event.text("event.do") == "feed"; });
    if (!room.values.tables("grains").empty() && room.values.tables("prepare").empty() && !comes && !feeds)
        room.refuse(room.values.tables("grains").front().where("grains.name"), "No grains come into the room",
                    "They are poured before the run or fed in it", "Add [[prepare]] with do = \"pour\", or [[event]] with do = \"feed\"");
}

}  // namespace cutterflow::cases
