#include "geometry/head/blade_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_inner_share = 0.5;  // of the contour's radius: blades are farther out, hub and shaft are not
constexpr int k_rays = 720;            // around the axis

double contour_at(const RevolutionContour& contour, double z) {
    const auto above = std::upper_bound(contour.z.begin(), contour.z.end(), z);
    if (above == contour.z.begin()) return contour.radius.front();
    if (above == contour.z.end()) return contour.radius.back();
    const auto i = static_cast<std::size_t>(above - contour.z.begin());
    const double t = (z - contour.z[i - 1]) / (contour.z[i] - contour.z[i - 1]);
    return contour.radius[i - 1] + t * (contour.radius[i] - contour.radius[i - 1]);
}

/// The part of a polygon with z >= level, or with z <= level.
std::vector<Vec3> cut(const std::vector<Vec3>& polygon, double level, bool above) {
    std::vector<Vec3> kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
        const double from = above ? a.z() - level : level - a.z(), to = above ? b.z() - level : level - b.z();
        if (from >= 0.0) kept.push_back(a);
        if ((from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0)) kept.push_back(a + from / (from - to) * (b - a));
    }
    return kept;
}

/// What the faces of a slice push.
struct Thrust {
    double axial = 0.0, around = 0.0;  // sums of A n_azimuth n_z and of A n_azimuth^2
    void add(const std::vector<Vec3>& polygon, double inner_radius) {
        for (std::size_t k = 2; k < polygon.size(); ++k) {
            const Vec3 middle = (polygon[0] + polygon[k - 1] + polygon[k]) / 3.0;
            const double radius = std::hypot(middle.x(), middle.y());
            const Vec3 area = 0.5 * (polygon[k - 1] - polygon[0]).cross(polygon[k] - polygon[0]);
            const double size = area.norm();
            if (radius < inner_radius || size == 0.0) continue;
            const double push = (middle.x() * area.y() - middle.y() * area.x()) / radius;
            axial += push * area.z() / size;
            around += push * push / size;
        }
    }
};

/// Marks the rays that cross the segment a b outside `inner_radius`.
void mark(std::array<bool, k_rays>& met, const Eigen::Vector2d& a, const Eigen::Vector2d& b, double inner_radius) {
    const double from = std::atan2(a.y(), a.x());
    const double turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    const double low = std::min(from, from + turn) * k_rays / (2.0 * k_pi), high = std::max(from, from + turn) * k_rays / (2.0 * k_pi);
    for (int ray = static_cast<int>(std::ceil(low)); ray <= static_cast<int>(std::floor(high)); ++ray) {
        const double angle = 2.0 * k_pi * ray / k_rays;
        const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), side = b - a;
        const double across = along.x() * side.y() - along.y() * side.x();
        const double radius = across != 0.0 ? (a.x() * side.y() - a.y() * side.x()) / across : std::max(a.norm(), b.norm());
        if (radius > inner_radius) met.at(static_cast<std::size_t>(((ray % k_rays) + k_rays) % k_rays)) = true;
    }
}

using Segment = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

/// Lines in which the plane at z cuts the surface.
std::vector<Segment> section_at(const TriangleSurface& surface, double z) {
    std::vector<Segment> section;
    for (const Triangle& triangle : surface.triangles) {
        std::vector<Eigen::Vector2d> ends;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 &a = surface.points[triangle[k]], &b = surface.points[triangle[(k + 1) % 3]];
            if ((a.z() < z) == (b.z() < z)) continue;
            const double t = (z - a.z()) / (b.z() - a.z());
            ends.emplace_back((a + t * (b - a)).head<2>());
        }
        if (ends.size() == 2) section.emplace_back(ends[0], ends[1]);
    }
    return section;
}

double coverage_of(const std::vector<Segment>& section, double inner_radius) {
    std::array<bool, k_rays> met{};
    for (const auto& [a, b] : section) mark(met, a, b, inner_radius);
    return static_cast<double>(std::count(met.begin(), met.end(), true)) / k_rays;
}

/// Smallest distance of a segment from the axis.
double distance_from_axis(const Segment& segment) {
    const Eigen::Vector2d along = segment.second - segment.first;
    const double t = along.squaredNorm() > 0.0 ? std::clamp(-segment.first.dot(along) / along.squaredNorm(), 0.0, 1.0) : 0.0;
    return (segment.first + t * along).norm();
}

double depth_of(const std::vector<Segment>& section, double inner_radius) {
    double outermost = inner_radius, innermost = std::numeric_limits<double>::infinity();
    for (const Segment& segment : section) {
        const double farthest = std::max(segment.first.norm(), segment.second.norm());
        if (farthest <= inner_radius) continue;
        outermost = std::max(outermost, farthest);
        innermost = std::min(innermost, std::max(inner_radius, distance_from_axis(segment)));
    }
    return std::max(0.0, outermost - innermost);
}

}  // namespace

std::vector<BladeSlice> blade_profile(const TriangleSurface& surface, const RevolutionContour& contour, double carrying_sense, int slices) {
    const double bottom = contour.z.front(), thickness = (contour.z.back() - bottom) / slices;
    std::vector<Thrust> thrusts(static_cast<std::size_t>(slices));
    const auto slice_of = [&](double z) { return std::clamp(static_cast<int>((z - bottom) / thickness), 0, slices - 1); };
    const auto middle_of = [&](int i) { return bottom + (i + 0.5) * thickness; };
    for (const Triangle& t : surface.triangles) {
        const std::vector<Vec3> corners{surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]};
        const auto [low, high] = std::minmax({corners[0].z(), corners[1].z(), corners[2].z()});
        for (int i = slice_of(low); i <= slice_of(high); ++i)
            thrusts[static_cast<std::size_t>(i)].add(cut(cut(corners, bottom + i * thickness, true), bottom + (i + 1) * thickness, false),
                                                     k_inner_share * contour_at(contour, middle_of(i)));
    }
    std::vector<BladeSlice> profile;
    for (int i = 0; i < slices; ++i) {
        const Thrust& thrust = thrusts[static_cast<std::size_t>(i)];
        const double angle = thrust.around > 0.0 ? std::atan(carrying_sense * thrust.axial / thrust.around) : 0.0;
        const double inner_radius = k_inner_share * contour_at(contour, middle_of(i));
        const std::vector<Segment> section = section_at(surface, middle_of(i));
        profile.push_back({middle_of(i), angle, coverage_of(section, inner_radius), depth_of(section, inner_radius)});
    }
    return profile;
}

std::optional<double> share_flatter_than(const std::vector<BladeSlice>& profile, double inclination) {
    double blades = 0.0, flatter = 0.0;
    for (const BladeSlice& slice : profile) {
        if (slice.coverage >= 1.0) continue;
        blades += 1.0;
        if (slice.angle < inclination) flatter += 1.0;
    }
    if (blades == 0.0) return std::nullopt;
    return flatter / blades;
}

}  // namespace cutterflow::geometry
