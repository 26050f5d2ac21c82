#pragma once
/// \file TriangleSurface to and from CGAL's Surface_mesh. Internal to geometry/cgal: the only header here that includes CGAL.
#include <CGAL/Polygon_mesh_processing/polygon_mesh_to_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>

#include "geometry/base/error.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry::detail {

inline std::vector<std::vector<std::size_t>> polygons_of(const TriangleSurface& surface) {
    std::vector<std::vector<std::size_t>> polygons;
    polygons.reserve(surface.triangles.size());
    for (const Triangle& t : surface.triangles) polygons.push_back({t[0], t[1], t[2]});
    return polygons;
}

/// \throws CheckFailure  when the triangles, with their orientation, are no 2-manifold
template <class Point>
CGAL::Surface_mesh<Point> to_mesh(const TriangleSurface& surface) {
    namespace pmp = CGAL::Polygon_mesh_processing;
    std::vector<Point> points;
    points.reserve(surface.points.size());
    for (const Vec3& p : surface.points) points.emplace_back(p.x(), p.y(), p.z());
    const auto polygons = polygons_of(surface);
    if (!pmp::is_polygon_soup_a_polygon_mesh(polygons))
        throw CheckFailure({"", "the triangles do not form a 2-manifold surface", "Every edge must join two triangles of equal orientation",
                            "Run \"cutterflow inspect\" on the surface to find the place"});
    CGAL::Surface_mesh<Point> mesh;
    pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
    return mesh;
}

template <class Point>
TriangleSurface to_surface(const CGAL::Surface_mesh<Point>& mesh) {
    TriangleSurface surface;
    std::vector<std::uint32_t> index_of(mesh.number_of_vertices() + mesh.number_of_removed_vertices());
    for (const auto vertex : mesh.vertices()) {
        const Point& p = mesh.point(vertex);
        index_of[vertex] = static_cast<std::uint32_t>(surface.points.size());
        surface.points.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
    }
    for (const auto face : mesh.faces()) {
        Triangle triangle{};
        std::size_t corner = 0;
        for (const auto vertex : vertices_around_face(mesh.halfedge(face), mesh)) triangle.at(corner++) = index_of[vertex];
        surface.triangles.push_back(triangle);
    }
    return surface;
}

}  // namespace cutterflow::geometry::detail
