#include "geometry/cgal/solid_search.hpp"

#include <cmath>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>

#include "geometry/cgal/convert.hpp"

namespace cutterflow::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Mesh>>>;

Kernel::Point_3 to_cgal(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

}  // namespace

struct SolidSearch::Impl {
    explicit Impl(const TriangleSurface& surface)
        : mesh(detail::to_mesh<Kernel::Point_3>(surface)), tree(faces(mesh).first, faces(mesh).second, mesh), side(tree) {
        tree.accelerate_distance_queries();
    }
    Mesh mesh;
    Tree tree;
    CGAL::Side_of_triangle_mesh<Mesh, Kernel> side;
};

SolidSearch::SolidSearch(const TriangleSurface& surface) : impl_(std::make_unique<Impl>(surface)) {}
SolidSearch::SolidSearch(SolidSearch&&) noexcept = default;
SolidSearch::~SolidSearch() = default;

NearestPoint SolidSearch::nearest(const Vec3& point) const {
    const auto [at, face] = impl_->tree.closest_point_and_primitive(to_cgal(point));
    const Vec3 found(at.x(), at.y(), at.z());
    return {found, face.idx(), (found - point).norm()};
}

bool SolidSearch::contains(const Vec3& point) const {
    return impl_->side(to_cgal(point)) != CGAL::ON_UNBOUNDED_SIDE;
}

}  // namespace cutterflow::geometry
