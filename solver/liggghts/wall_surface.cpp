#include "solver/liggghts/wall_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <numeric>
#include <sstream>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"

namespace cutterflow::liggghts {

namespace {

constexpr std::size_t k_header_bytes = 84;
constexpr std::size_t k_facet_bytes = 50;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
    throw UserError(fmt::format("DEM wall {}: {}", file.string(), what), "A wall must be a binary or ASCII STL with triangles",
                    "Check the file of this wall in constant/couplingProperties");
}

std::string read_bytes(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) refuse(file, "cannot be read");
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

bool is_binary(const std::string& bytes) {
    if (bytes.size() < k_header_bytes) return false;
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    return bytes.size() == k_header_bytes + k_facet_bytes * static_cast<std::size_t>(count);
}

std::vector<Triangle> parse_binary(const std::string& bytes) {
    std::vector<Triangle> triangles((bytes.size() - k_header_bytes) / k_facet_bytes);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        float corners[9];
        std::memcpy(corners, bytes.data() + k_header_bytes + k_facet_bytes * t + 12, sizeof corners);
        for (int k = 0; k < 3; ++k) triangles[t][k] = Eigen::Map<const Eigen::Vector3f>(corners + 3 * k).cast<double>();
    }
    return triangles;
}

std::vector<Triangle> parse_ascii(const std::string& text, const std::filesystem::path& file) {
    std::istringstream stream(text);
    std::vector<Vec3> corners;
    for (std::string word; stream >> word;) {
        if (word != "vertex") continue;
        Vec3 corner;
        if (!(stream >> corner.x() >> corner.y() >> corner.z())) refuse(file, "has a vertex without three numbers");
        corners.push_back(corner);
    }
    if (corners.size() % 3 != 0) refuse(file, "ends within a triangle");
    std::vector<Triangle> triangles(corners.size() / 3);
    for (std::size_t k = 0; k < corners.size(); ++k) triangles[k / 3][k % 3] = corners[k];
    return triangles;
}

/// Solid angle of a triangle seen from the origin (van Oosterom & Strackee).
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la);
}

std::vector<coupling::SteelTriangle> as_steel(const std::vector<Triangle>& triangles) {
    std::vector<coupling::SteelTriangle> steel;
    for (const Triangle& t : triangles) steel.push_back({t[0], t[1], t[2]});
    return steel;
}

Vec3 closest_on_segment(const Vec3& a, const Vec3& b, const Vec3& point) {
    const Vec3 along = b - a;
    const double length2 = along.squaredNorm();
    const double s = length2 > 0.0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
    return a + s * along;
}

bool is_whole(double turns) {
    constexpr double tolerance = 1e-6;
    return std::fabs(turns - std::round(turns)) < tolerance;
}

}  // namespace

std::vector<Triangle> read_stl(const std::filesystem::path& file) {
    const std::string bytes = read_bytes(file);
    std::vector<Triangle> triangles = is_binary(bytes) ? parse_binary(bytes) : parse_ascii(bytes, file);
    if (triangles.empty()) refuse(file, "has no triangle");
    return triangles;
}

Vec3 nearest_point(const Triangle& triangle, const Vec3& point) {
    const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    const double area2 = normal.squaredNorm();
    bool above = area2 > 0.0;
    for (int k = 0; k < 3; ++k) above = above && normal.dot((triangle[(k + 1) % 3] - triangle[k]).cross(point - triangle[k])) >= 0.0;
    if (above) return point - normal * (normal.dot(point - triangle[0]) / area2);
    Vec3 nearest = closest_on_segment(triangle[0], triangle[1], point);
    for (int k = 1; k < 3; ++k) {
        const Vec3 on_edge = closest_on_segment(triangle[k], triangle[(k + 1) % 3], point);
        if ((point - on_edge).squaredNorm() < (point - nearest).squaredNorm()) nearest = on_edge;
    }
    return nearest;
}

WallSurface::WallSurface(std::vector<Triangle> triangles)
    : triangles_(std::move(triangles)), tree_(as_steel(triangles_)), low_(triangles_.at(0)[0]), high_(triangles_.at(0)[0]) {
    for (const Triangle& t : triangles_) {
        for (const Vec3& corner : t) {
            low_ = low_.cwiseMin(corner);
            high_ = high_.cwiseMax(corner);
        }
    }
}

NearTriangles WallSurface::near(const Vec3& point, double distance) const {
    NearTriangles found;
    tree_.each_within(point, distance, [&](std::int32_t number, const coupling::SteelTriangle& t, double) {
        found.triangles.push_back({t.a, t.b, t.c});
        found.numbers.push_back(tree_.given(number));
    });
    return found;
}

double WallSurface::winding_number(const Vec3& point) const {
    if ((point.array() < low_.array()).any() || (point.array() > high_.array()).any()) return 0.0;
    double angle = 0.0;
    for (const Triangle& t : triangles_) angle += solid_angle(t[0] - point, t[1] - point, t[2] - point);
    return angle / (4.0 * k_pi);
}

bool is_inside(double turns) {
    return std::fabs(turns) > 0.5 && is_whole(turns);
}

bool is_inside(const std::vector<double>& turns) {
    const double sum = std::accumulate(turns.begin(), turns.end(), 0.0);
    if (is_whole(sum)) return is_inside(sum);
    return std::any_of(turns.begin(), turns.end(), [](double each) { return is_inside(each); });
}

}  // namespace cutterflow::liggghts
