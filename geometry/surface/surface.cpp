#include "geometry/surface/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

namespace cutterflow::geometry {

Bounds bounds_of(const TriangleSurface& surface) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Bounds bounds{Vec3::Constant(infinity), Vec3::Constant(-infinity)};
    for (const Vec3& point : surface.points) {
        bounds.min = bounds.min.cwiseMin(point);
        bounds.max = bounds.max.cwiseMax(point);
    }
    return bounds;
}

Vec3 area_vector(const TriangleSurface& surface, const Triangle& triangle) {
    const Vec3& a = surface.points[triangle[0]];
    return 0.5 * (surface.points[triangle[1]] - a).cross(surface.points[triangle[2]] - a);
}

Vec3 centroid_of(const TriangleSurface& surface, const Triangle& triangle) {
    return (surface.points[triangle[0]] + surface.points[triangle[1]] + surface.points[triangle[2]]) / 3.0;
}

double area_of(const TriangleSurface& surface) {
    double area = 0.0;
    for (const Triangle& triangle : surface.triangles) area += area_vector(surface, triangle).norm();
    return area;
}

double area_seen_along(const TriangleSurface& surface, const Vec3& direction) {
    double sum = 0.0;
    for (const Triangle& triangle : surface.triangles) sum += std::abs(area_vector(surface, triangle).dot(direction));
    return 0.5 * sum;
}

double volume_of(const TriangleSurface& surface) {
    if (surface.points.empty()) return 0.0;
    const Vec3 origin = surface.points.front();
    double volume = 0.0;
    for (const Triangle& triangle : surface.triangles)
        volume += area_vector(surface, triangle).dot(surface.points[triangle[0]] - origin) / 3.0;
    return volume;
}

MassProperties mass_properties(const TriangleSurface& surface) {
    const Bounds bounds = bounds_of(surface);
    const Vec3 origin = 0.5 * (bounds.min + bounds.max);
    double volume = 0.0;
    Vec3 first = Vec3::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    for (const Triangle& triangle : surface.triangles) {
        const Vec3 a = surface.points[triangle[0]] - origin;
        const Vec3 b = surface.points[triangle[1]] - origin;
        const Vec3 c = surface.points[triangle[2]] - origin;
        const double tetrahedron = a.dot(b.cross(c)) / 6.0;
        const Vec3 sum = a + b + c;
        volume += tetrahedron;
        first += tetrahedron / 4.0 * sum;
        second += tetrahedron / 20.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    }
    const Vec3 arm = first / volume;
    const Eigen::Matrix3d covariance = second - volume * arm * arm.transpose();
    return {volume, origin + arm, covariance.trace() * Eigen::Matrix3d::Identity() - covariance};
}

TriangleSurface transformed(const TriangleSurface& surface, const Eigen::Affine3d& transform) {
    TriangleSurface result = surface;
    for (Vec3& point : result.points) point = transform * point;
    if (transform.linear().determinant() < 0.0)
        for (Triangle& triangle : result.triangles) std::swap(triangle[1], triangle[2]);
    return result;
}

TriangleSurface joined(const std::vector<TriangleSurface>& surfaces) {
    TriangleSurface result;
    for (const TriangleSurface& surface : surfaces) {
        const auto offset = static_cast<std::uint32_t>(result.points.size());
        result.points.insert(result.points.end(), surface.points.begin(), surface.points.end());
        for (const Triangle& t : surface.triangles) result.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    }
    return result;
}

TriangleSurface welded(const TriangleSurface& surface) {
    TriangleSurface result;
    result.triangles.reserve(surface.triangles.size());
    std::map<std::tuple<double, double, double>, std::uint32_t> index_at;
    for (const Triangle& triangle : surface.triangles) {
        Triangle joined_triangle{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vec3& point = surface.points[triangle[corner]];
            const auto next = static_cast<std::uint32_t>(result.points.size());
            const auto [found, is_new] = index_at.try_emplace({point.x(), point.y(), point.z()}, next);
            if (is_new) result.points.push_back(point);
            joined_triangle[corner] = found->second;
        }
        result.triangles.push_back(joined_triangle);
    }
    return result;
}

TriangleSurface sorted(const TriangleSurface& surface) {
    std::vector<std::uint32_t> order(surface.points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&points = surface.points](std::uint32_t i, std::uint32_t j) {
        const Vec3& a = points[i];
        const Vec3& b = points[j];
        return std::make_tuple(a.x(), a.y(), a.z(), i) < std::make_tuple(b.x(), b.y(), b.z(), j);
    });
    TriangleSurface result;
    std::vector<std::uint32_t> place_of(order.size());
    for (const std::uint32_t old : order) {
        place_of[old] = static_cast<std::uint32_t>(result.points.size());
        result.points.push_back(surface.points[old]);
    }
    for (const Triangle& t : surface.triangles) {
        Triangle moved{place_of[t[0]], place_of[t[1]], place_of[t[2]]};
        std::rotate(moved.begin(), std::min_element(moved.begin(), moved.end()), moved.end());
        result.triangles.push_back(moved);
    }
    std::sort(result.triangles.begin(), result.triangles.end());
    return result;
}

}  // namespace cutterflow::geometry
