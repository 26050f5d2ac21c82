#include "geometry/soil/convex_facet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::geometry {
namespace {

/// The part of a facet where `height_of` a corner is not negative.
template <class Height>
Facet part_above(const Facet& facet, const Height& height_of) {
    Facet kept;
    for (std::size_t k = 0; k < facet.size(); ++k) {
        const Vec3 &from = facet[k], &to = facet[(k + 1) % facet.size()];
        const double before = height_of(from), after = height_of(to);
        if (before >= 0.0) kept.push_back(from);
        if ((before > 0.0 && after < 0.0) || (before < 0.0 && after > 0.0)) kept.push_back(from + before / (before - after) * (to - from));
    }
    return kept;
}

Facet without_short_sides(const Facet& facet, double shortest) {
    Facet kept;
    for (const Vec3& corner : facet)
        if (kept.empty() || (corner - kept.back()).norm() >= shortest) kept.push_back(corner);
    while (kept.size() > 1 && (kept.back() - kept.front()).norm() < shortest) kept.pop_back();
    return kept;
}

/// The two corners that are farthest from each other.
std::pair<Vec3, Vec3> diameter_of(const Facet& facet) {
    std::pair<Vec3, Vec3> farthest(facet.front(), facet.front());
    for (const Vec3& a : facet)
        for (const Vec3& b : facet)
            if ((a - b).squaredNorm() > (farthest.first - farthest.second).squaredNorm()) farthest = {a, b};
    return farthest;
}

double angle_at(const Vec3& corner, const Vec3& a, const Vec3& b) {
    return std::atan2((a - corner).cross(b - corner).norm(), (a - corner).dot(b - corner));
}

double smallest_angle_of(const Vec3& a, const Vec3& b, const Vec3& c) {
    return std::min({angle_at(a, b, c), angle_at(b, c, a), angle_at(c, a, b)});
}

/// Triangles from one corner, or with a point more in the middle of four corners and more: what has the largest smallest angle.
struct Fan {
    std::vector<std::array<Vec3, 3>> triangles;
    double smallest_angle = k_pi;

    void add(const Vec3& a, const Vec3& b, const Vec3& c) {
        triangles.push_back({a, b, c});
        smallest_angle = std::min(smallest_angle, smallest_angle_of(a, b, c));
    }
};

Fan best_fan(const Facet& facet) {
    const std::size_t count = facet.size();
    Fan best;
    best.smallest_angle = -1.0;
    const auto compete = [&](Fan fan) {
        if (fan.smallest_angle > best.smallest_angle) best = std::move(fan);
    };
    for (std::size_t apex = 0; apex < count; ++apex) {
        Fan fan;
        for (std::size_t k = 1; k + 1 < count; ++k) fan.add(facet[apex], facet[(apex + k) % count], facet[(apex + k + 1) % count]);
        compete(std::move(fan));
    }
    if (count == 3) return best;
    Vec3 middle = Vec3::Zero();
    for (const Vec3& corner : facet) middle += corner / static_cast<double>(count);
    Fan around;
    for (std::size_t k = 0; k < count; ++k) around.add(middle, facet[k], facet[(k + 1) % count]);
    compete(std::move(around));
    return best;
}

}  // namespace

Facet clipped(const Facet& facet, const Eigen::Vector2d& on, const Eigen::Vector2d& inwards) {
    return part_above(facet, [&](const Vec3& p) { return (p.head<2>() - on).dot(inwards); });
}

std::vector<Facet> outside(const Facet& facet, const PlanarLoop& prism, double least_width) {
    std::vector<Facet> parts;
    Facet left = facet;
    for (std::size_t k = 0; k < prism.size(); ++k) {
        const Eigen::Vector2d side = prism[(k + 1) % prism.size()] - prism[k], outwards(side.y(), -side.x());
        if (Facet part = clipped(left, prism[k], outwards); part.size() >= 3) parts.push_back(std::move(part));
        left = clipped(left, prism[k], Eigen::Vector2d(-outwards));
        if (left.size() < 3 || width_of(left) < least_width) return {facet};
    }
    return parts;
}

double width_of(const Facet& facet) {
    if (facet.size() < 3) return 0.0;
    double width = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < facet.size(); ++k) {
        const Vec3 side = facet[(k + 1) % facet.size()] - facet[k];
        const double length = side.norm();
        if (!(length > 0.0)) continue;
        double farthest = 0.0;
        for (const Vec3& corner : facet) farthest = std::max(farthest, side.cross(corner - facet[k]).norm() / length);
        width = std::min(width, farthest);
    }
    return std::isfinite(width) ? width : 0.0;
}

void add_tiles(Facet facet, const TileBounds& bounds, TriangleSurface& to) {
    facet = without_short_sides(facet, bounds.least_width);
    if (width_of(facet) < bounds.least_width) return;
    const auto [from, end] = diameter_of(facet);
    const Vec3 along = end - from, middle = 0.5 * (from + end);
    if (along.norm() <= bounds.edge_length) {
        const Fan fan = best_fan(facet);
        if (fan.smallest_angle >= bounds.smallest_angle) {
            for (const auto& corners : fan.triangles) {
                const auto first = static_cast<std::uint32_t>(to.points.size());
                to.points.insert(to.points.end(), corners.begin(), corners.end());
                to.triangles.push_back({first, first + 1, first + 2});
            }
            return;
        }
    }
    for (const double side : {1.0, -1.0})
        add_tiles(part_above(facet, [&](const Vec3& p) { return side * (p - middle).dot(along); }), bounds, to);
}

}  // namespace cutterflow::geometry
