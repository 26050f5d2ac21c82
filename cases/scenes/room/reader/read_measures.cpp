/// \file Tables [[measure]], by themselves and in their room.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/scenes/room/reader/room_readers.hpp"
#include "cases/scenes/room/reader/room_reading.hpp"
#include "cases/scenes/room/room_measures.hpp"
#include "cases/scenes/room/vec3_of.hpp"
#include "geometry/base/profiles/profile.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "postproc/analysis/measures/measure_kinds.hpp"

namespace cutterflow::cases {

namespace fs = std::filesystem;

namespace {

constexpr double k_rounding = 1e-6;  // of a number that is written twice

/// Names of what measure.wall can be.
std::vector<std::string> walls_of(const RoomReading& room) {
    std::vector<std::string> names(room.solid_names.begin(), room.solid_names.end());
    for (std::size_t side = 0; side < coupling::k_domain_sides.size(); ++side)
        if (room.scene.sides[side] != SideForGrains::open) names.emplace_back(coupling::k_domain_sides[side]);
    return names;
}

/// Whether a box and the room have a place in common; on the room's sides counts.
bool meets_box(const RoomReading& room, const Vec3& lower, const Vec3& upper) {
    const double allowed = room.scene.tolerance();
    return (lower.array() <= room.scene.upper().array() + allowed).all() && (upper.array() >= room.scene.lower().array() - allowed).all();
}

/// The pressure is that of the medium, which solids cut out.
void require_medium_at(RoomReading& room, const ParameterValues& measure, const char* key) {
    const Vec3 place = vec3_of(measure, key);
    for (const RoomSolid& solid : room.scene.solids)
        if (solid.felt_by_fluid && geometry::SolidSearch(solid.surface).contains(place))
            room.refuse(measure.where(key), fmt::format("{} of {} lies inside {}", key, measure.text("measure.name"), solid.name),
                        "There is no medium, and so no pressure", "Move it");
}

/// A pressure drop needs a medium, and its density: the solver's pressure is per density, which makes it one in Pa.
void require_medium(RoomReading& room, const ParameterValues& measure, const std::string& where) {
    if (!room.scene.medium.present())
        return room.refuse(where, "measure.what = \"pressure_drop\" in a room without a medium", "Without a medium there is no pressure",
                           "Remove the measure, or choose a room.medium");
    const double given = measure.number("measure.density_kg_m3"), medium = room.scene.medium.density;
    if (std::abs(given - medium) <= k_rounding * medium) return;
    room.refuse(measure.where("measure.density_kg_m3"),
                fmt::format("measure.density_kg_m3 = {:g} of {}", given, measure.text("measure.name")),
                fmt::format("The room's {} has {:g} kg/m3, and a pressure drop is in proportion to it", room.scene.medium.name, medium),
                fmt::format("Write {:g}, or set room.density_kg_m3", medium));
}

/// \param from,to  what the key places along an axis, 0 to 2
void require_interval(RoomReading& room, const ParameterValues& measure, const char* key, int axis, double from, double to) {
    Vec3 lower = room.scene.lower(), upper = room.scene.upper();
    lower[axis] = from;
    upper[axis] = to;
    if (from <= to && meets_box(room, lower, upper)) return;
    room.refuse(measure.where(key), fmt::format("{} of {} lies outside the room along {}", key, measure.text("measure.name"), "xyz"[axis]),
                room.room_rule(), "Correct it");
}

/// \param lower,upper  corners of the box around what the key places
void require_place(RoomReading& room, const ParameterValues& measure, const char* key, const Vec3& lower, const Vec3& upper) {
    if (meets_box(room, lower, upper)) return;
    room.refuse(measure.where(key),
                fmt::format("{} = {} of {} lies outside the room", key, text_of(vec3_of(measure, key)), measure.text("measure.name")),
                room.room_rule(), "Correct it");
}

/// A solid that is taken away has a force as long as it stands, from the measure's from_s on.
void require_standing(RoomReading& room, const ParameterValues& measure) {
    const RoomSolid* solid = room.scene.find_solid(measure.text("measure.wall"));
    const double from = number_or(measure, "measure.from_s", 0.0);
    if (solid == nullptr || !solid->removed_at || *solid->removed_at > from) return;
    room.refuse(measure.where("measure.wall"), fmt::format("measure.wall = \"{}\" of {}", solid->name, measure.text("measure.name")),
                fmt::format("{} is taken away at {:g} s, and the measure begins at {:g} s", solid->name, *solid->removed_at, from),
                "Measure another wall, or take the solid away later");
}

/// Levels and the axis of a heap are in the room, and so is a part of a profile.
void check_levels(RoomReading& room, const ParameterValues& measure) {
    for (const char* key : {"measure.base_m", "measure.undisturbed_m"})
        if (measure.has(key)) require_interval(room, measure, key, 2, measure.number(key), measure.number(key));
    if (measure.has("measure.centre_m"))
        for (int axis = 0; axis < 2; ++axis) {
            const double at = measure.numbers("measure.centre_m")[axis];
            require_interval(room, measure, "measure.centre_m", axis, at, at);
        }
    const int along = measure.has("measure.along") && measure.text("measure.along") == "y" ? 1 : 0;
    if (measure.has("measure.from_m"))
        require_interval(room, measure, "measure.from_m", along, measure.number("measure.from_m"), room.scene.upper()[along]);
    if (measure.has("measure.to_m"))
        require_interval(room, measure, "measure.to_m", along, room.scene.lower()[along], measure.number("measure.to_m"));
}

/// Region, gate and points of a measure are in the room; gates and points may lie on its sides.
void check_places(RoomReading& room, const ParameterValues& measure) {
    const std::string& name = measure.text("measure.name");
    if (const std::optional<Region> region = room.read_region(measure, "measure.region", measure.where("measure.name")))
        room.require_in_room(*region, "measure." + name, place_of(measure, "measure.region", "measure.name"));
    if (measure.has("measure.gate.disc_m")) {
        const RoomGate& gate = *room.scene.find_gate(name);
        const Vec3 reach = gate.radius * (1.0 - gate.normal.array().square()).max(0.0).sqrt().matrix();
        require_place(room, measure, "measure.gate.disc_m", gate.centre - reach, gate.centre + reach);
    }
    if (measure.has("measure.gate.lower_m")) {
        const RoomGate& gate = *room.scene.find_gate(name);
        require_place(room, measure, "measure.gate.lower_m", gate.lower.cwiseMin(gate.upper), gate.lower.cwiseMax(gate.upper));
    }
    for (const char* key : {"measure.upstream_m", "measure.downstream_m"})
        if (measure.has(key)) {
            require_place(room, measure, key, vec3_of(measure, key), vec3_of(measure, key));
            require_medium_at(room, measure, key);
        }
    check_levels(room, measure);
}

/// A profile is read once here, so that no run is made for a file that cannot be used.
void check_given_profile(RoomReading& room, const ParameterValues& measure) {
    const fs::path file = room.folder / measure.text("measure.against");
    if (!fs::is_regular_file(file))
        return room.refuse(measure.where("measure.against"), fmt::format("measure.against: there is no file {}", file.string()),
                           "It is a CSV file of a profile; its path is relative to the study", "Correct the path, or put the file there");
    room.mistakes.gather([&] { read_profile(file); });
}

/// Any map covers two grains at least; the extent of a box is known, and checked with its table.
void require_cell(RoomReading& room, const ParameterValues& measure) {
    const double extent = 2.0 * room.scene.smallest_grain();
    if (!std::isfinite(extent) || measure.has("measure.region.box.lower_m")) return;
    if (const auto mistake = postproc::map_size_mistake(extent, extent, measure.number("measure.cell_m")))
        room.refuse(measure.where("measure.cell_m"), fmt::format("measure.{}, of two of the smallest grains alone", mistake->what),
                    mistake->rule, "Take larger cells");
}

void check_measure(RoomReading& room, const ParameterValues& measure) {
    const std::string &name = measure.text("measure.name"), where = measure.where("measure.name");
    if (measure.text("measure.what") == "pressure_drop") require_medium(room, measure, where);
    if (measure.has("measure.against")) check_given_profile(room, measure);
    if (measure.has("measure.cell_m")) require_cell(room, measure);
    check_places(room, measure);
    for (const char* key : {"measure.at_s", "measure.from_s", "measure.to_s"})
        if (measure.has(key)) room.require_in_run(measure.number(key), key, measure);
    if (room.scene.find_gate(name) != nullptr) room.require_name(name, "measure.name", where);
    if (measure.has("measure.gate") && room.scene.find_gate(measure.text("measure.gate")) == nullptr &&
        room.wrong_measures.count(measure.text("measure.gate")) == 0)
        room.refuse(measure.where("measure.gate"), fmt::format("measure.gate = \"{}\"", measure.text("measure.gate")),
                    "It names a measure that places a gate, or places one itself",
                    "Correct it, or write gate = { disc_m = [x, y, z], radius_m = r }");
    const std::vector<std::string> walls = walls_of(room);
    if (measure.has("measure.wall") && std::find(walls.begin(), walls.end(), measure.text("measure.wall")) == walls.end())
        room.refuse(measure.where("measure.wall"), fmt::format("measure.wall = \"{}\"", measure.text("measure.wall")),
                    "It names a solid, or a side of the room that is a wall", fmt::format("Name one of {}", fmt::join(walls, ", ")));
    if (measure.has("measure.wall")) require_standing(room, measure);
}

}  // namespace

/// The rules of every table by itself, then those of the sound ones in their room.
void read_measures(RoomReading& room) {
    std::set<std::string> names;
    std::size_t number = 0;
    std::vector<const ParameterValues*> sound;
    room.scene.measures = nlohmann::json::array();
    for (const ParameterValues& measure : room.values.tables("measure")) {
        const std::string &name = measure.text("measure.name"), where = measure.where("measure.name");
        if (!names.insert(name).second)
            room.refuse(where, fmt::format("measure.name = \"{}\" is given twice", name), "Every measure has a name of its own",
                        "Change one");
        const std::vector<Mistake> mistakes = measure_mistakes(measure, ++number);
        room.mistakes.add(mistakes);
        if (!mistakes.empty()) {
            room.wrong_measures.insert(name);
            continue;
        }
        sound.push_back(&measure);
        room.scene.measures.push_back(measure_json(measure));
    }
    room.scene.gates = gates_of(room.scene.measures);
    for (const ParameterValues* measure : sound) check_measure(room, *measure);
}

}  // namespace cutterflow::cases
