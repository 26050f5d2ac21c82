#include "geometry/cgal/planar_region.hpp"

#include <queue>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace cutterflow::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
constexpr int k_unvisited = -1;
/// How many loops one crosses from infinity to the face.
struct Depth {
    int loops = k_unvisited;
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase = CGAL::Triangulation_face_base_with_info_2<Depth, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;
using Face = Triangulation::Face_handle;

void insert(Triangulation& triangulation, const PlanarLoop& loop, std::uint32_t first_index) {
    std::vector<Triangulation::Vertex_handle> corners;
    for (const Eigen::Vector2d& p : loop) {
        corners.push_back(triangulation.insert(Kernel::Point_2(p.x(), p.y())));
        corners.back()->info() = first_index + static_cast<std::uint32_t>(corners.size() - 1);
    }
    for (std::size_t k = 0; k < corners.size(); ++k) triangulation.insert_constraint(corners[k], corners[(k + 1) % corners.size()]);
}

/// From the outside in, one more at each constrained edge.
void mark_depths(Triangulation& triangulation) {
    std::queue<Face> open;
    triangulation.infinite_face()->info().loops = 0;
    open.push(triangulation.infinite_face());
    std::queue<Face> inner;
    while (!open.empty()) {
        const Face face = open.front();
        open.pop();
        for (int i = 0; i < 3; ++i) {
            const Face neighbour = face->neighbor(i);
            if (neighbour->info().loops != k_unvisited) continue;
            const bool crosses = triangulation.is_constrained({face, i});
            if (crosses) {
                inner.push(face);
                continue;
            }
            neighbour->info().loops = face->info().loops;
            open.push(neighbour);
        }
        if (!open.empty()) continue;
        // This depth is complete: step over the loops around it.
        for (; !inner.empty(); inner.pop())
            for (int i = 0; i < 3; ++i) {
                const Face neighbour = inner.front()->neighbor(i);
                if (neighbour->info().loops != k_unvisited) continue;
                neighbour->info().loops = inner.front()->info().loops + 1;
                open.push(neighbour);
            }
    }
}

}  // namespace

std::vector<Triangle> triangulate_region(const std::vector<PlanarLoop>& loops) {
    Triangulation triangulation;
    std::uint32_t first_index = 0;
    for (const PlanarLoop& loop : loops) {
        insert(triangulation, loop, first_index);
        first_index += static_cast<std::uint32_t>(loop.size());
    }
    mark_depths(triangulation);
    std::vector<Triangle> triangles;
    for (const Face face : triangulation.finite_face_handles())
        if (face->info().loops % 2 == 1) triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    return triangles;
}

}  // namespace cutterflow::geometry
