#include "geometry/clump/clump.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/clump/disc_union.hpp"
#include "geometry/clump/gauss.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_on_surface = 1e-9;  // of a radius: what lies deeper in a ball is hidden
constexpr int k_directions = 2000;     // over half a sphere: 3 degrees apart
constexpr double k_same_area = 1e-12;
constexpr double k_first_turn = 0.03, k_last_turn = 1e-6;  // [rad]

bool overlap(const Ball& a, const Ball& b) {
    return (a.centre - b.centre).norm() < a.radius + b.radius;
}

/// For each ball the number of the connected part that it belongs to.
std::vector<std::size_t> parts_of(const std::vector<Ball>& balls) {
    std::vector<std::size_t> part(balls.size());
    std::iota(part.begin(), part.end(), std::size_t{0});
    for (std::size_t i = 0; i < balls.size(); ++i)
        for (std::size_t j = i + 1; j < balls.size(); ++j)
            if (overlap(balls[i], balls[j])) std::replace(part.begin(), part.end(), std::size_t(part[j]), std::size_t(part[i]));
    return part;
}

bool hidden(const std::vector<Ball>& balls, const Vec3& point) {
    return std::any_of(balls.begin(), balls.end(),
                       [&](const Ball& ball) { return (point - ball.centre).norm() < (1.0 - k_on_surface) * ball.radius; });
}

/// Where the surfaces of two balls meet.
struct Circle {
    Vec3 centre = Vec3::Zero(), normal = Vec3::Zero();
    double radius = 0.0;  ///< 0: they do not meet
};

Circle meeting_circle(const Ball& a, const Ball& b) {
    const Vec3 way = b.centre - a.centre;
    const double distance = way.norm();
    if (distance >= a.radius + b.radius || distance <= std::abs(a.radius - b.radius)) return {};
    const double along = (distance * distance + a.radius * a.radius - b.radius * b.radius) / (2.0 * distance);
    return {a.centre + along / distance * way, way / distance, std::sqrt(std::max(0.0, a.radius * a.radius - along * along))};
}

/// The points of the circle on the ball's surface: none or two.
std::vector<Vec3> points_on(const Circle& circle, const Ball& ball) {
    const Vec3 e1 = circle.normal.unitOrthogonal(), e2 = circle.normal.cross(e1), way = circle.centre - ball.centre;
    const double a = 2.0 * circle.radius * way.dot(e1), b = 2.0 * circle.radius * way.dot(e2);
    const double c = ball.radius * ball.radius - way.squaredNorm() - circle.radius * circle.radius, size = std::hypot(a, b);
    if (std::abs(c) >= size) return {};
    std::vector<Vec3> points;
    for (const double side : {-1.0, 1.0}) {
        const double angle = std::atan2(b, a) + side * std::acos(c / size);
        points.emplace_back(circle.centre + circle.radius * (std::cos(angle) * e1 + std::sin(angle) * e2));
    }
    return points;
}

/// Points of the union's surface at whose heights the boundary of its cross-section gains or loses pieces: poles of the balls, lowest and
/// highest points of the circles in which two meet, points in which three meet.
std::vector<Vec3> turning_points(const std::vector<Ball>& balls) {
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        points.emplace_back(balls[i].centre - balls[i].radius * Vec3::UnitZ());
        points.emplace_back(balls[i].centre + balls[i].radius * Vec3::UnitZ());
        for (std::size_t j = i + 1; j < balls.size(); ++j) {
            const Circle circle = meeting_circle(balls[i], balls[j]);
            if (circle.radius <= 0.0) continue;
            const Vec3 up = Vec3::UnitZ() - circle.normal.z() * circle.normal;
            if (up.norm() > 0.0) {
                points.emplace_back(circle.centre - circle.radius * up.normalized());
                points.emplace_back(circle.centre + circle.radius * up.normalized());
            }
            for (std::size_t k = j + 1; k < balls.size(); ++k)
                for (const Vec3& point : points_on(circle, balls[k])) points.push_back(point);
        }
    }
    points.erase(std::remove_if(points.begin(), points.end(), [&](const Vec3& point) { return hidden(balls, point); }), points.end());
    return points;
}

/// [m], ascending.
std::vector<double> turning_heights(const std::vector<Ball>& balls) {
    std::vector<double> heights;
    for (const Vec3& point : turning_points(balls)) heights.push_back(point.z());
    std::sort(heights.begin(), heights.end());
    return heights;
}

PlaneMoments cross_section(const std::vector<Ball>& balls, double z) {
    std::vector<Disc> discs;
    for (const Ball& ball : balls) {
        const double depth = z - ball.centre.z(), square = ball.radius * ball.radius - depth * depth;
        if (square > 0.0) discs.push_back({ball.centre.head<2>(), std::sqrt(square)});
    }
    return union_moments(discs);
}

/// Integrals over space, about the origin.
struct SpaceMoments {
    double volume = 0.0;
    Vec3 first = Vec3::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

    void add(const PlaneMoments& section, double z, double weight) {
        volume += weight * section.area;
        first += weight * Vec3(section.first.x(), section.first.y(), z * section.area);
        second.topLeftCorner<2, 2>() += weight * section.second;
        second.topRightCorner<2, 1>() += weight * z * section.first;
        second.bottomLeftCorner<1, 2>() += weight * z * section.first.transpose();
        second(2, 2) += weight * z * z * section.area;
    }
};

