#include "geometry/cgal/self_intersections.hpp"

#include <algorithm>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

namespace cutterflow::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;

class PairTest {
public:
    explicit PairTest(const TriangleSurface& surface) : surface_(surface) {}

    bool is_degenerate(std::size_t i) const { return triangle(i).is_degenerate(); }

    bool intersect(std::size_t i, std::size_t j) const {
        std::array<Triangle, 2> ordered{surface_.triangles[i], surface_.triangles[j]};
        switch (bring_shared_forward(ordered[0], ordered[1])) {
            case 0:
                return CGAL::do_intersect(triangle(i), triangle(j));
            case 1:
                return opposite_crosses(ordered[0], j) || opposite_crosses(ordered[1], i);
            case 2:
                return folded(ordered[0], ordered[1]);
            default:
                return false;
        }
    }

    Kernel::Triangle_3 triangle(std::size_t i) const {
        const Triangle& t = surface_.triangles[i];
        return {point(t[0]), point(t[1]), point(t[2])};
    }

private:
    Kernel::Point_3 point(std::uint32_t index) const {
        const Vec3& p = surface_.points[index];
        return {p.x(), p.y(), p.z()};
    }

    /// Moves the points that both triangles have to the front, in like order; returns how many.
    static int bring_shared_forward(Triangle& a, Triangle& b) {
        int shared = 0;
        for (int i = 0; i < 3; ++i) {
            const auto found = std::find(b.begin() + shared, b.end(), a[i]);
            if (found == b.end()) continue;
            std::swap(b[shared], *found);
            std::swap(a[shared], a[i]);
            ++shared;
        }
        return shared;
    }

    /// One point shared, in front: does the side opposite to it meet the other triangle?
    bool opposite_crosses(const Triangle& ordered, std::size_t other) const {
        return CGAL::do_intersect(Kernel::Segment_3(point(ordered[1]), point(ordered[2])), triangle(other));
    }

    /// Two points shared, in front: do the triangles lie on each other?
    bool folded(const Triangle& a, const Triangle& b) const {
        return CGAL::coplanar(point(a[0]), point(a[1]), point(a[2]), point(b[2])) &&
               CGAL::coplanar_orientation(point(a[0]), point(a[1]), point(a[2]), point(b[2])) == CGAL::POSITIVE;
    }

    const TriangleSurface& surface_;
};

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> find_self_intersections(const TriangleSurface& surface) {
    const PairTest test(surface);
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < surface.triangles.size(); ++i)
        if (!test.is_degenerate(i)) boxes.emplace_back(test.triangle(i).bbox(), i);
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
        if (test.intersect(a.info(), b.info())) pairs.push_back(std::minmax(a.info(), b.info()));
    });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace cutterflow::geometry
