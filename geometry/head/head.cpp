#include "geometry/head/head.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/head/narrow_places.hpp"
#include "geometry/surface/topology.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_ring_share = 0.6;  // of the largest radius: farther out is ring
constexpr double k_ring_band = 0.02;  // of the largest radius, below the ring plane
constexpr double k_wide = 0.75;       // of the largest radius: a ring is wider
constexpr double k_half = 0.5;        // of the largest radius: a shaft is thinner
constexpr int k_heights = 400;
constexpr double k_end_contrast = 0.02;
constexpr double k_contour_tolerance = 5e-4;  // of the ring radius
constexpr int k_blade_slices = 12;
constexpr double k_carrying_limit = 0.02;
constexpr double k_standing_angle = 0.02 * k_pi / 180.0;
constexpr double k_standing_shift = 1e-4;
constexpr double k_near_body = 0.02;      // of the largest radius, between a body and where another one comes to by a turn
constexpr double k_core_body = 1e-3;      // of the volume of all: a body on the axis that is a part of the head
constexpr double k_like_body = 0.05;      // of its volume
constexpr int k_turns_of_revolution = 7;  // in a circle, of a head without blades
constexpr std::size_t k_bodies_told = 5;

double radius_of(const Vec3& point) {
    return std::hypot(point.x(), point.y());
}

/// Rotation by the smallest angle that brings `direction` to +z, about the origin of the axis.
Eigen::Isometry3d upright(const RotationAxis& axis) {
    Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
    transform.rotate(Eigen::Quaterniond::FromTwoVectors(axis.direction, Vec3::UnitZ()));
    transform.translate(-axis.origin);
    return transform;
}

double largest_radius(const TriangleSurface& surface) {
    double radius = 0.0;
    for (const Vec3& point : surface.points) radius = std::max(radius, radius_of(point));
    return radius;
}

/// Over how much of the height the outer radius shrinks from k_wide to k_half of its largest, at the lower end less at the upper: positive
/// when the head is below its ring. The head ends abruptly at the ring and tapers towards the hub; a shaft is too thin to count, and picks
/// that protrude farther than the ring have no effect.
double ring_is_above(const TriangleSurface& surface) {
    const RadiusProfile profile(surface);
    std::vector<double> radii;
    for (int i = 0; i < k_heights; ++i)
        radii.push_back(profile.radius_at(profile.z_min() + (profile.z_max() - profile.z_min()) * (i + 0.5) / k_heights));
    const double largest = *std::max_element(radii.begin(), radii.end());
    const auto first_above = [&](auto begin, auto end, double share) {
        return std::distance(begin, std::find_if(begin, end, [&](double r) { return r >= share * largest; }));
    };
    const auto taper = [&](auto begin, auto end) { return first_above(begin, end, k_wide) - first_above(begin, end, k_half); };
    return static_cast<double>(taper(radii.begin(), radii.end()) - taper(radii.rbegin(), radii.rend())) / k_heights;
}

/// A part of the surface that touches no other.
struct Body {
    double volume = 0.0;         // [m3]
    Vec3 centre = Vec3::Zero();  // of the volume [m]
};

std::vector<Body> bodies_of(const TriangleSurface& surface) {
    const std::vector<std::size_t> number = component_numbers(surface, sorted_edge_uses(surface));
    const Vec3 origin = bounds_of(surface).min;
    std::vector<Body> bodies(1 + *std::max_element(number.begin(), number.end()));
    for (std::size_t t = 0; t < number.size(); ++t) {
        const Triangle& corners = surface.triangles[t];
        const Vec3 a = surface.points[corners[0]] - origin, b = surface.points[corners[1]] - origin,
                   c = surface.points[corners[2]] - origin;
        const double volume = a.dot(b.cross(c)) / 6.0;
        bodies[number[t]].volume += volume;
        bodies[number[t]].centre += volume * 0.25 * (a + b + c);
    }
    for (Body& body : bodies) body.centre = origin + body.centre / body.volume;
    return bodies;
}

