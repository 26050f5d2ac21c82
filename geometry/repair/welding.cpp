#include "geometry/repair/welding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

#include "geometry/surface/topology.hpp"

namespace cutterflow::geometry::repair {
namespace {

/// Points by the cells of a lattice, to find those near a place.
class PointLattice {
public:
    explicit PointLattice(double cell) : cell_(cell) {}

    void insert(const Vec3& point, std::uint32_t index) { cells_[key(cell_of(point))].push_back(index); }

    template <class Visit>
    void for_each_near(const Vec3& point, Visit&& visit) const {
        const std::array<std::int64_t, 3> middle = cell_of(point);
        for (std::int64_t i = -1; i <= 1; ++i)
            for (std::int64_t j = -1; j <= 1; ++j)
                for (std::int64_t k = -1; k <= 1; ++k) {
                    const auto found = cells_.find(key({middle[0] + i, middle[1] + j, middle[2] + k}));
                    if (found == cells_.end()) continue;
                    for (const std::uint32_t index : found->second) visit(index);
                }
    }

private:
    std::array<std::int64_t, 3> cell_of(const Vec3& point) const {
        return {std::llround(point.x() / cell_), std::llround(point.y() / cell_), std::llround(point.z() / cell_)};
    }
    /// Distant cells may share a key: that costs only time, because distances decide.
    static std::uint64_t key(const std::array<std::int64_t, 3>& cell) {
        return static_cast<std::uint64_t>(cell[0]) * 73856093U ^ static_cast<std::uint64_t>(cell[1]) * 19349663U ^
               static_cast<std::uint64_t>(cell[2]) * 83492791U;
    }

    double cell_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

double height_over_longest_side(const TriangleSurface& surface, const Triangle& triangle) {
    double longest = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
        longest = std::max(longest, (surface.points[triangle[(k + 1) % 3]] - surface.points[triangle[k]]).norm());
    return longest > 0.0 ? 2.0 * area_vector(surface, triangle).norm() / longest : 0.0;
}

bool has_equal_points(const Triangle& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

Stepped without(const TracedSurface& traced, const std::vector<bool>& drop) {
    std::vector<bool> keep = drop;
    keep.flip();
    return {selected(traced, keep), static_cast<std::size_t>(std::count(drop.begin(), drop.end(), true))};
}

Triangle sorted_points(Triangle triangle) {
    std::sort(triangle.begin(), triangle.end());
    return triangle;
}

bool is_even_permutation(const Triangle& t) {
    const int falls = (t[0] > t[1]) + (t[1] > t[2]) + (t[2] > t[0]);
    return falls == 1;
}

/// The copies of one triangle.
struct Twins {
    std::vector<std::size_t> even, odd;  ///< by sense
    bool opposed() const { return !even.empty() && !odd.empty(); }
};

/// Marks all copies of groups of opposed twins that are a wall inside a solid.
void mark_inner_walls(const TriangleSurface& surface, const std::map<Triangle, Twins>& twins, std::vector<bool>& drop) {
    std::vector<bool> is_opposed(surface.triangles.size(), false);
    for (const auto& [points, copies] : twins) {
        if (!copies.opposed()) continue;
        for (const std::size_t t : copies.even) is_opposed[t] = true;
        for (const std::size_t t : copies.odd) is_opposed[t] = true;
    }
    if (std::find(is_opposed.begin(), is_opposed.end(), true) == is_opposed.end()) return;
    const std::vector<EdgeUse> uses = sorted_edge_uses(surface);
    DisjointSets groups(surface.triangles.size());
    std::map<std::size_t, int> walls;  // by group: border edges consistent with a wall, less the others
    std::vector<std::pair<std::size_t, int>> votes;
    for_each_edge(uses, [&](auto first, auto last) {
        std::size_t opposed = surface.triangles.size();
        int others = 0;
        for (auto use = first; use != last; ++use) {
            if (!is_opposed[use->triangle]) {
                ++others;
                continue;
            }
            if (opposed != surface.triangles.size()) groups.unite(opposed, use->triangle);
            opposed = use->triangle;
        }
        if (opposed != surface.triangles.size() && others > 0) votes.emplace_back(opposed, others % 2 == 0 ? 1 : -1);
    });
    for (const auto& [triangle, vote] : votes) walls[groups.root(triangle)] += vote;
    for (std::size_t t = 0; t < is_opposed.size(); ++t) {
        if (!is_opposed[t]) continue;
        const auto found = walls.find(groups.root(t));
        if (found != walls.end() && found->second > 0) drop[t] = true;
    }
}

}  // namespace

TracedSurface selected(const TracedSurface& traced, const std::vector<bool>& keep) {
    constexpr std::uint32_t k_unused = ~0U;
    TracedSurface result;
    std::vector<std::uint32_t> place_of(traced.surface.points.size(), k_unused);
    for (std::size_t t = 0; t < traced.surface.triangles.size(); ++t) {
        if (!keep[t]) continue;
        Triangle moved{};
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& place = place_of[traced.surface.triangles[t][k]];
            if (place == k_unused) {
                place = static_cast<std::uint32_t>(result.surface.points.size());
                result.surface.points.push_back(traced.surface.points[traced.surface.triangles[t][k]]);
            }
            moved.at(k) = place;
        }
        result.add(moved, traced.source[t]);
    }
    return result;
}

Stepped weld_points(const TracedSurface& traced, double distance) {
    const std::vector<Vec3>& points = traced.surface.points;
    PointLattice lattice(distance);
    std::vector<std::uint32_t> joined_to(points.size());
    std::size_t joined = 0;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        joined_to[i] = i;
        double nearest = distance;
        lattice.for_each_near(points[i], [&](std::uint32_t candidate) {
            const double apart = (points[candidate] - points[i]).norm();
            if (apart > nearest || (apart == nearest && joined_to[i] != i)) return;
            nearest = apart;
            joined_to[i] = candidate;
        });
        if (joined_to[i] == i) {
            lattice.insert(points[i], i);
        } else {
            ++joined;
        }
    }
    TracedSurface welded_surface = traced;
    for (Triangle& triangle : welded_surface.surface.triangles)
        for (std::uint32_t& corner : triangle) corner = joined_to[corner];
    return {selected(welded_surface, std::vector<bool>(traced.surface.triangles.size(), true)), joined};
}

Stepped drop_flat_triangles(const TracedSurface& traced, double height) {
    const TriangleSurface& surface = traced.surface;
    std::vector<bool> drop(surface.triangles.size());
    for (std::size_t t = 0; t < drop.size(); ++t)
        drop[t] = has_equal_points(surface.triangles[t]) || height_over_longest_side(surface, surface.triangles[t]) <= height;
    return without(traced, drop);
}

Stepped drop_duplicates(const TracedSurface& traced) {
    const TriangleSurface& surface = traced.surface;
    std::map<Triangle, Twins> twins;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const Triangle& triangle = surface.triangles[t];
        Twins& copies = twins[sorted_points(triangle)];
        (is_even_permutation(triangle) ? copies.even : copies.odd).push_back(t);
    }
    std::vector<bool> drop(surface.triangles.size(), false);
    for (const auto& [points, copies] : twins) {
        const std::vector<std::size_t>& kept = copies.even.size() >= copies.odd.size() ? copies.even : copies.odd;
        for (const std::vector<std::size_t>* sense : {&copies.even, &copies.odd})
            for (const std::size_t t : *sense) drop[t] = t != kept.front();
    }
    mark_inner_walls(surface, twins, drop);
    return without(traced, drop);
}

