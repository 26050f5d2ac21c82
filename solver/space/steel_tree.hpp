#pragma once
/// \file Line of sight past triangles: a bounding volume hierarchy for segment intersection and nearest distance.
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <gsl/span>

#include "geometry/base/vec3.hpp"
#include "solver/ports/fluid_engine.hpp"
#include "solver/space/box.hpp"

namespace cutterflow::coupling {

class SteelTree {
public:
    explicit SteelTree(gsl::span<const SteelTriangle> triangles);

    bool empty() const { return triangles_.empty(); }

    /// False when no triangle meets the box. True may be said in vain: what is looked at are the boxes around triangles.
    bool may_meet(const Box& box) const;

    /// Whether one triangle, by the number that each_within gives, meets the segment from `origin` to `origin` + `offset` [m].
    bool stops(std::int32_t triangle, const Vec3& origin, const Vec3& offset) const;

    /// True when a triangle meets the segment from a to b [m]. Edges count, so that no segment passes between two triangles that share one.
    bool blocks(const Vec3& a, const Vec3& b) const;

    /// The same. Looks first at the triangle that stopped the line before, because the next line is mostly stopped by the same one.
    /// \param last  its number, or -1; set to the one that stops this line
    bool blocks(const Vec3& a, const Vec3& b, std::int32_t& last) const;

    /// True when the point [m] lies inside the solid that the triangles bound: a ray from it crosses them an odd number of times. The ray
    /// rises by a thousandth, so that it does not meet floor and cover of a tank, which may be among the triangles.
    /// \pre  the triangles close their solids, except for openings above or below
    bool contains(const Vec3& point) const;

    /// Distance [m] from a point to the nearest triangle, or `limit` when none is nearer.
    double distance(const Vec3& point, double limit) const;

    /// Place of the triangle of a number, as each_within gives it, among those that the tree was made of.
    std::int32_t given(std::int32_t triangle) const { return given_[static_cast<std::size_t>(triangle)]; }

    /// Calls `each(number, triangle, squared distance)` for every triangle nearer to a point than `limit` [m].
    void each_within(const Vec3& point, double limit, const std::function<void(std::int32_t, const SteelTriangle&, double)>& each) const;

private:
    struct Node {
        Box box;
        std::int32_t first;  // leaf: its first triangle; else its second child (the first one follows the node)
        std::int32_t count;  // leaf: number of triangles; else 0
    };
    struct Triangle {
        Vec3 corner, edge1, edge2;
    };
    struct Item;  // a triangle while the tree is built

    void build(std::vector<Item>& items, std::size_t begin, std::size_t end);
    static bool meets(const Triangle& triangle, const Vec3& origin, const Vec3& direction, double edge_slack);
    /// Calls `each(triangle)` for the triangles whose boxes the segment passes, until it returns true. \return whether it did
    template <class Each>
    bool along(const Vec3& origin, const Vec3& direction, const Each& each) const;
    static double squared_distance(const Triangle& triangle, const Vec3& point);

    std::vector<Node> nodes_;
    std::vector<Triangle> triangles_;
    std::vector<std::int32_t> given_;  // of each triangle
};

}  // namespace cutterflow::coupling
