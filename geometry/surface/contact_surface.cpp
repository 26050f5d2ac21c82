#include "geometry/surface/contact_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/cgal/coarsen.hpp"
#include "geometry/cgal/self_intersections.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_degree = k_pi / 180.0;
constexpr double k_wanted_angle = 15.0 * k_degree;
constexpr double k_least_angle = 1.0 * k_degree;
/// Coarsening holds its bound at samples: between them the surfaces lie farther apart, by half as much for curved heads.
constexpr std::array<double, 2> k_shares = {0.6, 0.3};
constexpr double k_measured_points_per_edge = 8.0;
constexpr std::size_t k_most_triangles = 200000;

/// Why a surface is no use; empty when it is.
std::string fault_of(const ContactSurface& candidate, const ContactSurfaceBounds& bounds) {
    if (!(candidate.deviation <= bounds.deviation))
        return fmt::format("the remeshed surface lay {:.3g} m off, where {:.3g} m are allowed", candidate.deviation, bounds.deviation);
    if (candidate.smallest_angle < k_least_angle)
        return fmt::format("the remeshed surface had an angle of {:.2g} degrees", candidate.smallest_angle / k_degree);
    if (!find_self_intersections(candidate.surface).empty()) return "the remeshed surface crossed itself";
    return "";
}

ContactSurface candidate_of(const TriangleSurface& wall, const ContactSurfaceBounds& bounds, double share) {
    ContactSurface candidate;
    candidate.surface = coarsened(wall, {share * bounds.deviation, bounds.edge_length, k_wanted_angle});
    candidate.deviation = surface_distance(wall, candidate.surface, bounds.edge_length / k_measured_points_per_edge);
    candidate.smallest_angle = smallest_angle_of(candidate.surface);
    return candidate;
}

}  // namespace

double smallest_angle_of(const TriangleSurface& surface) {
    double smallest = k_pi;
    for (const Triangle& t : surface.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 a = surface.points[t[(k + 1) % 3]] - surface.points[t[k]];
            const Vec3 b = surface.points[t[(k + 2) % 3]] - surface.points[t[k]];
            smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)));
        }
    }
    return smallest;
}

ContactSurface contact_surface(const TriangleSurface& wall, const ContactSurfaceBounds& bounds) {
    if (wall.triangles.size() > k_most_triangles)
        return {wall, 0.0, smallest_angle_of(wall),
                fmt::format("more than {} triangles are not remeshed, which would take minutes", k_most_triangles)};
    std::string fault;
    try {
        for (const double share : k_shares) {
            ContactSurface candidate = candidate_of(wall, bounds, share);
            fault = fault_of(candidate, bounds);
            if (fault.empty()) return candidate;
        }
    } catch (const CheckFailure& failure) {
        fault = failure.what();
    }
    return {wall, 0.0, smallest_angle_of(wall), fault};
}

}  // namespace cutterflow::geometry
