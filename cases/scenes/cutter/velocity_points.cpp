#include "cases/scenes/cutter/velocity_points.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "cases/scenes/cutter/study_case.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/head/head_names.hpp"

namespace cutterflow::cases {
namespace {

// Even numbers: no point lies on the axis, where no direction is radial.
constexpr int k_across = 60, k_up = 40, k_across_ring = 50;
constexpr double k_under_ring = 0.3425;
constexpr int k_angles = 180;  // at which a point is looked for in passing steel
constexpr int k_adv_phases = 12;
// Points keep this share of the tank's radius or height off its walls.
constexpr double k_off_walls = 0.02;

/// n values from a to b.
std::vector<double> spaced(double a, double b, int n) {
    std::vector<double> values;
    for (int i = 0; i < n; ++i) values.push_back(a + (b - a) * i / (n - 1));
    return values;
}

using IsInside = std::function<bool(const Vec3&)>;

/// Lies a point of measurement in a solid at all angles between the rotor and it?
bool always_inside(const postproc::AdvPoint& point, const IsInside& turning, const IsInside& still) {
    const IsInside &at_rest = point.rotating ? turning : still, &passing = point.rotating ? still : turning;
    if (at_rest(point.position())) return true;
    for (int i = 0; i < k_angles; ++i)
        if (!passing(rotate_about({}, 2.0 * k_pi * i / k_angles, point.position()))) return false;
    return true;
}

}  // namespace

VelocitySetInput axial_plane(const Study& study, const HeadSize& head) {
    const double ring = head.ring_radius, margin = k_off_walls * study.tank.height;
    const double low = std::max(-head.depth - 0.25 * ring, study.water(head).z_min + margin);
    const double high = std::min(study.suction.gap + study.suction.backplate_thickness + 0.6 * ring, study.water(head).z_max - margin);
    const double width = std::min(1.5 * ring, (1.0 - k_off_walls) * study.tank.radius), azimuth = study.suction.mouth_azimuth;
    VelocitySetInput set{names::axial_plane, 0, {}};
    for (const double z : spaced(low, high, k_up))
        for (const double s : spaced(-width, width, k_across))
            set.points.push_back({{s * std::cos(azimuth), s * std::sin(azimuth), z}, false});
    return set;
}

VelocitySetInput plane_under_ring(const Study& study, const HeadSize& head) {
    const double width = std::min(1.4 * head.ring_radius, (1.0 - k_off_walls) * std::sqrt(0.5) * study.tank.radius);
    VelocitySetInput set{names::plane_under_ring, 0, {}};
    for (const double y : spaced(-width, width, k_across_ring))
        for (const double x : spaced(-width, width, k_across_ring)) set.points.push_back({{x, y, -k_under_ring * head.ring_radius}, false});
    return set;
}

VelocitySetInput adv_set(const Study& study) {
    VelocitySetInput set{names::adv_set, k_adv_phases, {}};
    for (const postproc::AdvPoint& point : postproc::read_adv_points(*study.report.adv_points))
        for (const Vec3& place : postproc::adv_places(point, study.report.adv_probe)) set.points.push_back({place, point.rotating});
    return set;
}

void require_adv_points(const Study& study, const HeadSize& head, const geometry::TriangleSurface& cutter,
                        const std::optional<geometry::TriangleSurface>& soil) {
    const geometry::SolidSearch rotor(cutter);
    const geometry::StationarySteelParameters stationary = stationary_steel_of(study, head);
    std::optional<geometry::SolidSearch> ground;
    if (soil) ground.emplace(*soil);
    const IsInside in_cutter = [&](const Vec3& place) { return rotor.contains(place); };
    const IsInside in_steel = [&](const Vec3& place) { return geometry::is_in_stationary_steel(stationary, place); };
    const IsInside in_soil = [&](const Vec3& place) { return ground && ground->contains(place); };
    const IsInside in_either = [&](const Vec3& place) { return in_steel(place) || in_soil(place); };
    const AxialCylinder water = study.water(head);
    std::vector<Mistake> mistakes;
    for (const postproc::AdvPoint& point : postproc::read_adv_points(*study.report.adv_points)) {
        const Cylindrical& place = point.place;
        const std::string what = fmt::format("point {} (r = {:.4g} m, theta = {:.4g} deg, z = {:.4g} m)", point.name, place.radius,
                                             place.azimuth * 180.0 / k_pi, place.axial);
        if (place.radius >= water.radius || place.axial <= water.z_min || place.axial >= water.z_max)
            mistakes.push_back(
                {point.where, what + " lies outside the water",
                 fmt::format("The water is the cylinder r < {:.4g} m, {:.4g} m < z < {:.4g} m", water.radius, water.z_min, water.z_max),
                 "Check the unit in the header and the frame: ring plane z = 0, the head below it"});
        else if (always_inside(point, in_cutter, in_either))
            mistakes.push_back({point.where,
                                what + (always_inside(point, in_cutter, in_steel) ? " lies inside steel" : " lies inside soil"),
                                point.rotating ? "A point that turns with the head must be in water"
                                               : "A still point must be in water at some angle of the rotor",
                                "Check position, unit and frame"});
    }
    if (!mistakes.empty()) throw UserError(mistakes);
}

std::string adv_places_hash(const std::filesystem::path& points_file) {
    std::string text;
    for (const postproc::AdvPoint& point : postproc::read_adv_points(points_file))
        text += fmt::format("{:.9g},{:.9g},{:.9g},{}\n", point.place.radius, point.place.azimuth, point.place.axial, point.rotating);
    return sha256(text);
}

}  // namespace cutterflow::cases