Stepped drop_hanging_sheets(const TracedSurface& traced) {
    Stepped result{traced, 0};
    while (true) {
        const TriangleSurface& surface = result.traced.surface;
        const std::vector<EdgeUse> uses = sorted_edge_uses(surface);
        DisjointSets sheets(surface.triangles.size());
        for_each_edge(uses, [&](auto first, auto last) {
            if (last - first == 2) sheets.unite(first->triangle, std::next(first)->triangle);
        });
        std::vector<double> area(surface.triangles.size(), 0.0);
        for (std::size_t t = 0; t < area.size(); ++t) area[sheets.root(t)] += area_vector(surface, surface.triangles[t]).norm();
        std::vector<bool> is_free(surface.triangles.size(), false);
        for_each_edge(uses, [&](auto first, auto last) {
            if (last - first == 1) is_free[sheets.root(first->triangle)] = true;
        });
        std::set<std::size_t> hanging;
        for_each_edge(uses, [&](auto first, auto last) {
            if (last - first < 3 || (last - first) % 2 == 0) return;
            std::map<std::size_t, int> passages;
            for (auto use = first; use != last; ++use) ++passages[sheets.root(use->triangle)];
            std::size_t smallest = area.size();
            for (const auto& [sheet, count] : passages)
                if (count % 2 == 1 && is_free[sheet] && (smallest == area.size() || area[sheet] < area[smallest])) smallest = sheet;
            if (smallest != area.size()) hanging.insert(smallest);
        });
        if (hanging.empty()) return result;
        std::vector<bool> drop(surface.triangles.size());
        for (std::size_t t = 0; t < drop.size(); ++t) drop[t] = hanging.count(sheets.root(t)) > 0;
        const Stepped less = without(result.traced, drop);
        result = {less.traced, result.count + less.count};
    }
}

}  // namespace cutterflow::geometry::repair
