#include "cases/scenes/room/reader/room_reading.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/scenes/room/vec3_of.hpp"

namespace cutterflow::cases {

std::string text_of(const Vec3& v) {
    return fmt::format("({:g}, {:g}, {:g})", v.x(), v.y(), v.z());
}

std::string place_of(const ParameterValues& table, const std::string& key, const std::string& otherwise) {
    return table.where(key).empty() ? table.where(otherwise) : table.where(key);
}

double number_or(const ParameterValues& table, const char* key, double otherwise) {
    return table.has(key) ? table.number(key) : otherwise;
}

Region above(double z) {
    return HalfSpaceRegion{Vec3(0.0, 0.0, z), Vec3::UnitZ()};
}

Region below(double z) {
    return HalfSpaceRegion{Vec3(0.0, 0.0, z), -Vec3::UnitZ()};
}

void RoomReading::refuse(const std::string& where, const std::string& what, const std::string& rule, const std::string& remedy) {
    mistakes.add({where, what, rule, remedy});
}

void RoomReading::require_name(const std::string& name, const std::string& key, const std::string& where) {
    const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; };
    if (name.empty() || !std::all_of(name.begin(), name.end(), is_letter))
        refuse(where, fmt::format("{} = \"{}\"", key, name), "It has letters, digits, - and _ alone", "Change it");
}

void RoomReading::require_material(const std::string& name, const std::string& key, const std::string& where) {
    require_name(name, key, where);
    if (name == "rock") refuse(where, fmt::format("{} = \"rock\"", key), "The solver calls grains so", "Give the material another name");
}

void RoomReading::refuse_keys(const ParameterValues& table, std::initializer_list<const char*> keys, const std::string& rule) {
    for (const char* key : keys)
        if (!table.where(key).empty()) refuse(table.where(key), fmt::format("{} is given", key), rule, "Remove it");
}

void RoomReading::refuse_unknown(const ParameterValues& table, const std::string& key, const std::vector<std::string>& names,
                                 const std::string& tables) {
    if (std::find(names.begin(), names.end(), table.text(key)) != names.end()) return;
    const std::string nearest = nearest_word(table.text(key), names);
    refuse(
        table.where(key), fmt::format("{} = \"{}\"", key, table.text(key)),
        names.empty() ? fmt::format("The study has no {}", tables) : fmt::format("The study's {} are {}", tables, fmt::join(names, ", ")),
        nearest.empty() ? "Correct it" : fmt::format("Did you mean {}?", nearest));
}

void RoomReading::refuse_in_medium(const RoomSolid& solid, const std::string& where, const char* what) {
    if (scene.medium.present() && solid.felt_by_fluid)
        refuse(where, fmt::format("{} {} in {}", solid.name, what, scene.medium.name),
               "The mesh stands still: the medium feels solids that stand", "Set fluid = false");
}

std::optional<double> RoomReading::required(const ParameterValues& table, const std::string& key, const std::string& of,
                                            const std::string& at) {
    if (table.has(key)) return table.number(key);
    refuse(table.where(at), fmt::format("{} is missing for {}", key, of), "It needs the key", "Add it");
    return std::nullopt;
}

void RoomReading::require_in_run(double at, const char* key, const ParameterValues& table) {
    const double end = values.number("run.end_s");
    if (at > end)
        refuse(table.where(key), fmt::format("{} = {:g}", key, at), fmt::format("The run ends at {:g} s", end), "Correct one of them");
}

std::optional<EventSpan> RoomReading::event_span(const ParameterValues& event) {
    const std::string& what = event.text("event.do");
    const auto from = required(event, "event.from_s", what, "event.do"), to = required(event, "event.to_s", what, "event.do");
    if (from) require_in_run(*from, "event.from_s", event);
    if (!from || !to) return std::nullopt;
    if (*from < *to) return EventSpan{*from, *to};
    refuse(event.where("event.to_s"), fmt::format("event.to_s = {:g}", *to), fmt::format("It must be after from_s = {:g}", *from),
           "Correct one of them");
    return std::nullopt;
}

bool RoomReading::has_all(const ParameterValues& table, const std::string& shape, std::initializer_list<const char*> keys,
                          const std::string& where) {
    bool complete = true;
    for (const char* key : keys) {
        if (table.has(shape + "." + key)) continue;
        refuse(where, fmt::format("{}.{} is missing", shape, key), "The region is not complete without it", "Add it");
        complete = false;
    }
    return complete;
}

