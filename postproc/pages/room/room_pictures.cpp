#include "postproc/pages/room/room_pictures.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "geometry/base/axis_frame.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/draw/palette.hpp"
#include "postproc/draw/rendering.hpp"

namespace cutterflow::postproc {

namespace {

constexpr int k_width = 420, k_highest = 640;  // pixels
constexpr double k_margin = 1.06;
constexpr double k_slowest_scale = 0.01;  // [m/s]: slower grains all look at rest
constexpr double k_edge = 0.002;          // half thickness of the room's edges, of its largest side

Vec3 vec3_in(const nlohmann::json& list) {
    return {list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()};
}

/// Time [s] for which a motion has lasted.
double lasted(const nlohmann::json& motion, double time) {
    const double begin = motion.at("from_s").get<double>(), end = motion.at("to_s").get<double>();
    return std::clamp(time - begin, 0.0, end - begin);
}

/// The solids as they stand at a time.
TriangleSurface solids_at(const nlohmann::json& room, const std::filesystem::path& run, double time) {
    TriangleSurface all;
    for (const nlohmann::json& solid : room.at("solids")) {
        if (solid.contains("removed_at_s") && time >= solid.at("removed_at_s").get<double>()) continue;
        for (Triangle triangle : read_binary_stl(run / solid.at("file").get<std::string>())) {
            for (Vec3& corner : triangle) corner = moved_point(solid, time, corner);
            all.push_back(triangle);
        }
    }
    return all;
}

/// A box along the axes.
void add_box(const Vec3& lower, const Vec3& upper, TriangleSurface& surface) {
    const auto corner = [&](int x, int y, int z) {
        return Vec3(x ? upper.x() : lower.x(), y ? upper.y() : lower.y(), z ? upper.z() : lower.z());
    };
    const auto face = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
        surface.push_back({a, b, c});
        surface.push_back({a, c, d});
    };
    face(corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0));
    face(corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1));
    face(corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1));
    face(corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0));
    face(corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0));
    face(corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1));
}

/// The twelve edges of the room, as thin bars: its sides have no thickness, and without them a bed seems to lie in the open.
void add_edges(const nlohmann::json& room, TriangleSurface& surface) {
    const Vec3 size = vec3_in(room.at("size_m"));
    const Vec3 lower(-0.5 * size.x(), -0.5 * size.y(), 0.0), half = Vec3::Constant(k_edge * size.maxCoeff());
    for (int axis = 0; axis < 3; ++axis)
        for (const int corner : {0, 1, 2, 3}) {
            Vec3 from = lower;
            if ((corner & 1) != 0) from[(axis + 1) % 3] += size[(axis + 1) % 3];
            if ((corner & 2) != 0) from[(axis + 2) % 3] += size[(axis + 2) % 3];
            Vec3 to = from;
            to[axis] += size[axis];
            add_box(from - half, to + half, surface);
        }
}

Colour mixed(const Colour& a, const Colour& b, double share) {
    return {a.red + share * (b.red - a.red), a.green + share * (b.green - a.green), a.blue + share * (b.blue - a.blue)};
}

double fastest(const Grains& grains) {
    double speed = k_slowest_scale;
    for (const Vec3& velocity : grains.velocity) speed = std::max(speed, velocity.norm());
    return speed;
}

std::vector<Sphere> spheres_of(const Grains& grains, double fastest_speed) {
    const Colour rest = colour_of(palette::in_cutter), fast = colour_of(palette::sucked_up);
    std::vector<Sphere> spheres;
    for (std::size_t i = 0; i < grains.size(); ++i)
        spheres.push_back(
            {grains.position[i], 0.5 * grains.diameter[i], mixed(rest, fast, std::min(1.0, grains.velocity[i].norm() / fastest_speed))});
    return spheres;
}

/// What lies behind the plane y = 0, seen from -y.
HeadScene behind_plane(const HeadScene& whole) {
    HeadScene cut;
    for (const Triangle& triangle : whole.ghosts)
        if (triangle[0].y() + triangle[1].y() + triangle[2].y() >= 0.0) cut.steel.push_back(triangle);
    std::copy_if(whole.rocks.begin(), whole.rocks.end(), std::back_inserter(cut.rocks),
                 [](const Sphere& rock) { return rock.centre.y() >= 0.0; });
    return cut;
}

/// The room as a whole, from -y; \param height  of the eye over the horizon, as a slope
View view_of(const nlohmann::json& room, double slope) {
    const Vec3 size = vec3_in(room.at("size_m"));
    View view;
    view.towards = Vec3(0.0, -1.0, slope).normalized();
    view.right = Vec3::UnitX();
    view.up = view.towards.cross(view.right);
    view.centre = Vec3(0.0, 0.0, 0.5 * size.z());
    const double seen = size.z() * std::abs(view.up.z()) + size.y() * std::abs(view.up.y());
    view.width = k_width;
    view.height = std::clamp(static_cast<int>(std::lround(k_width * seen / size.x())), k_width / 3, k_highest);
    view.height_m = k_margin * std::max(seen, size.x() * view.height / view.width);
    return view;
}

}  // namespace

std::vector<nlohmann::json> travels_of(const nlohmann::json& solid) {
    if (!solid.contains("travel")) return {};
    const nlohmann::json& travel = solid.at("travel");
    return travel.is_array() ? std::vector<nlohmann::json>(travel.begin(), travel.end()) : std::vector<nlohmann::json>{travel};
}

/// The axis goes with the solid, as in the DEM.
Vec3 moved_point(const nlohmann::json& solid, double time, const Vec3& given) {
    Vec3 point = given;
    if (solid.contains("turn")) {
        const nlohmann::json& turn = solid.at("turn");
        point = rotate_about({vec3_in(turn.at("origin_m")), vec3_in(turn.at("axis"))},
                             turn.at("speed_rad_s").get<double>() * lasted(turn, time), point);
    }
    if (solid.contains("pressed_m")) point += vec3_in(solid.at("pressed_m"));
    for (const nlohmann::json& travel : travels_of(solid)) point += vec3_in(travel.at("velocity_m_s")) * lasted(travel, time);
    return point;
}

std::string room_pictures(const Page& page, const nlohmann::json& room, const MeasureSource& source) {
    const std::vector<double>& times = source.picture_times();
    std::string markup;
    std::size_t last = times.size();
    for (const std::size_t index : {std::size_t{0}, times.size() / 2, times.size() - 1}) {
        if (index == last) continue;
        last = index;
        const Grains& grains = source.grains(index);
        const double speed = fastest(grains);
        HeadScene scene;
        scene.ghosts = solids_at(room, source.directory(), times[index]);
        add_edges(room, scene.ghosts);
        scene.rocks = spheres_of(grains, speed);
        const std::string caption = fmt::format("{:.4g} s; {} grain{}; blue: {:.2g} m/s and more, yellow: at rest", times[index],
                                                grains.size(), grains.size() == 1 ? "" : "s", speed);
        const auto image = [&](const HeadScene& drawn, const View& view, const char* name) {
            return fmt::format("<img src=\"{}\" width=\"{}\" alt=\"{}\">",
                               page.address(render(drawn, view), fmt::format("{}_{}", name, index)), view.width, name);
        };
        markup += html::figure(image(scene, view_of(room, 0.25), "side"), "From the side, " + caption + ".");
        markup +=
            html::figure(image(behind_plane(scene), view_of(room, 0.0), "cut"), "Cut by the plane y = 0, seen from -y, " + caption + ".");
    }
    return "<div class=\"figures\">" + markup + "</div>";
}

}  // namespace cutterflow::postproc
