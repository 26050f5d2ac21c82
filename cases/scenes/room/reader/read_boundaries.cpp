/// \file Tables [[boundary]]: what grains and medium meet at the sides.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/scenes/room/reader/room_readers.hpp"
#include "cases/scenes/room/reader/room_reading.hpp"
#include "cases/scenes/room/side_parts.hpp"
#include "cases/scenes/room/vec3_of.hpp"

namespace cutterflow::cases {

namespace {

constexpr std::array<const char*, 6> k_sides{"x_min", "x_max", "y_min", "y_max", "bottom", "top"};  // by coupling::DomainSide

std::vector<coupling::DomainSide> sides_of(const std::string& word) {
    using coupling::DomainSide;
    if (word == "sides") return {DomainSide::x_min, DomainSide::x_max, DomainSide::y_min, DomainSide::y_max};
    const auto found = std::find(k_sides.begin(), k_sides.end(), word);
    return {static_cast<DomainSide>(found - k_sides.begin())};
}

/// What later tables are held against.
struct BoundariesRead {
    std::map<coupling::DomainSide, std::string> grains_at;
    std::vector<std::string> places;  ///< of the scene's boundaries, in the study
};

/// The area is known when the part is; a discharge was kept as a speed through 1 m2 until now.
void set_flow_through(const RoomReading& room, RoomBoundary& boundary, const ParameterValues& values) {
    auto* flow = std::get_if<ThroughFlow>(&boundary.flow);
    if (flow == nullptr) return;
    flow->area = area_of(boundary, room.scene);
    if (values.has("boundary.flow.inflow_m3_s") || values.has("boundary.flow.outflow_m3_s"))
        for (auto& [time, speed] : flow->speed) speed /= flow->area;
}

double distance_to_side(const RoomReading& room, const SidePart& part, coupling::DomainSide side) {
    const auto number = static_cast<std::size_t>(side);
    const auto axis = static_cast<Eigen::Index>(number / 2);
    const double position = (number % 2 == 0 ? room.scene.lower() : room.scene.upper())[axis];
    if (const auto* disc = std::get_if<SideDisc>(&part)) return std::abs(disc->centre[axis] - position);
    if (const auto* rectangle = std::get_if<SideRectangle>(&part))
        return std::max(std::abs(rectangle->lower[axis] - position), std::abs(rectangle->upper[axis] - position));
    return 0.0;
}

/// Discs and rectangles lie on their side, bands between bottom and top.
void require_on_sides(RoomReading& room, const RoomBoundary& boundary, const std::string& where) {
    const double allowed = room.scene.tolerance();
    for (const coupling::DomainSide side : boundary.sides) {
        const BoxRegion whole = bounds_of(WholeSide{}, side, room.scene), part = bounds_of(boundary.part, side, room.scene);
        const bool inside =
            (part.lower.array() >= whole.lower.array() - allowed).all() && (part.upper.array() <= whole.upper.array() + allowed).all();
        const bool has_area = ((part.upper - part.lower).array() > 0.0).count() == 2;
        if (inside && has_area && distance_to_side(room, boundary.part, side) <= allowed) continue;
        return room.refuse(where, fmt::format("{} is about no part of the side {}", boundary.name, k_sides[static_cast<std::size_t>(side)]),
                           fmt::format("The side reaches from {} to {} m", text_of(whole.lower), text_of(whole.upper)),
                           "Correct the disc, rectangle or level");
    }
}

void set_sides(RoomReading& room, BoundariesRead& read, const std::vector<coupling::DomainSide>& sides, const std::string& word,
               const std::string& where) {
    const SideForGrains kind = word == "open"           ? SideForGrains::open
                               : word == "frictionless" ? SideForGrains::frictionless
                                                        : SideForGrains::wall;
    for (const coupling::DomainSide side : sides) {
        const auto [given, is_new] = read.grains_at.emplace(side, word);
        if (!is_new && given->second != word)
            room.refuse(where, fmt::format("boundary.grains = \"{}\" where another table says \"{}\"", word, given->second),
                        "A side is one thing to grains, all over", "Remove one of them");
        room.scene.sides[static_cast<std::size_t>(side)] = kind;
    }
}

std::optional<SideFlow> with_table(RoomReading& room, const ParameterValues& values, ThroughFlow flow, const std::string& where) {
    const std::vector<double> times = values.has("boundary.flow.times_s") ? values.numbers("boundary.flow.times_s") : std::vector<double>{};
    const std::vector<double>& speeds = values.numbers("boundary.flow.speeds_m_s");
    if (times.empty() || times.size() != speeds.size() || !std::is_sorted(times.begin(), times.end(), std::less_equal<>())) {
        room.refuse(where, fmt::format("{} times_s and {} speeds_m_s", times.size(), speeds.size()),
                    "There is a time for every speed, and times rise", "Correct them");
        return std::nullopt;
    }
    for (std::size_t i = 0; i < times.size(); ++i) flow.speed.emplace_back(times[i], speeds[i]);
    return flow;
}

/// Keys that only some kinds of flow have. \param kind  its key in boundary.flow
void refuse_keys_of_other_flows(RoomReading& room, const ParameterValues& values, const std::string& kind) {
    const bool table = kind == "speeds_m_s";
    if (table || kind == "rough_m") room.refuse_keys(values, {"boundary.flow.ramp_s"}, "Only one speed or discharge grows from 0");
    if (!table) room.refuse_keys(values, {"boundary.flow.times_s"}, "They are those of speeds_m_s");
}

std::optional<SideFlow> read_flow(RoomReading& room, const ParameterValues& values, const std::string& where) {
    if (values.has("boundary.flow")) {
        const std::string& word = values.text("boundary.flow");
        if (word == "slip") return Slip{};
        if (word == "pressure") return FixedPressure{};
        return NoSlip{};
    }
    std::vector<std::string> given;
    for (const char* key : {"rough_m", "inflow_m_s", "outflow_m_s", "inflow_m3_s", "outflow_m3_s", "speeds_m_s"})
        if (values.has(std::string("boundary.flow.") + key)) given.emplace_back(key);
    if (given.size() != 1) {
        room.refuse(where, fmt::format("boundary.flow has {}", given.empty() ? "no kind" : fmt::format("{}", fmt::join(given, " and "))),
                    "It has one of rough_m, inflow_m_s, outflow_m_s, inflow_m3_s, outflow_m3_s, speeds_m_s",
                    given.empty() ? "Add one" : "Remove all but one");
        return std::nullopt;
    }
    refuse_keys_of_other_flows(room, values, given.front());
    if (given.front() == "rough_m") return RoughWall{values.number("boundary.flow.rough_m")};
    ThroughFlow flow;
    flow.into_room = given.front().rfind("outflow", 0) != 0;
    if (given.front() == "speeds_m_s") return with_table(room, values, flow, where);
    const double speed = values.number("boundary.flow." + given.front()), ramp = number_or(values, "boundary.flow.ramp_s", 0.0);
    if (ramp > 0.0) flow.speed.emplace_back(0.0, 0.0);
    flow.speed.emplace_back(ramp, speed);
    return flow;
}

std::optional<SidePart> part_inside(RoomReading& room, const ParameterValues& values, coupling::DomainSide side) {
    const std::string& name = values.text("boundary.inside");
    const auto solid =
        std::find_if(room.scene.solids.begin(), room.scene.solids.end(), [&](const RoomSolid& one) { return one.name == name; });
    if (solid == room.scene.solids.end() && room.solid_names.count(name) > 0) return std::nullopt;  // its own mistakes are told
    if (solid == room.scene.solids.end() || !solid->bore) {
        room.refuse(values.where("boundary.inside"), fmt::format("boundary.inside = \"{}\"", name),
                    "It names a solid that is a pipe, a tube or a ring", "Correct it");
        return std::nullopt;
    }
    const auto number = static_cast<std::size_t>(side);
    const auto axis = static_cast<Eigen::Index>(number / 2);
    const double position = (number % 2 == 0 ? room.scene.lower() : room.scene.upper())[axis];
    const Vec3 along = (solid->bore->to - solid->bore->from).normalized();
    const bool ends_there =
        std::min(std::abs(solid->bore->from[axis] - position), std::abs(solid->bore->to[axis] - position)) < room.scene.tolerance();
    if (!ends_there || std::abs(std::abs(along[axis]) - 1.0) > 1e-6) {
        room.refuse(values.where("boundary.inside"),
                    fmt::format("{} does not meet the side {} at a right angle", name, values.text("boundary.on")),
                    "The bore cuts a disc out of the side", "End the pipe on the side, or give disc");
        return std::nullopt;
    }
    Vec3 centre = solid->bore->from;
    centre[axis] = position;
    return SideDisc{centre, solid->bore->radius};
}

/// The part of vertical sides between levels.
std::optional<SidePart> read_band(RoomReading& room, const ParameterValues& values) {
    const std::string& on = values.text("boundary.on");
    const double lower = number_or(values, "boundary.above_m", 0.0), upper = number_or(values, "boundary.below_m", room.scene.size.z());
    if (on != "bottom" && on != "top") return SideBand{lower, upper};
    for (const char* key : {"boundary.above_m", "boundary.below_m"})
        if (values.has(key))
            room.refuse(values.where(key), fmt::format("{} = {:g} on the side {}", key, values.number(key), on),
                        "It bounds a part of vertical sides, and this one is level", "Remove it, or give disc or rectangle");
    return std::nullopt;
}

std::optional<SidePart> read_part(RoomReading& room, const ParameterValues& values, const RoomBoundary& boundary,
                                  const std::string& where) {
    std::vector<std::string> given;
    for (const char* key : {"boundary.inside", "boundary.disc", "boundary.rectangle"})
        if (!values.where(key).empty()) given.emplace_back(key);
    const bool band = values.has("boundary.above_m") || values.has("boundary.below_m");
    if (band) given.emplace_back("above_m or below_m");
    if (given.size() > 1) {
        room.refuse(where, fmt::format("{} in one table", fmt::join(given, " and ")), "A table is about one part of its sides",
                    "Write two tables");
        return std::nullopt;
    }
    if (given.empty()) return WholeSide{};
    if (band) return read_band(room, values);
    if (boundary.sides.size() > 1) {
        room.refuse(where, fmt::format("{} on several sides", given.front()), "A disc or rectangle lies on one side", "Name the side");
        return std::nullopt;
    }
    if (given.front() == "boundary.disc") {
        if (!room.has_all(values, "boundary.disc", {"centre_m", "radius_m"}, where)) return std::nullopt;
        return SideDisc{vec3_of(values, "boundary.disc.centre_m"), values.number("boundary.disc.radius_m")};
    }
    if (given.front() == "boundary.rectangle") {
        if (!room.has_all(values, "boundary.rectangle", {"lower_m", "upper_m"}, where)) return std::nullopt;
        return SideRectangle{vec3_of(values, "boundary.rectangle.lower_m"), vec3_of(values, "boundary.rectangle.upper_m")};
    }
    return part_inside(room, values, boundary.sides.front());
}

void read_boundary(RoomReading& room, BoundariesRead& read, const ParameterValues& values) {
    const std::string where = values.where("boundary.on"), on = values.text("boundary.on");
    RoomBoundary boundary;
    boundary.sides = sides_of(on);
    boundary.name = values.has("boundary.name") ? values.text("boundary.name") : fmt::format("{}_{}", on, room.scene.boundaries.size() + 1);
    if (values.has("boundary.grains"))
        set_sides(room, read, boundary.sides, values.text("boundary.grains"), values.where("boundary.grains"));
    if (values.where("boundary.flow").empty())
        return room.refuse_keys(
            values, {"boundary.inside", "boundary.disc", "boundary.rectangle", "boundary.above_m", "boundary.below_m"},
            "The table has no flow, and boundary.grains is about the whole of a side: an opening for grains is one between solids");
    const std::optional<SideFlow> flow = read_flow(room, values, where);
    const std::optional<SidePart> part = read_part(room, values, boundary, where);
    if (!flow || !part) return;
    if (!room.scene.medium.present())
        return room.refuse(place_of(values, "boundary.flow", "boundary.on"), "boundary.flow in a room without a medium",
                           "Nothing flows there (room.medium = \"none\")", "Remove it");
    boundary.flow = *flow;
    boundary.part = *part;
    require_on_sides(room, boundary, where);
    set_flow_through(room, boundary, values);
    read.places.push_back(where);
    room.scene.boundaries.push_back(std::move(boundary));
}

/// What flows in flows out, through a part where the pressure is given: flows that are both given differ by rounding at least.
void require_balanced_flow(RoomReading& room, const BoundariesRead& read) {
    bool in = false, out = false, pressure = false;
    for (const RoomBoundary& boundary : room.scene.boundaries) {
        pressure = pressure || std::holds_alternative<FixedPressure>(boundary.flow);
        if (const auto* flow = std::get_if<ThroughFlow>(&boundary.flow)) (flow->into_room ? in : out) = true;
    }
    if (pressure || (!in && !out)) return;
    room.refuse(read.places.front(), in ? "an inflow without an outlet" : "an outflow without an inlet",
                "What comes into a closed room leaves it at once", "Add a boundary with flow = \"pressure\"");
}

/// Later tables cover earlier ones, but a flow has the area that its table gives.
void require_whole_flows(RoomReading& room, const BoundariesRead& read) {
    const std::vector<RoomBoundary>& all = room.scene.boundaries;
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t later = i + 1; later < all.size(); ++later)
            if (std::holds_alternative<ThroughFlow>(all[i].flow) && overlap(all[i], all[later], room.scene))
                room.refuse(read.places[later], fmt::format("{} covers a part of {}", all[later].name, all[i].name),
                            "Later tables cover earlier ones, and a flow goes through the whole of its part",
                            "Write the flow's table last, or give it a disc or a rectangle that nothing covers");
}

/// Sides, solids and boundaries are patches of one mesh.
void require_patch_names(RoomReading& room, const BoundariesRead& read) {
    if (!room.scene.medium.present()) return;
    std::set<std::string> names(k_sides.begin(), k_sides.end());
    const auto require_free = [&](const std::string& name, const std::string& key, const std::string& where) {
        if (names.count(name) > 0)
            room.refuse(where, fmt::format("{} = \"{}\" is the name of another solid, side or boundary", key, name),
                        "Each is a patch of the mesh with a name of its own", "Change it");
    };
    for (const ParameterValues& solid : room.values.tables("solid"))
        require_free(solid.text("solid.name"), "solid.name", solid.where("solid.name"));
    names.insert(room.solid_names.begin(), room.solid_names.end());
    for (std::size_t i = 0; i < room.scene.boundaries.size(); ++i) {
        const std::string& name = room.scene.boundaries[i].name;
        room.require_name(name, "boundary.name", read.places[i]);
        require_free(name, "boundary.name", read.places[i]);
        names.insert(name);
    }
}

}  // namespace

void read_boundaries(RoomReading& room) {
    BoundariesRead read;
    for (const ParameterValues& boundary : room.values.tables("boundary")) read_boundary(room, read, boundary);
    require_balanced_flow(room, read);
    require_whole_flows(room, read);
    require_patch_names(room, read);
}

}  // namespace cutterflow::cases
