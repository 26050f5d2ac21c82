#include "cases/scenes/room/solid_motion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/cgal/solid_search.hpp"

namespace cutterflow::cases {

namespace {

constexpr double k_looks_per_turn = 72.0;
constexpr int k_looks_along_a_way = 100;
constexpr double k_most_points = 1000.0;  // corners of a solid, and as many places along its edges
constexpr double k_touch = 1e-3;          // of the smaller solid's extent

/// Where a solid has come to, from where it stands at first.
Eigen::Isometry3d place_at(const RoomSolid& solid, double time) {
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    if (!solid.travels.empty()) place = Eigen::Translation3d(coupling::way_until(solid.travels, time));
    if (solid.turn) {
        const Vec3& origin = solid.turn->axis.origin;
        place = Eigen::Translation3d(origin) * Eigen::AngleAxisd(solid.turn->angle(time), solid.turn->axis.direction) *
                Eigen::Translation3d(-origin);
    }
    return place;
}

/// Times between two, of which the first does not count.
std::vector<double> times_between(double begin, double end, int count) {
    std::vector<double> times;
    for (int i = 1; i <= count; ++i) times.push_back(begin + (end - begin) * i / count);
    return times;
}

/// Times at which a solid that moves is looked at, as long as it is there.
std::vector<double> looks_at(const RoomScene& scene, const RoomSolid& solid) {
    const double last = std::min(scene.run.end, solid.removed_at.value_or(scene.run.end));
    std::vector<double> times;
    for (const coupling::WallTravel& travel : solid.travels)
        if (travel.begin < last)
            for (const double time : times_between(travel.begin, std::min(travel.end, last), k_looks_along_a_way)) times.push_back(time);
    if (!times.empty()) return times;
    if (!solid.turn || solid.turn->speed == 0.0 || solid.turn->begin >= last) return {};
    const double turn = 2.0 * k_pi / std::abs(solid.turn->speed), begin = solid.turn->begin;
    const double lasts = std::min({turn, solid.turn->end - begin, last - begin});
    return times_between(begin, begin + lasts, std::max(1, static_cast<int>(std::ceil(k_looks_per_turn * lasts / turn - 1e-9))));
}

/// By how much a solid lies beyond the sides that are closed to grains [m].
double reach_out_of(const RoomScene& scene, const RoomSolid& solid, const Eigen::Isometry3d& moved) {
    double reach = 0.0;
    for (const Vec3& point : solid.surface.points) {
        const Vec3 place = moved * point, below = scene.lower() - place, above = place - scene.upper();
        for (std::size_t side = 0; side < scene.sides.size(); ++side)
            if (scene.sides[side] != SideForGrains::open)
                reach = std::max(reach, (side % 2 == 0 ? below : above)[static_cast<Eigen::Index>(side / 2)]);
    }
    return reach;
}

/// At most 2 k_most_points of a surface: corners, and places at equal distances along its edges.
std::vector<Vec3> outline_of(const geometry::TriangleSurface& surface) {
    std::vector<Vec3> points;
    const std::size_t stride = 1 + surface.points.size() / static_cast<std::size_t>(k_most_points);
    for (std::size_t n = 0; n < surface.points.size(); n += stride) points.push_back(surface.points[n]);
    double length = 0.0;
    const auto for_each_edge = [&](const auto& visit) {
        for (const geometry::Triangle& triangle : surface.triangles)
            for (std::size_t corner = 0; corner < 3; ++corner)
                if (triangle[corner] < triangle[(corner + 1) % 3])  // each edge once
                    visit(surface.points[triangle[corner]], surface.points[triangle[(corner + 1) % 3]]);
    };
    for_each_edge([&](const Vec3& from, const Vec3& to) { length += (to - from).norm(); });
    const double spacing = length / k_most_points;
    double next = 0.5 * spacing;  // along all edges, one after the other
    for_each_edge([&](const Vec3& from, const Vec3& to) {
        const double edge = (to - from).norm();
        for (; next < edge; next += spacing) points.push_back(from + next / edge * (to - from));
        next -= edge;
    });
    return points;
}

/// A solid as it is held against others.
struct Body {
    explicit Body(const RoomSolid& it)
        : solid(it), search(it.surface), bounds(geometry::bounds_of(it.surface)), points(outline_of(it.surface)) {}

