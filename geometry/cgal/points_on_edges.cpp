#include "geometry/cgal/points_on_edges.hpp"

#include <algorithm>

#include <CGAL/Bbox_3.h>
#include <CGAL/box_intersection_d.h>

namespace cutterflow::geometry {
namespace {

using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;

CGAL::Bbox_3 grown_box(const Vec3& a, const Vec3& b, double by) {
    const Vec3 low = a.cwiseMin(b).array() - by;
    const Vec3 high = a.cwiseMax(b).array() + by;
    return {low.x(), low.y(), low.z(), high.x(), high.y(), high.z()};
}

}  // namespace

std::vector<std::vector<std::uint32_t>> find_points_on_edges(const std::vector<Vec3>& points,
                                                             const std::vector<std::array<std::uint32_t, 2>>& edges,
                                                             const std::vector<std::uint32_t>& candidates, double distance) {
    std::vector<Box> edge_boxes, point_boxes;
    for (std::size_t e = 0; e < edges.size(); ++e)
        edge_boxes.emplace_back(grown_box(points[edges[e][0]], points[edges[e][1]], distance), e);
    for (const std::uint32_t candidate : candidates)
        point_boxes.emplace_back(grown_box(points[candidate], points[candidate], 0.0), candidate);

    std::vector<std::vector<std::pair<double, std::uint32_t>>> found(edges.size());
    CGAL::box_intersection_d(edge_boxes.begin(), edge_boxes.end(), point_boxes.begin(), point_boxes.end(),
                             [&](const Box& edge_box, const Box& point_box) {
                                 const Vec3& start = points[edges[edge_box.info()][0]];
                                 const Vec3 edge = points[edges[edge_box.info()][1]] - start;
                                 const Vec3 arm = points[point_box.info()] - start;
                                 const double along = arm.dot(edge.normalized());
                                 if (along <= distance || along >= edge.norm() - distance) return;
                                 if ((arm - along * edge.normalized()).norm() > distance) return;
                                 found[edge_box.info()].emplace_back(along, static_cast<std::uint32_t>(point_box.info()));
                             });

    std::vector<std::vector<std::uint32_t>> result(edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
        std::sort(found[e].begin(), found[e].end());
        for (const auto& [along, point] : found[e]) result[e].push_back(point);
    }
    return result;
}

}  // namespace cutterflow::geometry
