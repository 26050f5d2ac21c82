#include "geometry/head/stationary_steel.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/cgal/planar_region.hpp"
#include "geometry/cgal/remesh.hpp"
#include "geometry/surface/revolve.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_feature_angle_deg = 35.0;
constexpr double k_most_triangles = 2e6;
/// Around a circle: the polygon's area is then within 0.3 % of the circle's.
constexpr std::size_t k_least_segments = 48;

Vec3 mouth_centre(const SuctionMouth& mouth) {
    return {mouth.offset * std::cos(mouth.azimuth), mouth.offset * std::sin(mouth.azimuth), 0.0};
}

/// A circle about a line parallel to the axis; its points have the same x and y at every height.
struct Circle {
    Vec3 centre;
    double radius;
    std::size_t segments;

    Vec3 point(std::size_t k, double z) const {
        const double angle = 2.0 * k_pi * static_cast<double>(k % segments) / static_cast<double>(segments);
        return {centre.x() + radius * std::cos(angle), centre.y() + radius * std::sin(angle), z};
    }
};

Circle circle(const Vec3& centre, double radius, double edge) {
    return {centre, radius, std::max(k_least_segments, circle_segments(radius, edge))};
}

/// Cylinder wall between two heights, its outside away from the circle's centre or towards it.
TriangleSurface wall(const Circle& circle, double z_low, double z_high, bool outward, double edge) {
    TriangleSurface surface;
    const int rows = std::max(1, static_cast<int>(std::lround((z_high - z_low) / edge)));
    for (int i = 0; i <= rows; ++i)
        for (std::size_t k = 0; k < circle.segments; ++k)
            // The ends exactly as given, so that they meet the plates' points.
            surface.points.push_back(circle.point(k, i == rows ? z_high : z_low + (z_high - z_low) * i / rows));
    const auto n = static_cast<std::uint32_t>(circle.segments);
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(rows); ++i)
        for (std::uint32_t k = 0; k < n; ++k) {
            const std::uint32_t a = i * n + k;
            const std::uint32_t b = i * n + (k + 1) % n;
            surface.triangles.push_back(outward ? Triangle{a, b, b + n} : Triangle{a, b + n, b});
            surface.triangles.push_back(outward ? Triangle{a, b + n, a + n} : Triangle{a, a + n, b + n});
        }
    return surface;
}

/// Flat face between two circles at one height, its outside up or down.
TriangleSurface flat(const Circle& outer, const Circle& inner, double z, bool upward) {
    std::vector<PlanarLoop> loops(2);
    TriangleSurface surface;
    for (std::size_t c = 0; c < 2; ++c) {
        const Circle& circle = c == 0 ? outer : inner;
        for (std::size_t k = 0; k < circle.segments; ++k) {
            const Vec3 point = circle.point(k, z);
            loops[c].emplace_back(point.x(), point.y());
            surface.points.push_back(point);
        }
    }
    surface.triangles = triangulate_region(loops);
    if (!upward)
        for (Triangle& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
    return surface;
}

void require_consistent(const StationarySteelParameters& p) {
    std::vector<Mistake> mistakes;
    const double outer = p.mouth.offset + p.mouth.radius + p.pipe_wall;
    if (!(outer < p.plate_radius))
        mistakes.push_back(
            {"", fmt::format("the suction pipe reaches {:.4g} m from the axis", outer),
             fmt::format("Mouth offset, mouth radius and pipe wall must add up to less than the backplate's radius, {:.4g} m",
                         p.plate_radius),
             "Move the mouth inwards or make it smaller"});
    if (!(p.pipe_top > p.gap + p.plate_thickness))
        mistakes.push_back({"", fmt::format("the suction pipe ends at z = {:.4g} m", p.pipe_top),
                            fmt::format("It must end above the backplate, z = {:.4g} m", p.gap + p.plate_thickness),
                            "Make the tank higher or the backplate thinner"});
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

/// Is this face of the solid part of the pipe: its bore, its outside above the plate, its upper end?
bool belongs_to_pipe(const TriangleSurface& solid, const Triangle& triangle, const StationarySteelParameters& p) {
    const Vec3 arm = centroid_of(solid, triangle) - mouth_centre(p.mouth);
    const double radius = std::hypot(arm.x(), arm.y());
    const Vec3 normal = area_vector(solid, triangle).normalized();
    const bool in_bore = radius < p.mouth.radius + 0.5 * p.pipe_wall && std::abs(normal.z()) < 0.5;
    const bool above_plate = arm.z() > p.gap + p.plate_thickness + 1e-6 * p.plate_radius;
    return in_bore || above_plate;
}

}  // namespace

TriangleSurface StationarySteel::solid() const {
    return welded(joined({backplate, suction_pipe}));
}

bool is_in_stationary_steel(const StationarySteelParameters& p, const Vec3& point) {
    const double from_axis = point.head<2>().norm(), from_mouth = (point - mouth_centre(p.mouth)).head<2>().norm();
    const double z_top = p.gap + p.plate_thickness;
    if (from_mouth <= p.mouth.radius) return false;
    const bool in_plate = point.z() > p.gap && point.z() < z_top && from_axis < p.plate_radius;
    const bool in_pipe = point.z() >= z_top && point.z() < p.pipe_top && from_mouth < p.mouth.radius + p.pipe_wall;
    return in_plate || in_pipe;
}

StationarySteel generate_stationary_steel(const StationarySteelParameters& p) {
    require_consistent(p);
    const double edge = p.edge_length;
    require_few_triangles(2.0 * k_pi * p.plate_radius * (p.plate_radius + p.pipe_top - p.gap), edge, k_most_triangles);
    const Vec3 centre = mouth_centre(p.mouth);
    const Circle rim = circle(Vec3::Zero(), p.plate_radius, edge);
    const Circle bore = circle(centre, p.mouth.radius, edge);
    const Circle outside = circle(centre, p.mouth.radius + p.pipe_wall, edge);
    const double z_top = p.gap + p.plate_thickness;
    const TriangleSurface faces = joined({flat(rim, bore, p.gap, false), wall(rim, p.gap, z_top, true, edge),
                                          flat(rim, outside, z_top, true), wall(outside, z_top, p.pipe_top, true, edge),
                                          flat(outside, bore, p.pipe_top, true), wall(bore, p.gap, p.pipe_top, false, edge)});
    const TriangleSurface solid = sorted(remeshed(welded(faces), edge, k_feature_angle_deg));

    TriangleSurface plate{solid.points, {}};
    TriangleSurface pipe{solid.points, {}};
    for (const Triangle& triangle : solid.triangles) (belongs_to_pipe(solid, triangle, p) ? pipe : plate).triangles.push_back(triangle);
    return {welded(plate), welded(pipe)};
}

}  // namespace cutterflow::geometry
