#include "geometry/clump_fit/solid_shadow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::geometry {
namespace {

constexpr int k_directions = 300;  // over half a sphere: 8 degrees apart
constexpr int k_lines = 400;
constexpr int k_lines_of_search = 120;
constexpr double k_first_turn = 0.07, k_last_turn = 1e-3;  // [rad]

struct Interval {
    double from = 0.0, to = 0.0;
};

double length_of_union(std::vector<Interval>& pieces) {
    std::sort(pieces.begin(), pieces.end(), [](const Interval& a, const Interval& b) { return a.from < b.from; });
    double length = 0.0, end = -std::numeric_limits<double>::infinity();
    for (const Interval& piece : pieces) {
        if (piece.to <= end) continue;
        length += piece.to - std::max(piece.from, end);
        end = piece.to;
    }
    return length;
}

/// The piece of the line y = height within a triangle of the plane; from > to when it has none.
Interval piece_of(const std::array<Eigen::Vector2d, 3>& corner, double height) {
    Interval piece{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (int k = 0; k < 3; ++k) {
        const Eigen::Vector2d &a = corner[static_cast<std::size_t>(k)], &b = corner[static_cast<std::size_t>((k + 1) % 3)];
        if ((a.y() <= height) == (b.y() <= height)) continue;
        const double x = a.x() + (height - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
        piece.from = std::min(piece.from, x);
        piece.to = std::max(piece.to, x);
    }
    return piece;
}

/// The direction whose shadow is the largest (sign 1) or smallest (sign -1).
Vec3 extreme_direction(const TriangleSurface& surface, double sign) {
    Vec3 best = Vec3::UnitZ();
    double area = -std::numeric_limits<double>::infinity();
    const auto take_if_better = [&](const Vec3& direction) {
        const double other = sign * shadow_area(surface, direction, k_lines_of_search);
        if (other <= area) return false;
        area = other;
        best = direction;
        return true;
    };
    for (int k = 0; k < k_directions; ++k) {
        const double z = (k + 0.5) / k_directions, azimuth = k_pi * (3.0 - std::sqrt(5.0)) * k, across = std::sqrt(1.0 - z * z);
        take_if_better(Vec3(across * std::cos(azimuth), across * std::sin(azimuth), z));
    }
    for (double turn = k_first_turn; turn > k_last_turn;) {
        const Vec3 e1 = best.unitOrthogonal(), e2 = best.cross(e1), from = best;
        bool moved = false;
        for (const Vec3& aside : {e1, Vec3(-e1), e2, Vec3(-e2)}) moved = take_if_better((from + turn * aside).normalized()) || moved;
        if (!moved) turn *= 0.5;
    }
    return best;
}

}  // namespace

double shadow_area(const TriangleSurface& surface, const Vec3& direction, int lines) {
    const Vec3 e1 = direction.unitOrthogonal(), e2 = direction.cross(e1);
    std::vector<Eigen::Vector2d> points;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& point : surface.points) {
        points.emplace_back(point.dot(e1), point.dot(e2));
        low = std::min(low, points.back().y());
        high = std::max(high, points.back().y());
    }
    const double spacing = (high - low) / lines;
    std::vector<std::vector<Interval>> pieces(static_cast<std::size_t>(lines));
    for (const Triangle& triangle : surface.triangles) {
        const std::array<Eigen::Vector2d, 3> corner{points[triangle[0]], points[triangle[1]], points[triangle[2]]};
        const auto [lowest, highest] = std::minmax({corner[0].y(), corner[1].y(), corner[2].y()});
        const int first = std::max(0, static_cast<int>(std::ceil((lowest - low) / spacing - 0.5)));
        const int last = std::min(lines - 1, static_cast<int>(std::floor((highest - low) / spacing - 0.5)));
        for (int line = first; line <= last; ++line) {
            const Interval piece = piece_of(corner, low + (line + 0.5) * spacing);
            if (piece.from < piece.to) pieces[static_cast<std::size_t>(line)].push_back(piece);
        }
    }
    double area = 0.0;
    for (std::vector<Interval>& line : pieces) area += spacing * length_of_union(line);
    return area;
}

ExtremeShadows extreme_shadows(const TriangleSurface& surface) {
    ExtremeShadows shadows;
    shadows.smallest_along = extreme_direction(surface, -1.0);
    shadows.largest_along = extreme_direction(surface, 1.0);
    shadows.areas = {shadow_area(surface, shadows.smallest_along, k_lines), shadow_area(surface, shadows.largest_along, k_lines)};
    return shadows;
}

}  // namespace cutterflow::geometry
