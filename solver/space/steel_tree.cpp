#include "solver/space/steel_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cutterflow::coupling {
namespace {

constexpr std::size_t k_leaf_size = 4;
// Barycentric slack that closes the crack along shared edges against rounding.
constexpr double k_edge_slack = 1e-9;
// Boxes are this much thicker than what they hold, relative to their size, so that the tests need no tolerance.
constexpr double k_box_margin = 1e-8;
// Halving bounds the depth by the logarithm of the count; a depth-first walk keeps one entry per level and one more.
constexpr int k_stack_size = 64;
// Direction of the rays for inside/outside: along no line that occurs in meshes of heads, and nearly horizontal.
const Vec3 k_ray_direction = Vec3(0.6471, 0.7624, 1e-3).normalized();

}  // namespace

struct SteelTree::Item {
    Vec3 lower, upper, middle;
    Triangle triangle;
    std::int32_t given;
};

SteelTree::SteelTree(gsl::span<const SteelTriangle> triangles) {
    std::vector<Item> items;
    items.reserve(triangles.size());
    for (const SteelTriangle& t : triangles) {
        Item item;
        item.lower = t.a.cwiseMin(t.b).cwiseMin(t.c);
        item.upper = t.a.cwiseMax(t.b).cwiseMax(t.c);
        item.middle = 0.5 * (item.lower + item.upper);
        item.triangle = {t.a, t.b - t.a, t.c - t.a};
        item.given = static_cast<std::int32_t>(items.size());
        items.push_back(item);
    }
    triangles_.reserve(items.size());
    given_.reserve(items.size());
    if (!items.empty()) build(items, 0, items.size());
}

void SteelTree::build(std::vector<Item>& items, std::size_t begin, std::size_t end) {
    const std::size_t self = nodes_.size();
    nodes_.emplace_back();
    Vec3 lower = items[begin].lower, upper = items[begin].upper;
    Vec3 middle_lower = items[begin].middle, middle_upper = items[begin].middle;
    for (std::size_t i = begin + 1; i < end; ++i) {
        lower = lower.cwiseMin(items[i].lower);
        upper = upper.cwiseMax(items[i].upper);
        middle_lower = middle_lower.cwiseMin(items[i].middle);
        middle_upper = middle_upper.cwiseMax(items[i].middle);
    }
    // Slightly thicker than the triangles, so that the slab test needs no tolerance.
    const Vec3 margin = Vec3::Constant(1e-9 * (upper - lower).norm());
    nodes_[self].box = {lower - margin, upper + margin};

    int axis = 0;
    const double extent = (middle_upper - middle_lower).maxCoeff(&axis);
    if (end - begin <= k_leaf_size || !(extent > 0.0)) {
        nodes_[self].first = static_cast<std::int32_t>(triangles_.size());
        nodes_[self].count = static_cast<std::int32_t>(end - begin);
        for (std::size_t i = begin; i < end; ++i) {
            triangles_.push_back(items[i].triangle);
            given_.push_back(items[i].given);
        }
        return;
    }
    // Halves of equal count: the triangles are faces of a mesh, alike in size and spread, where the surface-area rule gains little.
    const std::size_t half = begin + (end - begin) / 2;
    std::nth_element(items.begin() + static_cast<std::ptrdiff_t>(begin), items.begin() + static_cast<std::ptrdiff_t>(half),
                     items.begin() + static_cast<std::ptrdiff_t>(end),
                     [axis](const Item& a, const Item& b) { return a.middle[axis] < b.middle[axis]; });
    build(items, begin, half);
    nodes_[self].first = static_cast<std::int32_t>(nodes_.size());
    nodes_[self].count = 0;
    build(items, half, end);
}

bool SteelTree::meets(const Triangle& triangle, const Vec3& origin, const Vec3& direction, double edge_slack) {
    const Vec3 p = direction.cross(triangle.edge2);
    const double determinant = triangle.edge1.dot(p);
    if (determinant == 0.0) return false;
    const double inverse = 1.0 / determinant;
    const Vec3 s = origin - triangle.corner;
    const double u = s.dot(p) * inverse;
    if (!(u >= -edge_slack && u <= 1.0 + edge_slack)) return false;
    const Vec3 q = s.cross(triangle.edge1);
    const double v = direction.dot(q) * inverse;
    if (!(v >= -edge_slack && u + v <= 1.0 + edge_slack)) return false;
    const double t = triangle.edge2.dot(q) * inverse;
    return t >= 0.0 && t <= 1.0;
}

template <class Each>
bool SteelTree::along(const Vec3& origin, const Vec3& direction, const Each& each) const {
    if (nodes_.empty()) return false;
    // A component of zero would give 0 * infinity where the segment lies in the plane of a box face.
    const Vec3 inverse = direction.unaryExpr([](double d) { return 1.0 / (d == 0.0 ? 1e-300 : d); });
    const auto meets_box = [&](const Box& box) {
        double enter = 0.0, leave = 1.0;
        for (int i = 0; i < 3; ++i) {
            const double t0 = (box.lower[i] - origin[i]) * inverse[i];
            const double t1 = (box.upper[i] - origin[i]) * inverse[i];
            enter = std::max(enter, std::min(t0, t1));
            leave = std::min(leave, std::max(t0, t1));
        }
        return enter <= leave;
    };
    std::array<std::int32_t, k_stack_size> stack;
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const std::int32_t index = stack[--top];
        const Node& node = nodes_[static_cast<std::size_t>(index)];
        if (!meets_box(node.box)) continue;
        if (node.count > 0) {
            for (std::int32_t i = node.first; i < node.first + node.count; ++i)
                if (each(triangles_[static_cast<std::size_t>(i)])) return true;
        } else {
            stack[top++] = node.first;
            stack[top++] = index + 1;
        }
    }
    return false;
}

