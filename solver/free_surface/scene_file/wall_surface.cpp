#include <fmt/format.h>

#include "solver/free_surface/scene_file/scene_file.hpp"

namespace cutterflow::free_surface {

namespace {

/// Corners of a solid in x and z, counter-clockwise seen against y, and its part of the tank's depth.
struct Extruded {
    std::vector<Eigen::Vector2d> corners;
    Interval across;
};

/// Of a prism or a box; none of other solids.
std::optional<Extruded> extruded(const StillSolid& solid, double depth) {
    const Interval tank{0.0, depth};
    if (const auto* prism = std::get_if<SolidPrism>(&solid)) return Extruded{prism->corners, tank};
    const auto* box = std::get_if<SolidBox>(&solid);
    if (!box) return {};
    return Extruded{
        {{box->from.x(), box->from.z()}, {box->to.x(), box->from.z()}, {box->to.x(), box->to.z()}, {box->from.x(), box->to.z()}},
        common({box->from.y(), box->to.y()}, tank)};
}

std::string facet(const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto vertex = [](const Vec3& v) { return fmt::format("vertex {:.17g} {:.17g} {:.17g}\n", v.x(), v.y(), v.z()); };
    return "facet normal 0 0 0\nouter loop\n" + vertex(a) + vertex(b) + vertex(c) + "endloop\nendfacet\n";
}

std::string facets_of(const Extruded& solid) {
    const auto at = [&solid](std::size_t n, double y) {
        const Eigen::Vector2d& corner = solid.corners[n % solid.corners.size()];
        return Vec3(corner.x(), y, corner.y());
    };
    const double near = solid.across.from, far = solid.across.to;
    const std::size_t corners = solid.corners.size();
    std::string facets;
    for (std::size_t n = 0; n < corners; ++n)
        facets += facet(at(n, near), at(n, far), at(n + 1, far)) + facet(at(n, near), at(n + 1, far), at(n + 1, near));
    for (std::size_t n = 1; n + 1 < corners; ++n)
        facets += facet(at(0, near), at(n, near), at(n + 1, near)) + facet(at(0, far), at(n + 1, far), at(n, far));
    return facets;
}

std::string facets_of(const geometry::TriangleSurface& surface) {
    std::string facets;
    for (const geometry::Triangle& triangle : surface.triangles)
        facets += facet(surface.points[triangle[0]], surface.points[triangle[1]], surface.points[triangle[2]]);
    return facets;
}

}  // namespace

std::string wall_surface_stl(const std::vector<StillSolid>& solids, double depth) {
    std::string facets;
    for (const StillSolid& solid : solids) {
        if (const auto* closed = std::get_if<SolidSurface>(&solid)) facets += facets_of(closed->surface->surface());
        if (const auto shape = extruded(solid, depth)) facets += facets_of(*shape);
    }
    return facets.empty() ? facets : "solid walls\n" + facets + "endsolid walls\n";
}

}  // namespace cutterflow::free_surface