/// Picks that stand free of the head come once per blade. What does not is left over from drawing, and would decide where hub and ring are.
void require_repeated_bodies(const TriangleSurface& surface, const RotationalSymmetry& symmetry) {
    const std::vector<Body> bodies = bodies_of(surface);
    if (bodies.size() == 1) return;
    const double angle = 2.0 * k_pi / (symmetry.blade_count > 0 ? symmetry.blade_count : k_turns_of_revolution);
    const Eigen::AngleAxisd turn(angle, symmetry.axis.direction);
    const double near = k_near_body * largest_radius(transformed(surface, upright(symmetry.axis)));
    double whole = 0.0;
    for (const Body& body : bodies) whole += body.volume;
    const auto is_repeated = [&](const Body& body) {
        const double turned = (turn * (body.centre - symmetry.axis.origin) - (body.centre - symmetry.axis.origin)).norm();
        if (turned < near) return body.volume > k_core_body * whole;  // on the axis, as a shaft
        const Vec3 place = symmetry.axis.origin + turn * (body.centre - symmetry.axis.origin);
        return std::any_of(bodies.begin(), bodies.end(), [&](const Body& other) {
            return (other.centre - place).norm() < near && std::abs(other.volume - body.volume) < k_like_body * body.volume;
        });
    };
    std::vector<Mistake> mistakes;
    for (const Body& body : bodies)
        if (!is_repeated(body) && mistakes.size() < k_bodies_told)
            mistakes.push_back(
                {"",
                 fmt::format("a separate body of {:.3g} m3 at ({:.4g}, {:.4g}, {:.4g}) m is not repeated by a turn of {:.3g} degrees",
                             body.volume, body.centre.x(), body.centre.y(), body.centre.z(), angle * 180.0 / k_pi),
                 fmt::format("Of the {} bodies of the file, which do not touch, each stands on the axis with a thousandth of the volume or "
                             "more, or comes once per blade",
                             bodies.size()),
                 "Remove it, or join it with the head, in CAD"});
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

/// Points the axis from hub to ring.
RotationAxis directed(const TriangleSurface& surface, RotationAxis axis) {
    const double contrast = ring_is_above(transformed(surface, upright(axis)));
    if (std::abs(contrast) < k_end_contrast)
        throw UserError(
            fmt::format("hub and ring cannot be told apart: the outer radius runs in at both ends over the same height to {:.2g} % of it",
                        100.0 * std::abs(contrast)),
            "The head ends at once at its ring and runs in to its hub", "Check that the file holds the whole head, ring and hub");
    if (contrast < 0.0) axis.direction = -axis.direction;
    return axis;
}

double ring_plane(const TriangleSurface& upright_surface) {
    const double limit = k_ring_share * largest_radius(upright_surface);
    double z = -std::numeric_limits<double>::infinity();
    for (const Vec3& point : upright_surface.points)
        if (radius_of(point) >= limit) z = std::max(z, point.z());
    return z;
}

/// The largest radius in a thin band below the ring plane, so that a chamfer does not shrink the ring.
double ring_radius_of(const TriangleSurface& surface, const RadiusProfile& profile) {
    const double band = k_ring_band * largest_radius(surface);
    double radius = std::max(profile.radius_at(0.0), profile.radius_at(-band));
    for (const Vec3& point : surface.points)
        if (point.z() <= 0.0 && point.z() >= -band) radius = std::max(radius, radius_of(point));
    return radius;
}

bool is_nearly_z_axis(const RotationAxis& axis, double radius) {
    const double angle = std::acos(std::min(1.0, axis.direction.z()));
    const Vec3 foot = axis.origin - axis.origin.z() / axis.direction.z() * axis.direction;
    return angle < k_standing_angle && foot.norm() < k_standing_shift * radius;
}

}  // namespace

Carrying carrying_sense(const TriangleSurface& surface) {
    double push = 0.0;
    double torque_area = 0.0;
    for (const Triangle& triangle : surface.triangles) {
        const Vec3 area = area_vector(surface, triangle);
        const double size = area.norm();
        if (size == 0.0) continue;
        const Vec3 at = centroid_of(surface, triangle);
        // Radius times azimuthal component of the area vector.
        const double lever = at.x() * area.y() - at.y() * area.x();
        push += lever * area.z() / size;
        torque_area += std::abs(lever);
    }
    const double measure = torque_area > 0.0 ? push / torque_area : 0.0;
    if (std::abs(measure) < k_carrying_limit) return {CarryingSense::none, measure};
    return {measure > 0.0 ? CarryingSense::positive : CarryingSense::negative, measure};
}

Head understand_head(const TriangleSurface& surface) {
    Head head;
    head.symmetry = find_rotational_symmetry(surface);
    require_repeated_bodies(surface, head.symmetry);
    head.axis = directed(surface, head.symmetry.axis);
    if (is_nearly_z_axis(head.axis, largest_radius(surface))) head.axis = RotationAxis{};
    head.axis.origin += ring_plane(transformed(surface, upright(head.axis))) * head.axis.direction;
    head.to_run_frame = upright(head.axis);
    head.symmetry.axis = head.axis;
    head.surface = transformed(surface, head.to_run_frame);

    const RadiusProfile profile(head.surface);
    head.ring_radius = ring_radius_of(head.surface, profile);
    head.lowest_z = profile.z_min();
    head.steel_above_ring = std::max(0.0, profile.z_max());
    head.carrying = carrying_sense(head.surface);
    head.contour = fit_contour(profile, head.lowest_z, std::min(0.0, profile.z_max()), k_contour_tolerance * head.ring_radius);
    if (head.symmetry.blade_count > 1) head.passage = passage_between_blades(head.surface, head.contour, head.symmetry.blade_count);
    head.thickness = smallest_thickness(head.surface);
    if (head.symmetry.blade_count > 1)
        head.blades =
            blade_profile(head.surface, head.contour, head.carrying.sense == CarryingSense::negative ? -1.0 : 1.0, k_blade_slices);
    return head;
}

}  // namespace cutterflow::geometry
