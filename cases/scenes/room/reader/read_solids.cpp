/// \file Tables [[solid]].
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/scenes/room/reader/room_readers.hpp"
#include "cases/scenes/room/reader/room_reading.hpp"
#include "cases/scenes/room/solid_generators.hpp"
#include "cases/scenes/room/vec3_of.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/io/read_surface.hpp"
#include "geometry/surface/soundness.hpp"

namespace cutterflow::cases {

namespace fs = std::filesystem;

namespace {

constexpr double k_tolerance = 1e-9;         // [m]
constexpr double k_narrowest_opening = 3.0;  // lengths of the longest grain; a narrower one is plugged by an arch
constexpr double k_millimetre = 1e-3;        // [m]
constexpr double k_too_large = 10.0;         // sizes of the room, above which a file is taken to be in millimetres

/// How many of these keys are given.
int given(const ParameterValues& values, std::initializer_list<const char*> keys) {
    return static_cast<int>(std::count_if(keys.begin(), keys.end(), [&](const char* key) { return values.has(key); }));
}

void read_turn(RoomReading& room, const ParameterValues& values, double begin, double end, RoomSolid& solid) {
    const Vec3 axis = vec3_of(values, "solid.turn_axis");
    if (axis.norm() == 0.0)
        return room.refuse(values.where("solid.turn_axis"), fmt::format("solid.turn_axis of {} has no length", solid.name),
                           "It is a direction", "Give one that is not 0");
    solid.turn = coupling::WallTurn{
        {vec3_of(values, "solid.turn_origin_m"), axis.normalized()}, rpm_to_rad_s(values.number("solid.turn_rpm")), begin, end};
}

void read_motion(RoomReading& room, const ParameterValues& values, RoomSolid& solid) {
    const bool travels = values.has("solid.velocity_m_s");
    const int of_turn = given(values, {"solid.turn_rpm", "solid.turn_axis", "solid.turn_origin_m"});
    const int times = given(values, {"solid.from_s", "solid.to_s"});
    if (!travels && of_turn + times == 0) return;
    const std::string where = values.where("solid.name");
    if (travels && of_turn > 0)
        return room.refuse(where, fmt::format("{} has velocity_m_s and keys of a turn", solid.name), "A solid travels or turns",
                           "Remove one of them");
    if (times < 2 || (!travels && of_turn < 3))
        return room.refuse(
            where, fmt::format("the motion of {} is not complete", solid.name),
            "A solid travels with velocity_m_s, or turns with turn_rpm about turn_axis through turn_origin_m, from from_s to to_s",
            "Give all of them");
    const double begin = values.number("solid.from_s"), end = values.number("solid.to_s");
    if (begin >= end)
        room.refuse(values.where("solid.to_s"), fmt::format("solid.to_s = {:g} of {}", end, solid.name),
                    fmt::format("It must be after from_s = {:g}", begin), "Correct one of them");
    room.require_in_run(begin, "solid.from_s", values);
    if (solid.removed_at && *solid.removed_at <= begin)
        room.refuse(values.where("solid.removed_at_s"), fmt::format("solid.removed_at_s = {:g} of {}", *solid.removed_at, solid.name),
                    fmt::format("Its motion begins at {:g} s, when it is gone", begin), "Take it away later, or remove its motion");
    if (travels)
        solid.travels = {{vec3_of(values, "solid.velocity_m_s"), begin, end}};
    else
        read_turn(room, values, begin, end, solid);
    room.refuse_in_medium(solid, where, "moves");
}

void require_opening(RoomReading& room, const std::optional<double>& opening, const std::string& name, const std::string& where) {
    const double least = k_narrowest_opening * room.scene.longest_grain();
    if (opening && *opening > 0.0 && *opening < least - k_tolerance)
        room.refuse(
            where, fmt::format("the opening of {} is {:g} m wide", name, *opening),
            fmt::format("An opening below {:g} lengths of the longest grain ({:g} m) is plugged by an arch", k_narrowest_opening, least),
            "Widen it, or take smaller grains");
}

bool generate(RoomReading& room, const ParameterValues& values, RoomSolid& solid) {
    const std::string where = values.where("solid.generate");
    const SolidGenerator& generator = *find_solid_generator(values.text("solid.generate"));
    const auto has = [&](const char* key) { return values.has(std::string("solid.") + key); };
    bool complete = true;
    for (const char* key : generator.keys) {
        if (has(key)) continue;
        room.refuse(where, fmt::format("solid.{} is missing for {}, a {}", key, solid.name, generator.name), generator.help, "Add it");
        complete = false;
    }
    for (const Parameter& row : solid_size_rows()) {
        const std::string key = row.key.substr(std::string("solid.").size());
        const auto is_it = [&](const char* known) { return key == known; };
        const bool known = std::any_of(generator.keys.begin(), generator.keys.end(), is_it) ||
                           std::any_of(generator.may_have.begin(), generator.may_have.end(), is_it);
        if (known || !values.has(row.key)) continue;
        room.refuse(values.where(row.key), fmt::format("{} of {}", row.key, solid.name),
                    fmt::format("A {} has {}", generator.name, fmt::join(generator.keys, ", ")), "Remove it");
    }
    if (!complete) return false;
    try {
        GeneratedSolid made = generator.make(values);
        solid.surface = std::move(made.surface);
        solid.bore = made.bore;
        solid.thinnest = made.thinnest;
        solid.opening = made.opening.value_or(0.0);
        require_opening(room, made.opening, solid.name, where);
    } catch (const UserError& error) {
        for (Mistake mistake : error.mistakes()) {
            mistake.where = where;
            mistake.what = fmt::format("{}: {}", solid.name, mistake.what);
            room.mistakes.add(std::move(mistake));
        }
        return false;
    }
    return true;
}

void refuse_sizes_beside_file(RoomReading& room, const ParameterValues& values) {
    for (const Parameter& row : solid_size_rows())
        if (values.has(row.key))
            room.refuse(values.where(row.key), fmt::format("{} beside solid.file", row.key), "A file has its size", "Remove it");
}

bool read_file_of(RoomReading& room, const ParameterValues& values, RoomSolid& solid) {
    refuse_sizes_beside_file(room, values);
    const fs::path file = room.folder / values.text("solid.file");
    try {
        solid.surface = geometry::read_surface(file);
        geometry::require_sound(geometry::inspect_surface(solid.surface), file.string());
        return true;
    } catch (const UserError& error) {
        for (Mistake mistake : error.mistakes()) {
            if (!mistake.where.empty()) mistake.what = fmt::format("{}: {}", mistake.where, mistake.what);
            mistake.where = values.where("solid.file");
            room.mistakes.add(std::move(mistake));
        }
        return false;
    }
}

bool read_surface(RoomReading& room, const ParameterValues& values, RoomSolid& solid) {
    const std::string where = values.where("solid.name");
    const bool generated = values.has("solid.generate"), file = values.has("solid.file");
    if (generated == file) {
        room.refuse(where, fmt::format("{} has {}", solid.name, file ? "both generate and file" : "neither generate nor file"),
                    "A solid is generated or read from a file", file ? "Remove one of them" : "Add one of them");
        return false;
    }
    return generated ? generate(room, values, solid) : read_file_of(room, values, solid);
}

/// Whether a surface is many times as large as the room, and fits as millimetres.
bool looks_like_millimetres(const RoomScene& scene, const Vec3& extent) {
    return extent.maxCoeff() > k_too_large * scene.size.maxCoeff() &&
           (k_millimetre * extent.array() <= scene.size.array() + scene.tolerance()).all();
}

void require_inside(RoomReading& room, const RoomSolid& solid, const ParameterValues& values, const std::string& where) {
    const geometry::Bounds bounds = geometry::bounds_of(solid.surface);
    const double allowed = room.scene.tolerance();
    const bool inside = (bounds.min.array() >= room.scene.lower().array() - allowed).all() &&
                        (bounds.max.array() <= room.scene.upper().array() + allowed).all();
    if (inside) return;
    const bool millimetres = values.has("solid.file") && looks_like_millimetres(room.scene, bounds.extent());
    room.refuse(where, fmt::format("{} reaches from {} to {} m", solid.name, text_of(bounds.min), text_of(bounds.max)),
                fmt::format("It must lie in the room, from {} to {} m", text_of(room.scene.lower()), text_of(room.scene.upper())),
                millimetres ? "Export solid.file in metres: it is read as metres, and its numbers look like millimetres"
                            : "Move it, or make the room larger");
}

void read_solid(RoomReading& room, const ParameterValues& values) {
    RoomSolid solid;
    solid.name = values.text("solid.name");
    const std::string where = values.where("solid.name");
    room.require_name(solid.name, "solid.name", where);
    if (std::find(coupling::k_domain_sides.begin(), coupling::k_domain_sides.end(), solid.name) != coupling::k_domain_sides.end())
        room.refuse(where, fmt::format("solid.name = \"{}\"", solid.name), "A side of the room is called so", "Change it");
    if (!room.solid_names.insert(solid.name).second)
        room.refuse(where, fmt::format("solid.name = \"{}\" is given twice", solid.name), "Every solid has a name of its own",
                    "Change one");
    solid.material = values.text("solid.material");
    room.require_material(solid.material, "solid.material", place_of(values, "solid.material", "solid.name"));
    solid.felt_by_fluid = values.boolean("solid.fluid");
    if (values.has("solid.removed_at_s")) {
        solid.removed_at = values.number("solid.removed_at_s");
        room.require_in_run(*solid.removed_at, "solid.removed_at_s", values);
        room.refuse_in_medium(solid, where, "is taken away");
    }
    read_motion(room, values, solid);
    if (!read_surface(room, values, solid)) return;
    require_inside(room, solid, values, where);
    room.scene.solids.push_back(std::move(solid));
}

}  // namespace

void read_solids(RoomReading& room) {
    for (const ParameterValues& solid : room.values.tables("solid")) read_solid(room, solid);
}

}  // namespace cutterflow::cases