    /// How deep points of another solid lie in this one [m]. \param into  from the other's frame to this one's
    double depth_of(const Body& other, const Eigen::Isometry3d& into) const {
        double deepest = 0.0;
        for (const Vec3& point : other.points) {
            const Vec3 place = into * point;
            if ((place.array() < bounds.min.array()).any() || (place.array() > bounds.max.array()).any() || !search.contains(place))
                continue;
            deepest = std::max(deepest, search.nearest(place).distance);
        }
        return deepest;
    }

    const RoomSolid& solid;
    geometry::SolidSearch search;
    geometry::Bounds bounds;  // where it stands at first, as the points
    std::vector<Vec3> points;
};

/// How deep one of two lies in the other, where they have come to; 0 where they touch at most [m].
double overlap_of(const Body& a, const Body& b, double time) {
    const Eigen::Isometry3d of_a = place_at(a.solid, time), of_b = place_at(b.solid, time);
    const double depth = std::max(a.depth_of(b, of_a.inverse() * of_b), b.depth_of(a, of_b.inverse() * of_a));
    const double touch = k_touch * std::min(a.bounds.extent().maxCoeff(), b.bounds.extent().maxCoeff());
    return depth > touch ? depth : 0.0;
}

/// What is wrong with two solids: at the start, or else when they first run into one another.
std::optional<Mistake> meeting_of(const RoomScene& scene, const Body& a, const Body& b) {
    if (const double depth = overlap_of(a, b, 0.0); depth > 0.0)
        return Mistake{"", fmt::format("{} and {} overlap by {:.3g} m at the start", a.solid.name, b.solid.name, depth),
                       "Grains there feel both, and the space of neither", "Move one of them, or let them touch"};
    std::vector<double> times = looks_at(scene, a.solid);
    for (const double time : looks_at(scene, b.solid)) times.push_back(time);
    std::sort(times.begin(), times.end());
    const double gone = std::min(a.solid.removed_at.value_or(scene.run.end), b.solid.removed_at.value_or(scene.run.end));
    for (const double time : times) {
        if (time > gone || overlap_of(a, b, time) == 0.0) continue;
        return Mistake{"", fmt::format("{} and {} run into one another at {:.3g} s", a.solid.name, b.solid.name, time),
                       "Solids go through one another, and what is between them is crushed", "Correct their places or their motion"};
    }
    return std::nullopt;
}

std::vector<Mistake> side_warnings(const RoomScene& scene, const RoomSolid& solid) {
    double reach = 0.0;
    for (const double time : looks_at(scene, solid)) reach = std::max(reach, reach_out_of(scene, solid, place_at(solid, time)));
    if (reach <= scene.tolerance()) return {};
    return {{"", fmt::format("{} moves {:.3g} m through a side of the room", solid.name, reach), "It pushes grains through the side",
             "Correct its motion, or make the room larger"}};
}

}  // namespace

std::vector<Mistake> motion_warnings(const ParameterValues& values, const RoomScene& scene) {
    std::vector<Mistake> warnings;
    const auto add = [&](const ParameterValues& table, Mistake warning) {
        warning.where = table.where("solid.name");
        warnings.push_back(std::move(warning));
    };
    std::vector<Body> earlier;
    for (const ParameterValues& table : values.tables("solid")) {
        const RoomSolid* solid = scene.find_solid(table.text("solid.name"));
        if (solid == nullptr) continue;
        for (Mistake& warning : side_warnings(scene, *solid)) add(table, std::move(warning));
        Body body(*solid);
        for (const Body& other : earlier)
            if (std::optional<Mistake> meeting = meeting_of(scene, body, other)) add(table, std::move(*meeting));
        earlier.push_back(std::move(body));
    }
    return warnings;
}

}  // namespace cutterflow::cases
