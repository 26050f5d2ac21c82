#include "geometry/head/contour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace cutterflow::geometry {
namespace {

double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d ab = b - a;
    const double length2 = ab.squaredNorm();
    const double t = length2 > 0.0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
    return (p - (a + t * ab)).norm();
}

}  // namespace

Contour::Contour(std::vector<double> z, std::vector<double> radius, double ring_radius, double z_backplate)
    : z_(std::move(z)), radius_(std::move(radius)), ring_radius_(ring_radius), z_backplate_(z_backplate) {
    if (z_.size() < 2 || z_.size() != radius_.size()) throw std::invalid_argument("a contour needs two or more nodes, z and radius alike");
    if (std::adjacent_find(z_.begin(), z_.end(), [](double a, double b) { return !(a < b); }) != z_.end())
        throw std::invalid_argument("a contour's axial coordinates must increase");
    if (std::any_of(radius_.begin(), radius_.end(), [](double r) { return !(r >= 0.0); }))
        throw std::invalid_argument("a contour's radii must not be negative");
    if (!(ring_radius_ > 0.0)) throw std::invalid_argument("the ring radius must be positive");
    if (!(z_backplate_ >= 0.0)) throw std::invalid_argument("the backplate must not lie below the ring plane");

    outline_.emplace_back(0.0, z_.front());
    for (std::size_t i = 0; i < z_.size() && z_[i] < z_ring(); ++i) outline_.emplace_back(radius_[i], z_[i]);
    outline_.emplace_back(std::max(ring_radius_, radius_at(-0.0)), z_ring());
    outline_.emplace_back(ring_radius_, z_backplate_);
    outline_.emplace_back(0.0, z_backplate_);
}

double Contour::radius_at(double z) const {
    if (z > z_ring()) return ring_radius_;
    if (z <= z_.front()) return radius_.front();
    if (z >= z_.back()) return radius_.back();
    const auto above = std::upper_bound(z_.begin(), z_.end(), z);
    const auto i = static_cast<std::size_t>(above - z_.begin());
    const double t = (z - z_[i - 1]) / (z_[i] - z_[i - 1]);
    return radius_[i - 1] + t * (radius_[i] - radius_[i - 1]);
}

double Contour::signed_distance(double r, double z) const {
    const Eigen::Vector2d p(r, z);
    double nearest = std::numeric_limits<double>::infinity();
    // The last edge, along the axis, is no boundary of the solid of revolution.
    for (std::size_t i = 0; i + 1 < outline_.size(); ++i) nearest = std::min(nearest, distance_to_segment(p, outline_[i], outline_[i + 1]));
    const bool inside = z >= z_hub() && z <= z_backplate_ && r <= radius_at(z);
    return inside ? -nearest : nearest;
}

}  // namespace cutterflow::geometry