SpaceMoments union_moments_in_space(const std::vector<Ball>& balls) {
    const std::vector<double> heights = turning_heights(balls);
    SpaceMoments sum;
    for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
        const double middle = 0.5 * (heights[k] + heights[k + 1]), half = 0.5 * (heights[k + 1] - heights[k]);
        if (half <= 0.0) continue;
        const auto add_section = [&](double angle, double weight) {
            const double z = middle + half * std::sin(angle);
            sum.add(cross_section(balls, z), z, weight * half * std::cos(angle));
        };
        at_gauss_points(-0.5 * k_pi, 0.0, add_section);
        at_gauss_points(0.0, 0.5 * k_pi, add_section);
    }
    return sum;
}

/// The largest shadow (sign 1) or the smallest (sign -1) [m2]: the best of an even set of directions, then steps aside that shrink.
double extreme_shadow(const Clump& clump, double sign) {
    Vec3 best = Vec3::UnitZ();
    double area = shadow_area(clump, best);
    const auto take_if_better = [&](const Vec3& direction) {
        const double other = shadow_area(clump, direction);
        if (sign * (other - area) <= k_same_area * area) return false;
        area = other;
        best = direction;
        return true;
    };
    for (int k = 0; k < k_directions; ++k) {
        const double z = (k + 0.5) / k_directions, azimuth = k_pi * (3.0 - std::sqrt(5.0)) * k, across = std::sqrt(1.0 - z * z);
        take_if_better(Vec3(across * std::cos(azimuth), across * std::sin(azimuth), z));
    }
    for (double turn = k_first_turn; turn > k_last_turn;) {
        const Vec3 e1 = best.unitOrthogonal(), e2 = best.cross(e1), from = best;
        bool moved = false;
        for (const Vec3& aside : {e1, Vec3(-e1), e2, Vec3(-e2)}) moved = take_if_better((from + turn * aside).normalized()) || moved;
        if (!moved) turn *= 0.5;
    }
    return area;
}

}  // namespace

std::vector<Mistake> clump_mistakes(const Clump& clump) {
    Mistakes mistakes;
    mistakes.require(!clump.balls.empty(), "the clump has no sphere", "A clump is made of one sphere or more", "Add spheres");
    for (std::size_t i = 0; i < clump.balls.size(); ++i) {
        mistakes.positive(fmt::format("radius of sphere {} [m]", i + 1), clump.balls[i].radius);
        mistakes.require(clump.balls[i].centre.allFinite(), fmt::format("the centre of sphere {} is not finite", i + 1),
                         "Coordinates are finite numbers", "Correct them");
    }
    if (!mistakes.empty()) return mistakes.take();
    for (std::size_t i = 0; i < clump.balls.size(); ++i)
        for (std::size_t j = 0; j < clump.balls.size(); ++j) {
            const Ball &inner = clump.balls[i], &outer = clump.balls[j];
            const double spare = outer.radius - inner.radius - (outer.centre - inner.centre).norm();
            if (i != j && (spare > 0.0 || (spare == 0.0 && j < i)))
                mistakes.add(fmt::format("sphere {} lies within sphere {}", i + 1, j + 1), "Each sphere adds to the rock", "Remove it");
        }
    const std::vector<std::size_t> part = parts_of(clump.balls);
    for (std::size_t i = 1; i < part.size(); ++i)
        mistakes.require(part[i] == part[0], fmt::format("sphere {} is not joined to sphere 1", i + 1),
                         "The spheres of a clump overlap, so that it is one rock", "Move it or make it larger, or add one between");
    return mistakes.take();
}

MassProperties union_mass_properties(const Clump& clump) {
    const Vec3 origin = clump.balls.front().centre;
    std::vector<Ball> balls = clump.balls;
    for (Ball& ball : balls) ball.centre -= origin;
    const SpaceMoments sum = union_moments_in_space(balls);
    const Vec3 arm = sum.first / sum.volume;
    const Eigen::Matrix3d covariance = sum.second - sum.volume * arm * arm.transpose();
    return {sum.volume, origin + arm, covariance.trace() * Eigen::Matrix3d::Identity() - covariance};
}

double shadow_area(const Clump& clump, const Vec3& direction) {
    const Vec3 e1 = direction.unitOrthogonal(), e2 = direction.cross(e1);
    std::vector<Disc> discs;
    for (const Ball& ball : clump.balls) {
        const Vec3 from_first = ball.centre - clump.balls.front().centre;
        discs.push_back({{from_first.dot(e1), from_first.dot(e2)}, ball.radius});
    }
    return union_moments(discs).area;
}

ShadowAreas extreme_shadows(const Clump& clump) {
    return {extreme_shadow(clump, -1.0), extreme_shadow(clump, 1.0)};
}

PrincipalInertia principal_inertia(const MassProperties& mass) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(mass.inertia);
    PrincipalInertia principal{solver.eigenvalues(), solver.eigenvectors()};
    if (principal.axes.determinant() < 0.0) principal.axes.col(2) *= -1.0;
    return principal;
}

ClumpProperties clump_properties(const Clump& clump) {
    const MassProperties mass = union_mass_properties(clump);
    const PrincipalInertia principal = principal_inertia(mass);
    ClumpProperties properties;
    properties.volume = mass.volume;
    properties.equivalent_diameter = std::cbrt(6.0 * mass.volume / k_pi);
    properties.centroid = mass.centroid;
    properties.principal_moments = principal.moments;
    properties.axes = principal.axes;
    properties.shadow = extreme_shadows(clump);
    return properties;
}

}  // namespace cutterflow::geometry
