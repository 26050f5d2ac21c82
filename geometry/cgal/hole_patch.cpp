#include "geometry/cgal/hole_patch.hpp"

#include <iterator>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/utility.h>

namespace cutterflow::geometry {

std::vector<Triangle> triangulate_hole(const std::vector<Vec3>& loop) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    if (loop.size() == 3) return {{0, 1, 2}};
    std::vector<Kernel::Point_3> points;
    for (const Vec3& p : loop) points.emplace_back(p.x(), p.y(), p.z());
    std::vector<CGAL::Triple<int, int, int>> patch;
    try {
        CGAL::Polygon_mesh_processing::triangulate_hole_polyline(points, std::back_inserter(patch));
    } catch (const CGAL::Failure_exception&) {
        return {};
    }
    // CGAL gives each triangle's indices in rising order, which is the loop's own sense.
    std::vector<Triangle> triangles;
    for (const auto& t : patch)
        triangles.push_back(
            {static_cast<std::uint32_t>(t.first), static_cast<std::uint32_t>(t.second), static_cast<std::uint32_t>(t.third)});
    return triangles;
}

}  // namespace cutterflow::geometry
