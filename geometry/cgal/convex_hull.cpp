#include "geometry/cgal/convex_hull.hpp"

#include <iterator>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/convex_hull_2.h>
#include <CGAL/convex_hull_3.h>

#include "geometry/cgal/convert.hpp"

namespace cutterflow::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

}  // namespace

PlanarLoop convex_hull(const std::vector<Eigen::Vector2d>& points) {
    std::vector<Kernel::Point_2> given, corners;
    given.reserve(points.size());
    for (const Eigen::Vector2d& p : points) given.emplace_back(p.x(), p.y());
    CGAL::convex_hull_2(given.begin(), given.end(), std::back_inserter(corners));
    PlanarLoop hull;
    for (const Kernel::Point_2& p : corners) hull.emplace_back(p.x(), p.y());
    return hull;
}

TriangleSurface convex_hull(const std::vector<Vec3>& points) {
    std::vector<Kernel::Point_3> given;
    given.reserve(points.size());
    for (const Vec3& p : points) given.emplace_back(p.x(), p.y(), p.z());
    CGAL::Surface_mesh<Kernel::Point_3> mesh;
    CGAL::convex_hull_3(given.begin(), given.end(), mesh);
    return sorted(detail::to_surface(mesh));
}

}  // namespace cutterflow::geometry
