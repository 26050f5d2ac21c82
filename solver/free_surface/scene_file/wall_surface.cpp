#include <fmt/format.h>

#include "solver/free_surface/scene_file/scene_file.hpp"

namespace cutterflow::free_surface {

namespace {

/// Corners of a solid in x and z, counter-clockwise seen against y, and its part of the tank's depth.
struct Extruded {
    std::vector<Eigen::Vector2d> corners;
    Interval across;
};

/// None for a solid that has a surface of its own.
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

}  // namespace

std::string wall_surface_stl(const std::vector<StillSolid>& solids, double depth) {
    std::string facets;
    for (const StillSolid& solid : solids) {
        const auto shape = extruded(solid, depth);
        if (!shape) continue;
        const auto& [corners, across] = *shape;
        const auto at = [&corners = corners](std::size_t n, double y) {
            const Eigen::Vector2d& corner = corners[n % corners.size()];
            return Vec3(corner.x(), y, corner.y());
        };
        const double near = across.from, far = across.to;
        for (std::size_t n = 0; n < corners.size(); ++n) {
            facets += facet(at(n, near), at(n, far), at(n + 1, far)) + facet(at(n, near), at(n + 1, far), at(n + 1, near));
        }
        for (std::size_t n = 1; n + 1 < corners.size(); ++n) {
            facets += facet(at(0, near), at(n, near), at(n + 1, near)) + facet(at(0, far), at(n + 1, far), at(n, far));
        }
    }
    return facets.empty() ? facets : "solid walls\n" + facets + "endsolid walls\n";
}

}  // namespace cutterflow::free_surface
