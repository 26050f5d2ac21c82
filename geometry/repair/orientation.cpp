#include "geometry/repair/orientation.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/repair/winding.hpp"
#include "geometry/surface/topology.hpp"

namespace cutterflow::geometry::repair {
namespace {

struct Neighbour {
    std::size_t triangle;
    bool same_sense;  ///< the two pass their edge in opposite directions, as they should
};

std::vector<std::vector<Neighbour>> neighbours_over_manifold_edges(const TriangleSurface& surface) {
    std::vector<std::vector<Neighbour>> neighbours(surface.triangles.size());
    for_each_edge(sorted_edge_uses(surface), [&](auto first, auto last) {
        if (last - first != 2) return;
        const auto second = std::next(first);
        const bool same = first->ascending != second->ascending;
        neighbours[first->triangle].push_back({second->triangle, same});
        neighbours[second->triangle].push_back({first->triangle, same});
    });
    return neighbours;
}

void flip(Triangle& triangle) {
    std::swap(triangle[1], triangle[2]);
}

/// Triangles of one sheet, and whether each has the sense of the first.
struct Sheet {
    std::vector<std::size_t> triangles;
    std::vector<bool> as_first;
};

Sheet sheet_from(std::size_t seed, const std::vector<std::vector<Neighbour>>& neighbours, std::vector<bool>& visited) {
    Sheet sheet{{seed}, {true}};
    visited[seed] = true;
    for (std::size_t i = 0; i < sheet.triangles.size(); ++i)
        for (const Neighbour& neighbour : neighbours[sheet.triangles[i]]) {
            if (visited[neighbour.triangle]) continue;
            visited[neighbour.triangle] = true;
            sheet.triangles.push_back(neighbour.triangle);
            sheet.as_first.push_back(neighbour.same_sense == sheet.as_first[i]);
        }
    return sheet;
}

/// Components of a surface: is each closed, with what volume?
struct Components {
    std::vector<std::size_t> number;
    std::vector<bool> closed;
    std::vector<double> volume;
};

Components components_of(const TriangleSurface& surface) {
    const std::vector<EdgeUse> uses = sorted_edge_uses(surface);
    Components components{component_numbers(surface, uses), {}, {}};
    std::size_t count = 0;
    for (const std::size_t number : components.number) count = std::max(count, number + 1);
    components.closed.assign(count, true);
    components.volume.assign(count, 0.0);
    for_each_edge(uses, [&](auto first, auto last) {
        if ((last - first) % 2 == 1) components.closed[components.number[first->triangle]] = false;
    });
    const Vec3 origin = bounds_of(surface).min;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        components.volume[components.number[t]] +=
            area_vector(surface, surface.triangles[t]).dot(surface.points[surface.triangles[t][0]] - origin) / 3.0;
    return components;
}

/// Do all points of component `inner` lie inside another closed component?
bool is_enclosed(const TriangleSurface& surface, const Components& components, std::size_t inner) {
    for (std::size_t outer = 0; outer < components.closed.size(); ++outer) {
        if (outer == inner || !components.closed[outer]) continue;
        if (std::abs(components.volume[outer]) < std::abs(components.volume[inner])) continue;
        TriangleSurface shell{surface.points, {}};
        for (std::size_t t = 0; t < surface.triangles.size(); ++t)
            if (components.number[t] == outer) shell.triangles.push_back(surface.triangles[t]);
        bool inside = true;
        for (std::size_t t = 0; t < surface.triangles.size() && inside; ++t) {
            if (components.number[t] != inner) continue;
            for (const std::uint32_t corner : surface.triangles[t])
                inside = inside && std::abs(winding_number(shell, surface.points[corner])) > 0.5;
        }
        if (inside) return true;
    }
    return false;
}

}  // namespace

Stepped orient_consistently(const TracedSurface& traced) {
    Stepped result{traced, 0};
    const TriangleSurface& surface = traced.surface;
    const auto neighbours = neighbours_over_manifold_edges(surface);
    std::vector<bool> visited(surface.triangles.size(), false);
    for (std::size_t seed = 0; seed < visited.size(); ++seed) {
        if (visited[seed]) continue;
        const Sheet sheet = sheet_from(seed, neighbours, visited);
        double balance = 0.0;
        for (std::size_t i = 0; i < sheet.triangles.size(); ++i)
            balance += (sheet.as_first[i] ? 1.0 : -1.0) * area_vector(surface, surface.triangles[sheet.triangles[i]]).norm();
        const bool first_stays = balance >= 0.0;
        for (std::size_t i = 0; i < sheet.triangles.size(); ++i) {
            if (sheet.as_first[i] == first_stays) continue;
            flip(result.traced.surface.triangles[sheet.triangles[i]]);
            ++result.count;
        }
    }
    return result;
}

Stepped orient_outwards(const TracedSurface& traced) {
    Stepped result{traced, 0};
    const Components components = components_of(traced.surface);
    for (std::size_t c = 0; c < components.closed.size(); ++c) {
        if (!components.closed[c] || components.volume[c] >= 0.0 || is_enclosed(traced.surface, components, c)) continue;
        for (std::size_t t = 0; t < components.number.size(); ++t) {
            if (components.number[t] != c) continue;
            flip(result.traced.surface.triangles[t]);
            ++result.count;
        }
    }
    return result;
}

}  // namespace cutterflow::geometry::repair
