#include "geometry/surface/topology.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace cutterflow::geometry {

std::vector<EdgeUse> sorted_edge_uses(const TriangleSurface& surface) {
    std::vector<EdgeUse> uses;
    uses.reserve(3 * surface.triangles.size());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = surface.triangles[t][k];
            const std::uint32_t b = surface.triangles[t][(k + 1) % 3];
            if (a != b) uses.push_back({std::min(a, b), std::max(a, b), t, a < b});
        }
    std::sort(uses.begin(), uses.end(),
              [](const EdgeUse& x, const EdgeUse& y) { return std::tie(x.low, x.high, x.triangle) < std::tie(y.low, y.high, y.triangle); });
    return uses;
}

std::vector<std::size_t> component_numbers(const TriangleSurface& surface, const std::vector<EdgeUse>& uses) {
    DisjointSets sets(surface.triangles.size());
    for (std::size_t i = 1; i < uses.size(); ++i)
        if (uses[i].same_edge(uses[i - 1])) sets.unite(uses[i].triangle, uses[i - 1].triangle);
    std::map<std::size_t, std::size_t> number_of_root;
    std::vector<std::size_t> numbers(surface.triangles.size());
    for (std::size_t t = 0; t < numbers.size(); ++t)
        numbers[t] = number_of_root.try_emplace(sets.root(t), number_of_root.size()).first->second;
    return numbers;
}

std::vector<std::size_t> fans_of_corners(const TriangleSurface& surface, const std::vector<EdgeUse>& uses) {
    DisjointSets corners(3 * surface.triangles.size());
    const auto corner_of = [&](std::size_t t, std::uint32_t point) {
        const Triangle& triangle = surface.triangles[t];
        return 3 * t + static_cast<std::size_t>(std::find(triangle.begin(), triangle.end(), point) - triangle.begin());
    };
    for (std::size_t i = 1; i < uses.size(); ++i) {
        if (!uses[i].same_edge(uses[i - 1])) continue;
        for (const std::uint32_t point : {uses[i].low, uses[i].high})
            corners.unite(corner_of(uses[i].triangle, point), corner_of(uses[i - 1].triangle, point));
    }
    std::vector<std::size_t> fans(3 * surface.triangles.size());
    for (std::size_t corner = 0; corner < fans.size(); ++corner) fans[corner] = corners.root(corner);
    return fans;
}

}  // namespace cutterflow::geometry
