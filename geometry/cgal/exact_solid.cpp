#include "geometry/cgal/exact_solid.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>

#include "geometry/cgal/convert.hpp"

namespace cutterflow::geometry {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using ExactPoint = CGAL::Exact_predicates_exact_constructions_kernel::Point_3;
using ExactMesh = CGAL::Surface_mesh<ExactPoint>;

}  // namespace

struct ExactSolid::Impl {
    ExactMesh mesh;
};

ExactSolid::ExactSolid(const TriangleSurface& surface) : impl_(std::make_unique<Impl>()) {
    impl_->mesh = detail::to_mesh<ExactPoint>(surface);
    if (!CGAL::is_closed(impl_->mesh))
        throw CheckFailure({"", "a surface to be combined with others is open", "A solid needs a closed surface",
                            "Run \"cutterflow inspect\" on the surface to find the place"});
}

ExactSolid::~ExactSolid() = default;

// Corefinement refines both operands, so the other one is copied.
void ExactSolid::unite(const ExactSolid& other) {
    ExactMesh tool = other.impl_->mesh;
    if (!pmp::corefine_and_compute_union(impl_->mesh, tool, impl_->mesh))
        throw CheckFailure({"", "two solids cannot be united", "They must overlap or be apart, not touch along an edge or at a point only",
                            "Let them overlap"});
}

void ExactSolid::subtract(const ExactSolid& other) {
    ExactMesh tool = other.impl_->mesh;
    if (!pmp::corefine_and_compute_difference(impl_->mesh, tool, impl_->mesh))
        throw CheckFailure({"", "a solid cannot be cut out of another one",
                            "What is left may not hang together along an edge or at a point only", "Move or enlarge what is cut out"});
}

// Lazy numbers are evaluated first, because their interval is not unique. Points are sorted, because the order of the
// intersections of corefinement depends on memory addresses.
TriangleSurface ExactSolid::surface() const {
    for (const auto vertex : impl_->mesh.vertices()) CGAL::exact(impl_->mesh.point(vertex));
    return sorted(detail::to_surface(impl_->mesh));
}

}  // namespace cutterflow::geometry
