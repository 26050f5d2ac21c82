#pragma once
/// \file Connectivity of triangles: edges with every triangle that uses them, and disjoint sets.
#include <cstddef>
#include <numeric>
#include <vector>

#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// One passage of a triangle along an edge between points low < high.
struct EdgeUse {
    std::uint32_t low;
    std::uint32_t high;
    std::size_t triangle;
    bool ascending;  ///< the triangle passes from low to high
    bool same_edge(const EdgeUse& other) const { return low == other.low && high == other.high; }
};

/// Every passage of every triangle, sorted by edge, then by triangle. Edges between equal points are left out.
std::vector<EdgeUse> sorted_edge_uses(const TriangleSurface& surface);

/// Calls `visit(first, last)` with the range of uses of each edge. \param uses  sorted
template <class Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, Visit&& visit) {
    for (auto first = uses.begin(); first != uses.end();) {
        auto last = first;
        while (last != uses.end() && last->same_edge(*first)) ++last;
        visit(first, last);
        first = last;
    }
}

/// Disjoint sets of indices.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
    std::size_t root(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void unite(std::size_t i, std::size_t j) { parent_[root(i)] = root(j); }

private:
    std::vector<std::size_t> parent_;
};

/// For each triangle the number of its component: triangles connected over edges, numbered from 0 in order of appearance.
std::vector<std::size_t> component_numbers(const TriangleSurface& surface, const std::vector<EdgeUse>& uses);

/// Triangles around a point that are connected over edges ending in it form a fan. For each corner, 3 t + k for point k of triangle t, a
/// number that corners of the same fan share and no others.
std::vector<std::size_t> fans_of_corners(const TriangleSurface& surface, const std::vector<EdgeUse>& uses);

}  // namespace cutterflow::geometry
