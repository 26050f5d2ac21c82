#include "solver/free_surface/cut_cells/still_solids.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cutterflow::free_surface {

namespace {

constexpr double k_far = std::numeric_limits<double>::max();
constexpr double k_touching = 1e-9;  // [m]: a line in a solid's face counts as inside

double left_of(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Eigen::Vector2d& place) {
    const Eigen::Vector2d along = (to - from).normalized();
    return along.x() * (place.y() - from.y()) - along.y() * (place.x() - from.x());
}

std::vector<Interval> parts(const SolidBox& box, const Line& line) {
    for (int d = 0; d < 3; ++d) {
        if (d == line.direction) continue;
        if (line.through[d] < box.from[d] - k_touching || line.through[d] > box.to[d] + k_touching) return {};
    }
    return {{box.from[line.direction], box.to[line.direction]}};
}

std::vector<Interval> parts(const SolidPrism& prism, const Line& line) {
    const Eigen::Vector2d through(line.through.x(), line.through.z());
    const Eigen::Vector2d way = line.direction == 0   ? Eigen::Vector2d(1, 0)
                                : line.direction == 2 ? Eigen::Vector2d(0, 1)
                                                      : Eigen::Vector2d(0, 0);
    Interval part{-k_far, k_far};  // along the way, from `through`
    for (std::size_t n = 0; n < prism.corners.size(); ++n) {
        const Eigen::Vector2d& from = prism.corners[n];
        const Eigen::Vector2d& to = prism.corners[(n + 1) % prism.corners.size()];
        const double distance = left_of(from, to, through) + k_touching;
        const double growth = left_of(from, to, through + way) + k_touching - distance;
        if (std::abs(growth) < 1e-12) {
            if (distance < 0.0) return {};
        } else if (growth > 0.0) {
            part.from = std::max(part.from, -distance / growth);
        } else {
            part.to = std::min(part.to, -distance / growth);
        }
    }
    if (part.length() <= 0.0) return {};
    if (line.direction == 1) return {part};
    const double origin = line.through[line.direction];
    return {{origin + part.from, origin + part.to}};
}

std::vector<Interval> parts(const SolidCavity& cavity, const Line& line) {
    const Vec3 from_centre = line.through - cavity.centre;
    double square = 0.0;
    for (int d = 0; d < 3; ++d) {
        if (d != line.direction && (d != 1 || cavity.sphere)) square += from_centre[d] * from_centre[d];
    }
    if (!cavity.sphere && line.direction == 1) {
        if (square < cavity.radius * cavity.radius) return {};
        return {{-k_far, k_far}};
    }
    const Interval open = chord(std::sqrt(square), cavity.centre[line.direction], cavity.radius);
    return {{-k_far, open.from}, {open.to, k_far}};
}

std::vector<Interval> parts(const SolidSurface& solid, const Line& line) {
    return solid.surface->parts(line.direction, line.through);
}

std::optional<Vec3> out(const SolidBox& box, const Vec3& place) {
    double least = k_far;
    Vec3 way = place;
    for (int d = 0; d < 3; ++d) {
        const double above = place[d] - box.from[d], below = box.to[d] - place[d];
        if (above <= 0.0 || below <= 0.0) return std::nullopt;
        if (std::min(above, below) >= least) continue;
        least = std::min(above, below);
        way = place;
        way[d] = above < below ? box.from[d] : box.to[d];
    }
    return way;
}

std::optional<Vec3> out(const SolidPrism& prism, const Vec3& place) {
    const Eigen::Vector2d point(place.x(), place.z());
    double least = k_far;
    Eigen::Vector2d way = Eigen::Vector2d::Zero();
    for (std::size_t n = 0; n < prism.corners.size(); ++n) {
        const Eigen::Vector2d& from = prism.corners[n];
        const Eigen::Vector2d& to = prism.corners[(n + 1) % prism.corners.size()];
        const double depth = left_of(from, to, point);
        if (depth <= 0.0) return std::nullopt;
        if (depth >= least) continue;
        least = depth;
        const Eigen::Vector2d along = (to - from).normalized();
        way = depth * Eigen::Vector2d(along.y(), -along.x());
    }
    return place + Vec3(way.x(), 0.0, way.y());
}

std::optional<Vec3> out(const SolidCavity& cavity, const Vec3& place) {
    Vec3 from_centre = place - cavity.centre;
    if (!cavity.sphere) from_centre.y() = 0.0;
    const double distance = from_centre.norm();
    if (distance <= cavity.radius) return std::nullopt;
    return place - from_centre * (1.0 - cavity.radius / distance);
}

std::optional<Vec3> out(const SolidSurface& solid, const Vec3& place) {
    if (!solid.surface->contains(place)) return std::nullopt;
    return solid.surface->nearest(place);
}

Vec3 nearest(const SolidBox& box, const Vec3& place) {
    return place.cwiseMax(box.from).cwiseMin(box.to);
}

Vec3 nearest(const SolidPrism& prism, const Vec3& place) {
    const Eigen::Vector2d point(place.x(), place.z());
    Eigen::Vector2d best = prism.corners[0];
    for (std::size_t n = 0; n < prism.corners.size(); ++n) {
        const Eigen::Vector2d& from = prism.corners[n];
        const Eigen::Vector2d way = prism.corners[(n + 1) % prism.corners.size()] - from;
        const Eigen::Vector2d foot = from + std::clamp((point - from).dot(way) / way.squaredNorm(), 0.0, 1.0) * way;
        if ((foot - point).norm() < (best - point).norm()) best = foot;
    }
    return {best.x(), place.y(), best.y()};
}

Vec3 nearest(const SolidCavity& cavity, const Vec3& place) {
    Vec3 from_centre = place - cavity.centre;
    if (!cavity.sphere) from_centre.y() = 0.0;
    const double distance = from_centre.norm();
    const Vec3 outward = distance > 0.0 ? Vec3(from_centre / distance) : Vec3(Vec3::UnitX());
    return place + (cavity.radius - distance) * outward;
}

Vec3 nearest(const SolidSurface& solid, const Vec3& place) {
    return solid.surface->nearest(place);
}

}  // namespace

std::vector<Interval> covered_parts(const StillSolid& solid, const Line& line) {
    return std::visit([&](const auto& shape) { return parts(shape, line); }, solid);
}

std::optional<Vec3> way_out(const StillSolid& solid, const Vec3& place) {
    return std::visit([&](const auto& shape) { return out(shape, place); }, solid);
}

Vec3 nearest_on(const StillSolid& solid, const Vec3& place) {
    return std::visit([&](const auto& shape) { return nearest(shape, place); }, solid);
}

SolidPrism plate(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double thickness) {
    const Eigen::Vector2d along = (to - from).normalized();
    const Eigen::Vector2d side = thickness * Eigen::Vector2d(-along.y(), along.x());
    return {{from, to, to + side, from + side}};
}

}  // namespace cutterflow::free_surface
