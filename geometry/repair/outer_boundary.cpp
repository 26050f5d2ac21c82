#include "geometry/repair/outer_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/cgal/arrangement.hpp"
#include "geometry/cgal/self_intersections.hpp"
#include "geometry/repair/winding.hpp"
#include "geometry/surface/topology.hpp"

namespace cutterflow::geometry::repair {
namespace {

TriangleSurface corners_of(const Arrangement& arrangement) {
    TriangleSurface surface{arrangement.points, {}};
    for (const Facet& facet : arrangement.facets) surface.triangles.push_back(facet.corners);
    return surface;
}

/// Facets connected over edges of two facets have the same space on either side.
std::vector<std::size_t> patch_roots(const TriangleSurface& facets) {
    DisjointSets patches(facets.triangles.size());
    for_each_edge(sorted_edge_uses(facets), [&](auto first, auto last) {
        if (last - first == 2) patches.unite(first->triangle, std::next(first)->triangle);
    });
    std::vector<std::size_t> roots(facets.triangles.size());
    for (std::size_t f = 0; f < roots.size(); ++f) roots[f] = patches.root(f);
    return roots;
}

/// Winding number at a facet's centroid without the facet itself: the mean of the numbers on its two sides.
double mean_winding_at(const Arrangement& arrangement, const TriangleSurface& facets, std::size_t at) {
    const Vec3 centroid = centroid_of(facets, facets.triangles[at]);
    double sum = 0.0;
    for (std::size_t f = 0; f < facets.triangles.size(); ++f) {
        if (f == at) continue;
        const Triangle& t = facets.triangles[f];
        sum +=
            arrangement.facets[f].multiplicity * solid_angle_share(facets.points[t[0]], facets.points[t[1]], facets.points[t[2]], centroid);
    }
    return sum;
}

/// For each patch (at the index of its root) the mean winding number of its two sides, at its largest facet, the least touched by rounding.
std::vector<double> mean_windings(const Arrangement& arrangement, const TriangleSurface& facets, const std::vector<std::size_t>& patch) {
    std::vector<std::size_t> largest(patch.size(), patch.size());
    std::vector<double> area(patch.size());
    for (std::size_t f = 0; f < patch.size(); ++f) {
        area[f] = area_vector(facets, facets.triangles[f]).norm();
        std::size_t& best = largest[patch[f]];
        if (best == patch.size() || area[f] > area[best]) best = f;
    }
    std::vector<double> mean(patch.size(), 0.0);
    for (std::size_t p = 0; p < patch.size(); ++p)
        if (largest[p] != patch.size()) mean[p] = mean_winding_at(arrangement, facets, largest[p]);
    return mean;
}

/// A wall within a solid or outside it ends at edges that facets do not pass equally often in either sense, and has the same whole winding
/// number on both sides, where a boundary has numbers that differ by one. Of the patches at such edges the one whose mean is nearest to a
/// whole number; none when all edges balance or no patch is like a wall.
std::optional<std::size_t> most_likely_wall(const Arrangement& arrangement, const TriangleSurface& facets,
                                            const std::vector<std::size_t>& patch, const std::vector<double>& mean) {
    std::optional<std::size_t> wall;
    double smallest = 0.25;  // a boundary has 0.5
    for_each_edge(sorted_edge_uses(facets), [&](auto first, auto last) {
        int balance = 0;
        for (auto use = first; use != last; ++use) balance += (use->ascending ? 1 : -1) * arrangement.facets[use->triangle].multiplicity;
        if (balance == 0) return;
        for (auto use = first; use != last; ++use) {
            if (arrangement.facets[use->triangle].multiplicity == 0) continue;
            const std::size_t root = patch[use->triangle];
            const double distance = std::abs(mean[root] - std::round(mean[root]));
            if (distance >= smallest) continue;
            wall = root;
            smallest = distance;
        }
    });
    return wall;
}

enum class Role { none, boundary, reversed_boundary };

/// Does the solid (winding number 1 or more) lie on one side alone?
Role role_of(double mean, int multiplicity) {
    const bool solid_behind = mean + 0.5 * multiplicity > 0.5;
    const bool solid_before = mean - 0.5 * multiplicity > 0.5;
    if (solid_behind == solid_before) return Role::none;
    return solid_behind ? Role::boundary : Role::reversed_boundary;
}

}  // namespace

Stepped outer_boundary(const TracedSurface& traced) {
    const auto crossing = find_self_intersections(traced.surface);
    if (crossing.size() > k_most_crossings)
        throw CheckFailure({"", fmt::format("{} pairs of triangles cross", crossing.size()),
                            fmt::format("Up to {} can be resolved", k_most_crossings), "Unite the bodies in CAD"});
    Arrangement arrangement = arrange(traced.surface, crossing);
    const TriangleSurface facets = corners_of(arrangement);
    const std::vector<std::size_t> patch = patch_roots(facets);

    std::vector<double> mean = mean_windings(arrangement, facets, patch);
    // Each wall that goes closes the rest at its edges, and changes the winding numbers that it had disturbed.
    while (const std::optional<std::size_t> wall = most_likely_wall(arrangement, facets, patch, mean)) {
        for (std::size_t f = 0; f < patch.size(); ++f)
            if (patch[f] == *wall) arrangement.facets[f].multiplicity = 0;
        mean = mean_windings(arrangement, facets, patch);
    }

    Stepped result{{{facets.points, {}}, {}}, crossing.size()};
    for (std::size_t f = 0; f < patch.size(); ++f) {
        const Role role = role_of(mean[patch[f]], arrangement.facets[f].multiplicity);
        if (role == Role::none) continue;
        Triangle corners = facets.triangles[f];
        if (role == Role::reversed_boundary) std::swap(corners[1], corners[2]);
        result.traced.add(corners, traced.source[arrangement.facets[f].parent]);
    }
    result.traced = selected(result.traced, std::vector<bool>(result.traced.source.size(), true));
    return result;
}

}  // namespace cutterflow::geometry::repair