std::optional<Region> RoomReading::read_region(const ParameterValues& table, const std::string& key, const std::string& where) {
    std::vector<std::string> given;
    for (const char* shape : {"box", "cylinder", "sphere", "half_space", "above_m", "below_m"})
        if (!table.where(key + "." + shape).empty()) given.push_back(shape);
    if (given.empty()) {
        if (!table.where(key).empty())
            refuse(table.where(key), fmt::format("{} gives no part of space", key), "It has one shape, as box = { ... }",
                   "Give it one, or remove it");
        return std::nullopt;
    }
    if (given.size() > 1) {
        refuse(where, fmt::format("{} of one table", fmt::join(given, " and ")), "A table has one region", "Remove all but one");
        return std::nullopt;
    }
    const std::string at = key + "." + given.front();
    if (given.front() == "above_m") return above(table.number(at));
    if (given.front() == "below_m") return below(table.number(at));
    if (given.front() == "box") {
        if (!has_all(table, at, {"lower_m", "upper_m"}, where)) return std::nullopt;
        const BoxRegion box{vec3_of(table, at + ".lower_m"), vec3_of(table, at + ".upper_m")};
        if ((box.lower.array() < box.upper.array()).all()) return box;
        refuse(where, fmt::format("a box from {} to {}", text_of(box.lower), text_of(box.upper)),
               "Every coordinate of the lower corner is below that of the upper", "Correct them");
        return std::nullopt;
    }
    if (given.front() == "cylinder") {
        if (!has_all(table, at, {"from_m", "to_m", "radius_m"}, where)) return std::nullopt;
        const CylinderRegion cylinder{vec3_of(table, at + ".from_m"), vec3_of(table, at + ".to_m"), table.number(at + ".radius_m")};
        if (cylinder.from != cylinder.to) return cylinder;
        refuse(where, fmt::format("a cylinder from {} to the same place", text_of(cylinder.from)), "Its axis has two ends", "Correct one");
        return std::nullopt;
    }
    if (given.front() == "sphere") {
        if (!has_all(table, at, {"centre_m", "radius_m"}, where)) return std::nullopt;
        return SphereRegion{vec3_of(table, at + ".centre_m"), table.number(at + ".radius_m")};
    }
    if (!has_all(table, at, {"point_m", "normal"}, where)) return std::nullopt;
    const HalfSpaceRegion half{vec3_of(table, at + ".point_m"), vec3_of(table, at + ".normal")};
    if (half.normal.norm() > 0.0) return HalfSpaceRegion{half.point, half.normal.normalized()};
    refuse(where, "a half space with normal (0, 0, 0)", "It has a direction", "Correct it");
    return std::nullopt;
}

bool RoomReading::meets_room(const Region& region) const {
    const Vec3 lower = scene.lower(), upper = scene.upper();
    if (std::holds_alternative<HalfSpaceRegion>(region)) {
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 place(corner & 1 ? lower.x() : upper.x(), corner & 2 ? lower.y() : upper.y(), corner & 4 ? lower.z() : upper.z());
            if (is_within(region, place)) return true;
        }
        return false;
    }
    const auto overlap = [&](const Vec3& from, const Vec3& to) {
        return (from.array() < upper.array()).all() && (to.array() > lower.array()).all();
    };
    if (const auto* box = std::get_if<BoxRegion>(&region)) return overlap(box->lower, box->upper);
    if (const auto* sphere = std::get_if<SphereRegion>(&region))
        return overlap(sphere->centre - Vec3::Constant(sphere->radius), sphere->centre + Vec3::Constant(sphere->radius));
    if (const auto* cylinder = std::get_if<CylinderRegion>(&region)) {
        const Vec3 margin = Vec3::Constant(cylinder->radius);
        return overlap(cylinder->from.cwiseMin(cylinder->to) - margin, cylinder->from.cwiseMax(cylinder->to) + margin);
    }
    return true;
}

void RoomReading::require_in_room(const Region& region, const std::string& what, const std::string& where) {
    if (!meets_room(region)) refuse(where, fmt::format("{} is about a region outside the room", what), room_rule(), "Correct the region");
}

std::string RoomReading::room_rule() const {
    return fmt::format("The room reaches from {} to {} m", text_of(scene.lower()), text_of(scene.upper()));
}

}  // namespace cutterflow::cases