bool SteelTree::may_meet(const Box& box) const {
    if (nodes_.empty()) return false;
    std::array<std::int32_t, k_stack_size> stack;
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const std::int32_t index = stack[--top];
        const Node& node = nodes_[static_cast<std::size_t>(index)];
        if (!node.box.meets(box)) continue;
        if (node.count == 0) {
            stack[top++] = node.first;
            stack[top++] = index + 1;
            continue;
        }
        for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
            const Triangle& t = triangles_[static_cast<std::size_t>(i)];
            const Vec3 lower = t.edge1.cwiseMin(t.edge2).cwiseMin(0.0), upper = t.edge1.cwiseMax(t.edge2).cwiseMax(0.0);
            const Vec3 margin = Vec3::Constant(k_box_margin * (upper - lower).sum());
            if (Box{t.corner + lower - margin, t.corner + upper + margin}.meets(box)) return true;
        }
    }
    return false;
}

bool SteelTree::stops(std::int32_t triangle, const Vec3& origin, const Vec3& offset) const {
    return meets(triangles_[static_cast<std::size_t>(triangle)], origin, offset, k_edge_slack);
}

bool SteelTree::blocks(const Vec3& a, const Vec3& b) const {
    const Vec3 direction = b - a;
    return along(a, direction, [&](const Triangle& triangle) { return meets(triangle, a, direction, k_edge_slack); });
}

bool SteelTree::blocks(const Vec3& a, const Vec3& b, std::int32_t& last) const {
    const Vec3 direction = b - a;
    if (last >= 0 && meets(triangles_[static_cast<std::size_t>(last)], a, direction, k_edge_slack)) return true;
    return along(a, direction, [&](const Triangle& triangle) {
        if (!meets(triangle, a, direction, k_edge_slack)) return false;
        last = static_cast<std::int32_t>(&triangle - triangles_.data());
        return true;
    });
}

bool SteelTree::contains(const Vec3& point) const {
    if (nodes_.empty()) return false;
    const Box& all = nodes_[0].box;
    if ((point - all.lower).minCoeff() < 0.0 || (all.upper - point).minCoeff() < 0.0) return false;
    const Vec3 ray = 2.0 * (all.upper - all.lower).norm() * k_ray_direction;
    int crossings = 0;
    along(point, ray, [&](const Triangle& triangle) {
        crossings += meets(triangle, point, ray, 0.0) ? 1 : 0;
        return false;
    });
    return crossings % 2 == 1;
}

double SteelTree::squared_distance(const Triangle& triangle, const Vec3& point) {
    // Regions of the triangle's plane: corners, edges, interior (Ericson, Real-Time Collision Detection, 5.1.5).
    const Vec3& ab = triangle.edge1;
    const Vec3& ac = triangle.edge2;
    const Vec3 ap = point - triangle.corner;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0.0 && d2 <= 0.0) return ap.squaredNorm();
    const Vec3 bp = ap - ab;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0.0 && d4 <= d3) return bp.squaredNorm();
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return (ap - ab * (d1 / (d1 - d3))).squaredNorm();
    const Vec3 cp = ap - ac;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0.0 && d5 <= d6) return cp.squaredNorm();
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return (ap - ac * (d2 / (d2 - d6))).squaredNorm();
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return (bp - (ac - ab) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))).squaredNorm();
    const double sum = va + vb + vc;
    if (!(sum > 0.0)) return std::min({ap.squaredNorm(), bp.squaredNorm(), cp.squaredNorm()});
    return (ap - ab * (vb / sum) - ac * (vc / sum)).squaredNorm();
}

double SteelTree::distance(const Vec3& point, double limit) const {
    if (nodes_.empty()) return limit;
    double best = limit * limit;
    struct Entry {
        std::int32_t index;
        double squared;
    };
    std::array<Entry, k_stack_size> stack;
    int top = 0;
    stack[top++] = {0, nodes_[0].box.squared_distance(point)};
    while (top > 0) {
        const Entry entry = stack[--top];
        if (entry.squared >= best) continue;
        const Node& node = nodes_[static_cast<std::size_t>(entry.index)];
        if (node.count > 0) {
            for (std::int32_t i = node.first; i < node.first + node.count; ++i)
                best = std::min(best, squared_distance(triangles_[static_cast<std::size_t>(i)], point));
            continue;
        }
        const Entry first{entry.index + 1, nodes_[static_cast<std::size_t>(entry.index + 1)].box.squared_distance(point)};
        const Entry second{node.first, nodes_[static_cast<std::size_t>(node.first)].box.squared_distance(point)};
        const bool first_is_nearer = first.squared < second.squared;
        stack[top++] = first_is_nearer ? second : first;
        stack[top++] = first_is_nearer ? first : second;
    }
    return std::sqrt(best);
}

void SteelTree::each_within(const Vec3& point, double limit,
                            const std::function<void(std::int32_t, const SteelTriangle&, double)>& each) const {
    if (nodes_.empty()) return;
    std::array<std::int32_t, k_stack_size> stack;
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const std::int32_t index = stack[--top];
        const Node& node = nodes_[static_cast<std::size_t>(index)];
        if (node.box.squared_distance(point) >= limit * limit) continue;
        if (node.count == 0) {
            stack[top++] = node.first;
            stack[top++] = index + 1;
            continue;
        }
        for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
            const Triangle& triangle = triangles_[static_cast<std::size_t>(i)];
            const double squared = squared_distance(triangle, point);
            if (squared < limit * limit)
                each(i, {triangle.corner, triangle.corner + triangle.edge1, triangle.corner + triangle.edge2}, squared);
        }
    }
}

}  // namespace cutterflow::coupling
