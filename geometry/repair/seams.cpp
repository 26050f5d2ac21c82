#include "geometry/repair/seams.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "geometry/cgal/points_on_edges.hpp"
#include "geometry/surface/topology.hpp"

namespace cutterflow::geometry::repair {
namespace {

/// A triangle has three edges to divide, one a pass; pieces of an edge need none.
constexpr int k_passes = 6;

struct OpenEdges {
    std::vector<std::array<std::uint32_t, 2>> ends;  ///< in the triangle's sense
    std::vector<std::size_t> triangle;
    std::vector<std::uint32_t> points;  ///< all their ends, each once
};

OpenEdges open_edges(const TriangleSurface& surface) {
    OpenEdges open;
    for_each_edge(sorted_edge_uses(surface), [&](auto first, auto last) {
        if (last - first != 1) return;
        if (first->ascending) {
            open.ends.push_back({first->low, first->high});
        } else {
            open.ends.push_back({first->high, first->low});
        }
        open.triangle.push_back(first->triangle);
        open.points.push_back(first->low);
        open.points.push_back(first->high);
    });
    std::sort(open.points.begin(), open.points.end());
    open.points.erase(std::unique(open.points.begin(), open.points.end()), open.points.end());
    return open;
}

std::uint32_t opposite_point(const Triangle& triangle, const std::array<std::uint32_t, 2>& edge) {
    return *std::find_if(triangle.begin(), triangle.end(), [&](std::uint32_t p) { return p != edge[0] && p != edge[1]; });
}

/// One pass: at most one edge of each triangle.
Stepped divide_once(const TracedSurface& traced, double distance) {
    const OpenEdges open = open_edges(traced.surface);
    const auto on_edge = find_points_on_edges(traced.surface.points, open.ends, open.points, distance);
    Stepped result{traced, 0};
    std::vector<bool> divided(traced.surface.triangles.size(), false);
    for (std::size_t e = 0; e < open.ends.size(); ++e) {
        const std::size_t t = open.triangle[e];
        const std::uint32_t apex = opposite_point(traced.surface.triangles[t], open.ends[e]);
        std::vector<std::uint32_t> line{open.ends[e][0]};
        std::copy_if(on_edge[e].begin(), on_edge[e].end(), std::back_inserter(line), [&](std::uint32_t p) { return p != apex; });
        line.push_back(open.ends[e][1]);
        if (line.size() == 2 || divided[t]) continue;
        divided[t] = true;
        ++result.count;
        result.traced.surface.triangles[t] = {line[0], line[1], apex};
        for (std::size_t k = 1; k + 1 < line.size(); ++k) result.traced.add({line[k], line[k + 1], apex}, traced.source[t]);
    }
    return result;
}

/// The corners (3 t + k) of one fan around a point.
using Fan = std::vector<std::size_t>;

/// Mean of the middles of a fan's triangles.
Vec3 middle_of(const TriangleSurface& surface, const Fan& fan) {
    Vec3 sum = Vec3::Zero();
    for (const std::size_t corner : fan) sum += centroid_of(surface, surface.triangles[corner / 3]);
    return sum / static_cast<double>(fan.size());
}

}  // namespace

Stepped part_touching_points(const TracedSurface& traced, double distance) {
    const TriangleSurface& surface = traced.surface;
    const std::vector<std::size_t> fan_of = fans_of_corners(surface, sorted_edge_uses(surface));
    std::vector<std::map<std::size_t, Fan>> fans(surface.points.size());
    for (std::size_t corner = 0; corner < fan_of.size(); ++corner)
        fans[surface.triangles[corner / 3][corner % 3]][fan_of[corner]].push_back(corner);
    Stepped result{traced, 0};
    for (std::size_t p = 0; p < fans.size(); ++p) {
        if (fans[p].size() < 2) continue;
        const auto largest = std::max_element(fans[p].begin(), fans[p].end(),
                                              [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
        for (auto fan = fans[p].begin(); fan != fans[p].end(); ++fan) {
            if (fan == largest) continue;
            const Vec3 inwards = (middle_of(surface, fan->second) - surface.points[p]).normalized();
            const auto own = static_cast<std::uint32_t>(result.traced.surface.points.size());
            result.traced.surface.points.push_back(surface.points[p] + distance * inwards);
            for (const std::size_t corner : fan->second) result.traced.surface.triangles[corner / 3][corner % 3] = own;
            ++result.count;
        }
    }
    return result;
}

Stepped join_seams(const TracedSurface& traced, double distance) {
    Stepped result{traced, 0};
    for (int pass = 0; pass < k_passes; ++pass) {
        const Stepped divided = divide_once(result.traced, distance);
        if (divided.count == 0) break;
        result = {divided.traced, result.count + divided.count};
    }
    return result;
}

}  // namespace cutterflow::geometry::repair
