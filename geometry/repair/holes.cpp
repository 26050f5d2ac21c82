#include "geometry/repair/holes.hpp"

#include <algorithm>
#include <map>

#include "geometry/cgal/hole_patch.hpp"
#include "geometry/surface/topology.hpp"

namespace cutterflow::geometry::repair {
namespace {

/// An open edge as a patch would pass it.
struct Step {
    std::uint32_t to;
    std::size_t triangle;
};

std::multimap<std::uint32_t, Step> open_steps(const TriangleSurface& surface) {
    std::multimap<std::uint32_t, Step> steps;
    for_each_edge(sorted_edge_uses(surface), [&](auto first, auto last) {
        if (last - first != 1) return;
        const std::uint32_t from = first->ascending ? first->high : first->low;
        const std::uint32_t to = first->ascending ? first->low : first->high;
        steps.emplace(from, Step{to, first->triangle});
    });
    return steps;
}

Hole hole_of(const TriangleSurface& surface, std::vector<std::uint32_t> points, std::vector<std::size_t> triangles) {
    Hole hole{std::move(points), std::move(triangles), 0.0, Vec3::Zero()};
    TriangleSurface loop;
    for (const std::uint32_t p : hole.points) {
        loop.points.push_back(surface.points[p]);
        hole.middle += surface.points[p] / static_cast<double>(hole.points.size());
    }
    hole.size = bounds_of(loop).extent().maxCoeff();
    return hole;
}

}  // namespace

std::vector<Hole> find_holes(const TriangleSurface& surface) {
    std::vector<Hole> holes;
    std::multimap<std::uint32_t, Step> steps = open_steps(surface);
    while (!steps.empty()) {
        // Walk along open edges; when the walk returns to one of its points, the loop since then is a hole.
        std::vector<std::uint32_t> path{steps.begin()->first};
        std::vector<std::size_t> triangles;
        std::map<std::uint32_t, std::ptrdiff_t> place{{path.front(), 0}};
        while (true) {
            const auto next = steps.find(path.back());
            if (next == steps.end()) break;
            const Step step = next->second;
            steps.erase(next);
            triangles.push_back(step.triangle);
            const auto [known, is_new] = place.try_emplace(step.to, static_cast<std::ptrdiff_t>(path.size()));
            if (is_new) {
                path.push_back(step.to);
                continue;
            }
            const auto met = path.begin() + known->second;
            const auto length = path.end() - met;
            if (length > 2) holes.push_back(hole_of(surface, {met, path.end()}, {triangles.end() - length, triangles.end()}));
            std::for_each(met + 1, path.end(), [&](std::uint32_t p) { place.erase(p); });
            path.erase(met + 1, path.end());
            triangles.erase(triangles.end() - length, triangles.end());
        }
    }
    return holes;
}

double enclosed_volume(const TriangleSurface& surface) {
    TriangleSurface capped = surface;
    for (const Hole& hole : find_holes(surface)) {
        const auto apex = static_cast<std::uint32_t>(capped.points.size());
        capped.points.push_back(hole.middle);
        for (std::size_t k = 0; k < hole.points.size(); ++k)
            capped.triangles.push_back({hole.points[k], hole.points[(k + 1) % hole.points.size()], apex});
    }
    return volume_of(capped);
}

Filled fill_holes(const TracedSurface& traced, const std::vector<Hole>& holes) {
    Filled filled{traced, 0, 0.0, 0.0, {}};
    for (const Hole& hole : holes) {
        std::vector<Vec3> loop;
        for (const std::uint32_t p : hole.points) loop.push_back(traced.surface.points[p]);
        const std::vector<Triangle> patch = triangulate_hole(loop);
        if (patch.empty()) {
            filled.left_open.push_back(hole);
            continue;
        }
        ++filled.count;
        for (const Triangle& t : patch) {
            const Triangle triangle{hole.points[t[0]], hole.points[t[1]], hole.points[t[2]]};
            const double area = area_vector(traced.surface, triangle).norm();
            filled.area += area;
            filled.uncertain_volume += area * hole.size / 6.0;
            filled.traced.add(triangle, k_added);
        }
    }
    return filled;
}

}  // namespace cutterflow::geometry::repair
