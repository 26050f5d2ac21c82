#include "geometry/head/blade_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <gsl/assert>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::geometry {
namespace {

constexpr int k_azimuths = 720;
constexpr std::array<double, 4> k_radii{0.9, 0.93, 0.96, 0.99};  // of the contour's
constexpr int k_halvings = 14;

}  // namespace

std::vector<SteelInterval> steel_intervals(const SolidSearch& cutter, const Contour& head, double z, double sense) {
    const double radius = head.radius_at(z);
    // Azimuths are taken in the sense of rotation: steel is left through its leading face.
    const auto is_steel = [&](double turned) {
        const Vec3 direction(std::cos(sense * turned), std::sin(sense * turned), 0.0);
        return std::any_of(k_radii.begin(), k_radii.end(),
                           [&](double share) { return cutter.contains(share * radius * direction + Vec3(0.0, 0.0, z)); });
    };
    const double step = 2.0 * k_pi / k_azimuths;
    std::vector<bool> steel(k_azimuths);
    for (int i = 0; i < k_azimuths; ++i) steel[i] = is_steel(i * step);
    /// Where the steel's state changes between two samples.
    const auto edge = [&](int i) {
        double from = i * step, to = from + step;
        for (int n = 0; n < k_halvings; ++n) {
            const double middle = 0.5 * (from + to);
            (is_steel(middle) == steel[i] ? from : to) = middle;
        }
        return 0.5 * (from + to);
    };
    std::vector<double> entries, exits;
    for (int i = 0; i < k_azimuths; ++i) {
        const bool next = steel[(i + 1) % k_azimuths];
        if (steel[i] == next) continue;
        (next ? entries : exits).push_back(edge(i));
    }
    std::vector<SteelInterval> intervals;
    for (const double exit : exits) {
        const auto after = std::lower_bound(entries.begin(), entries.end(), exit);
        const double entry = after == entries.begin() ? entries.back() - 2.0 * k_pi : *(after - 1);
        double leading = std::fmod(sense * exit, 2.0 * k_pi);
        if (leading < 0.0) leading += 2.0 * k_pi;
        intervals.push_back({leading, exit - entry});
    }
    return intervals;
}

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
