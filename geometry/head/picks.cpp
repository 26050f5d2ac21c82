#include "geometry/head/picks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <gsl/assert>

#include "geometry/base/axis_frame.hpp"
#include "geometry/head/blade_faces.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_within = 0.03;       // of the contour's radius: where steel is found at all
constexpr double k_normal_step = 1e-3;  // of the head's depth

/// Outward normal (r, z) of the contour.
Eigen::Vector2d normal_at(const Contour& head, double z) {
    const double step = k_normal_step * (head.z_ring() - head.z_hub());
    const double from = std::max(head.z_hub(), z - step), to = std::min(head.z_ring(), z + step);
    return Eigen::Vector2d(to - from, head.radius_at(from) - head.radius_at(to)).normalized();
}

/// A row of picks at one height: its foot in the blade and its tip.
struct PickLine {
    double azimuth = 0.0;
    Vec3 foot = Vec3::Zero(), tip = Vec3::Zero();
};

std::vector<PickLine> lines_at(const SolidSearch& cutter, const Contour& head, double length, double sense, double z) {
    const double radius = head.radius_at(z);
    const Eigen::Vector2d tip = Eigen::Vector2d(radius, z) + length * normal_at(head, z);
    std::vector<PickLine> lines;
    for (const SteelInterval& steel : steel_intervals(cutter, head, z, sense)) {
        const Vec3 outwards(std::cos(steel.leading), std::sin(steel.leading), 0.0);
        lines.push_back(
            {steel.leading, (1.0 - k_within) * radius * outwards + z * Vec3::UnitZ(), tip.x() * outwards + tip.y() * Vec3::UnitZ()});
    }
    return lines;
}

/// The line of the same blade: the nearest in azimuth, when it is nearer than half a blade's distance.
std::optional<PickLine> continued(const PickLine& line, const std::vector<PickLine>& next) {
    const auto distance = [&](const PickLine& other) { return std::abs(std::remainder(other.azimuth - line.azimuth, 2.0 * k_pi)); };
    const auto nearest =
        std::min_element(next.begin(), next.end(), [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
    if (nearest == next.end() || distance(*nearest) > k_pi / static_cast<double>(next.size())) return std::nullopt;
    return *nearest;
}

}  // namespace

TriangleSurface pick_rows(const SolidSearch& cutter, const Contour& head, double length, double sense, int heights) {
    Expects(heights >= 2 && length > 0.0);
    TriangleSurface rows;
    const double spacing = (head.z_ring() - head.z_hub()) / heights;
    std::vector<PickLine> below;
    for (int h = 0; h < heights; ++h) {
        const std::vector<PickLine> here = lines_at(cutter, head, length, sense, head.z_hub() + (h + 0.5) * spacing);
        for (const PickLine& line : below) {
            const std::optional<PickLine> above = continued(line, here);
            if (!above) continue;
            const auto first = static_cast<std::uint32_t>(rows.points.size());
            rows.points.insert(rows.points.end(), {line.foot, line.tip, above->tip, above->foot});
            rows.triangles.push_back({first, first + 1, first + 2});
            rows.triangles.push_back({first, first + 2, first + 3});
        }
        below = here;
    }
    return rows;
}

}  // namespace cutterflow::geometry
