#include "geometry/surface/revolve.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"

namespace cutterflow::geometry {
namespace {

std::vector<MeridianPoint> divided(const std::vector<MeridianPoint>& section, bool closed, double edge_length) {
    std::vector<MeridianPoint> points;
    const std::size_t sides = closed ? section.size() : section.size() - 1;
    for (std::size_t i = 0; i < sides; ++i) {
        const MeridianPoint& a = section[i];
        const MeridianPoint& b = section[(i + 1) % section.size()];
        const double length = std::hypot(b.r - a.r, b.z - a.z);
        const int parts = std::max(1, static_cast<int>(std::ceil(length / edge_length - 1e-9)));
        for (int k = 0; k < parts; ++k) points.push_back({a.r + (b.r - a.r) * k / parts, a.z + (b.z - a.z) * k / parts});
    }
    if (!closed) points.push_back(section.back());
    return points;
}

/// Point indices of one circle: a single one on the axis.
std::vector<std::uint32_t> add_circle(TriangleSurface& surface, const MeridianPoint& at, std::size_t segments) {
    std::vector<std::uint32_t> indices;
    for (std::size_t k = 0; k < segments; ++k) {
        if (at.r > 0.0 || k == 0) {
            const double angle = 2.0 * k_pi * static_cast<double>(k) / static_cast<double>(segments);
            surface.points.emplace_back(at.r * std::cos(angle), at.r * std::sin(angle), at.z);
        }
        indices.push_back(static_cast<std::uint32_t>(surface.points.size() - 1));
    }
    return indices;
}

void add_band(TriangleSurface& surface, const std::vector<std::uint32_t>& from, const std::vector<std::uint32_t>& to) {
    const std::size_t segments = from.size();
    for (std::size_t k = 0; k < segments; ++k) {
        const std::size_t next = (k + 1) % segments;
        if (from[k] != from[next]) surface.triangles.push_back({from[k], from[next], to[next]});
        if (to[k] != to[next]) surface.triangles.push_back({from[k], to[next], to[k]});
    }
}

}  // namespace

void require_few_triangles(double area, double edge_length, double most) {
    const double triangles = 2.0 * area / (edge_length * edge_length);
    if (triangles > most)
        throw UserError(fmt::format("edges of {:g} m divide the surface into {:.3g} triangles", edge_length, triangles),
                        fmt::format("It has at most {:g}", most), "Give a longer edge");
}

std::size_t circle_segments(double radius, double edge_length) {
    return 4 * std::max<std::size_t>(4, static_cast<std::size_t>(std::ceil(2.0 * k_pi * radius / edge_length / 4.0)));
}

TriangleSurface solid_of_revolution(const std::vector<MeridianPoint>& section, std::size_t segments, double edge_length) {
    if (section.size() < 3 || segments < 3 || !(edge_length > 0.0)) throw std::invalid_argument("a section needs three points or more");
    const bool closed = section.front().r > 0.0 || section.back().r > 0.0;
    TriangleSurface surface;
    std::vector<std::vector<std::uint32_t>> circles;
    for (const MeridianPoint& point : divided(section, closed, edge_length)) circles.push_back(add_circle(surface, point, segments));
    const std::size_t bands = closed ? circles.size() : circles.size() - 1;
    for (std::size_t i = 0; i < bands; ++i) add_band(surface, circles[i], circles[(i + 1) % circles.size()]);
    if (volume_of(surface) < 0.0)
        for (Triangle& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
    return surface;
}

}  // namespace cutterflow::geometry
