#include "geometry/head.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/error.hpp"

namespace cutterflow {
namespace {

constexpr double k_ring_share = 0.6;     // of the largest radius: farther out is ring
constexpr double k_ring_band = 0.02;     // of the largest radius, below the ring plane
constexpr double k_widest_share = 0.97;  // of the largest radius: the widest place
constexpr int k_heights = 200;
constexpr double k_end_contrast = 0.05;
constexpr double k_contour_tolerance = 5e-4;  // of the ring radius
constexpr double k_carrying_limit = 0.02;
constexpr double k_standing_angle = 0.02 * k_pi / 180.0;
constexpr double k_standing_shift = 1e-4;

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

/// Mean height of the steel that is farthest from the axis.
double widest_height(const TriangleSurface& surface) {
    const double limit = k_widest_share * largest_radius(surface);
    double sum = 0.0;
    int count = 0;
    for (const Vec3& point : surface.points)
        if (radius_of(point) >= limit) {
            sum += point.z();
            ++count;
        }
    return sum / count;
}

/// The volumes of revolution below and above the widest place, as (below - above) / (below + above): positive when the head hangs below its
/// ring. A shaft on the ring's other side is thin and counts little.
double ring_is_above(const TriangleSurface& surface) {
    const RadiusProfile profile(surface);
    const double widest = widest_height(surface);
    double below = 0.0;
    double above = 0.0;
    for (int i = 0; i < k_heights; ++i) {
        const double z = profile.z_min() + (profile.z_max() - profile.z_min()) * (i + 0.5) / k_heights;
        const double radius = profile.radius_at(z);
        (z < widest ? below : above) += radius * radius;
    }
    return (below - above) / (below + above);
}

/// Points the axis from hub to ring.
RotationAxis directed(const TriangleSurface& surface, RotationAxis axis) {
    const double contrast = ring_is_above(transformed(surface, upright(axis)));
    if (std::abs(contrast) < k_end_contrast)
        throw UserError(
            fmt::format("hub and ring cannot be told apart: the volumes of revolution on both sides of the widest place differ by {:.2g} %",
                        100.0 * std::abs(contrast)),
            "The ring is the widest place and stands at one end", "Check that the file holds the whole head, ring and hub");
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
    return head;
}

}  // namespace cutterflow
