#include "postproc/pages/head_picture.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/head/head_names.hpp"
#include "postproc/draw/painted_surface.hpp"
#include "postproc/draw/palette.hpp"
#include "postproc/draw/rendering.hpp"

namespace cutterflow::postproc {
namespace {

constexpr int k_height = 640;  ///< pixels

std::vector<Sphere> rocks_by_fate(const Table& rocks) {
    static const std::map<std::string, Colour> colours{{"sucked_up", colour_of(palette::sucked_up)},
                                                       {"spilled", colour_of(palette::spilled)},
                                                       {"in_cutter", colour_of(palette::in_cutter)},
                                                       {"never_entered", colour_of(palette::never_entered)}};
    std::vector<Sphere> spheres;
    for (std::size_t i = 0; i < rocks.rows(); ++i) {
        const auto colour = colours.find(rocks.text("fate")[i]);
        if (colour == colours.end()) continue;
        spheres.push_back({{rocks.number("x_m")[i], rocks.number("y_m")[i], rocks.number("z_m")[i]},
                           0.5 * rocks.number("diameter_m")[i],
                           colour->second});
    }
    return spheres;
}

/// [rad], at the end of what the rock went through.
double rotor_angle_at_end(const RunData& run) {
    const double turned = run.loads.number("rotor_angle_rad").back();
    if (!run.flow) return turned;
    const double later = run.rock->fates.number("time_s").back() - run.loads.number("time_s").back();
    return turned + std::copysign(run.operating_point.angular_speed(), turned) * later;
}

HeadScene scene_of(const RunData& run) {
    HeadScene scene;
    scene.steel = read_binary_stl(run.geometry_directory() / names::cutter_surface);
    scene.steel_angle = rotor_angle_at_end(run);
    scene.ghosts = read_binary_stl(run.geometry_directory() / names::backplate_surface);
    const TriangleSurface pipe = read_binary_stl(run.geometry_directory() / names::suction_pipe_surface);
    scene.ghosts.insert(scene.ghosts.end(), pipe.begin(), pipe.end());
    if (run.operating_point.has_bank) scene.soil = read_binary_stl(run.geometry_directory() / names::bank_surface);
    if (run.rock) scene.rocks = rocks_by_fate(run.rock->final_state);
    return scene;
}

/// Sign of y on which the picture from the side is taken: the one that the soil leaves open.
double open_side(const HeadScene& scene) {
    double sum = 0.0;
    for (const Triangle& triangle : scene.soil) sum += triangle[0].y() + triangle[1].y() + triangle[2].y();
    return sum > 0.0 ? -1.0 : 1.0;
}

/// From the side and a little from the hub, with gravity pointing down.
View side_view(const RunData& run, double side) {
    const double inclination = run.operating_point.inclination_deg * k_pi / 180.0;
    const double radius = run.contour.ring_radius();
    const Vec3 vertical(-std::cos(inclination), 0.0, std::sin(inclination));
    const Vec3 hubwards = -(Vec3::UnitZ() - std::sin(inclination) * vertical).normalized();  // horizontal; the axis is never vertical
    const Vec3 towards = (0.78 * side * Vec3::UnitY() + 0.58 * hubwards + 0.22 * vertical).normalized();
    const Vec3 up = (vertical - vertical.dot(towards) * towards).normalized();
    const double middle = 0.5 * (run.contour.z_hub() + 0.8 * radius);
    return {Vec3(0.0, 0.0, middle), up.cross(towards), up, towards, 2.9 * radius, k_height * 13 / 10, k_height};
}

View axial_view(const RunData& run) {
    const double radius = run.contour.ring_radius();
    const Vec3 towards = -Vec3::UnitZ(), up = -Vec3::UnitX();
    return {Vec3(0.0, 0.0, run.contour.z_hub()), up.cross(towards), up, towards, 3.4 * radius, k_height, k_height};
}

/// Arrow along the ring's circle in the sense of rotation, as it lies in the picture.
std::string rotation_arrow(const View& view, double radius, double sense) {
    std::string path;
    Vec3 last = Vec3::Zero(), before = Vec3::Zero();
    for (int step = 0; step <= 24; ++step) {
        const double azimuth = 0.75 * k_pi + sense * (step - 12) / 24.0 * 0.9;
        before = last;
        last = view.project(Vec3(radius * std::cos(azimuth), radius * std::sin(azimuth), 0.0));
        path += fmt::format("{}{:.1f},{:.1f} ", step == 0 ? "M" : "L", last.x(), last.y());
    }
    const Vec3 forward = Vec3(last.x() - before.x(), last.y() - before.y(), 0.0).normalized();
    const Vec3 side(-forward.y(), forward.x(), 0.0);
    const Vec3 tip = last + 16.0 * forward, left = last + 7.0 * side, right = last - 7.0 * side;
    return fmt::format(
        "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"3\"/>"
        "<path d=\"M{:.1f},{:.1f} L{:.1f},{:.1f} L{:.1f},{:.1f} z\" fill=\"{}\"/>",
        path, palette::ink, tip.x(), tip.y(), left.x(), left.y(), right.x(), right.y(), palette::ink);
}

/// A bar of the ring's radius in the lower left corner.
std::string scale_bar(const View& view, double radius) {
    const double length = radius * view.height / view.height_m, y = view.height - 26.0;
    return fmt::format(
        "<path d=\"M20,{0} V{1} M20,{2} H{3:.1f} M{3:.1f},{0} V{1}\" fill=\"none\" stroke=\"{4}\" stroke-width=\"1.5\"/>"
        "<text x=\"{5:.1f}\" y=\"{6}\" text-anchor=\"middle\" font-size=\"15\" fill=\"{4}\">ring radius {7:.3g} m</text>",
        y - 5.0, y + 5.0, y, 20.0 + length, palette::ink, 20.0 + 0.5 * length, y + 20.0, radius);
}

std::string picture(const View& view, const RunData& run, const std::string& label, const std::string& address) {
    const double sense = run.loads.number("rotor_angle_rad").back() < 0.0 ? -1.0 : 1.0;
    const double radius = run.contour.ring_radius();
    return fmt::format(
        "<svg viewBox=\"0 0 {0} {1}\" role=\"img\" aria-label=\"{2}\"><image width=\"{0}\" height=\"{1}\" "
        "href=\"{3}\"/>{4}{5}</svg>",
        view.width, view.height, label, address, rotation_arrow(view, 1.18 * radius, sense), scale_bar(view, radius));
}

int count_outside(const std::vector<Sphere>& rocks, const View& view) {
    return static_cast<int>(std::count_if(rocks.begin(), rocks.end(), [&](const Sphere& rock) {
        const Vec3 at = view.project(rock.centre);
        return at.x() < 0.0 || at.y() < 0.0 || at.x() > view.width || at.y() > view.height;
    }));
}

}  // namespace

HeadPicture draw_head_from_side(const RunData& run, Page& page, const std::string& name) {
    const HeadScene scene = scene_of(run);
    const View view = side_view(run, open_side(scene));
    const std::string still =
        picture(view, run, "Cutter head from the side with rock coloured by fate", page.address(render(scene, view), name));
    return {page.turnable(still, head_view(scene, view, page.surfaces())), static_cast<int>(scene.rocks.size()),
            count_outside(scene.rocks, view)};
}

std::string draw_head_from_hub(const RunData& run, const Page& page, const std::string& name) {
    HeadScene scene = scene_of(run);
    scene.ghosts.clear();  // behind the head
    scene.soil.clear();    // before it, below the hub
    const View view = axial_view(run);
    return picture(view, run, "Cutter head from the hub with rock coloured by fate", page.address(render(scene, view), name));
}

std::string draw_painted_head(const RunData& run, const TriangleSurface& steel, const std::vector<Colour>& colours, const Page& page,
                              const std::string& name) {
    HeadScene scene;
    scene.steel = steel;
    const auto draw = [&](const View& view, const char* from) {
        const std::string address = page.address(render_painted(scene, colours, view), fmt::format("{}_{}", name, from));
        return picture(view, run, fmt::format("Cutter head from the {}, coloured by the work of rock on its steel", from), address);
    };
    return draw(side_view(run, 1.0), "side") + draw(axial_view(run), "hub");
}

}  // namespace cutterflow::postproc
