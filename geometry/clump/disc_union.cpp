#include "geometry/clump/disc_union.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/base/axis_frame.hpp"
#include "geometry/clump/gauss.hpp"

namespace cutterflow::geometry {
namespace {

using Arc = std::pair<double, double>;  // angles [rad], the first below the second

/// Whether the circle of `disc` lies wholly in `other`; of two equal discs the later one is the covered one.
bool covers(const Disc& other, const Disc& disc, bool other_is_before) {
    const double distance = (other.centre - disc.centre).norm(), spare = other.radius - disc.radius - distance;
    const bool equal = distance == 0.0 && other.radius == disc.radius;
    return equal ? other_is_before : spare >= 0.0;
}

/// The part of the circle of `disc` in `other`; none unless the circles cross.
std::optional<Arc> arc_inside(const Disc& other, const Disc& disc) {
    const Eigen::Vector2d way = other.centre - disc.centre;
    const double distance = way.norm();
    if (distance >= disc.radius + other.radius || distance + other.radius <= disc.radius) return std::nullopt;
    const double cosine = (distance * distance + disc.radius * disc.radius - other.radius * other.radius) / (2.0 * distance * disc.radius);
    const double middle = std::atan2(way.y(), way.x()), half = std::acos(std::clamp(cosine, -1.0, 1.0));
    return Arc{middle - half, middle + half};
}

/// The parts of disc `i`'s circle that lie in no other disc.
std::vector<Arc> exposed_arcs(const std::vector<Disc>& discs, std::size_t i) {
    std::vector<Arc> hidden;
    for (std::size_t j = 0; j < discs.size(); ++j) {
        if (j == i || discs[j].radius <= 0.0) continue;
        if (covers(discs[j], discs[i], j < i)) return {};
        const std::optional<Arc> inside = arc_inside(discs[j], discs[i]);
        if (!inside) continue;
        const double turns = 2.0 * k_pi * std::floor(inside->first / (2.0 * k_pi));
        hidden.emplace_back(inside->first - turns, std::min(inside->second - turns, 2.0 * k_pi));
        if (inside->second - turns > 2.0 * k_pi) hidden.emplace_back(0.0, inside->second - turns - 2.0 * k_pi);
    }
    std::sort(hidden.begin(), hidden.end());
    std::vector<Arc> exposed;
    double from = 0.0;
    for (const Arc& arc : hidden) {
        if (arc.first > from) exposed.emplace_back(from, arc.first);
        from = std::max(from, arc.second);
    }
    if (from < 2.0 * k_pi) exposed.emplace_back(from, 2.0 * k_pi);
    return exposed;
}

void add_arc(const Disc& disc, const Arc& arc, PlaneMoments& sum) {
    at_gauss_points(arc.first, arc.second, [&](double angle, double weight) {
        const Eigen::Vector2d outward(std::cos(angle), std::sin(angle));
        const Eigen::Vector2d x = disc.centre + disc.radius * outward;
        const double flux = weight * disc.radius * x.dot(outward);
        sum.area += flux / 2.0;
        sum.first += flux / 3.0 * x;
        sum.second += flux / 4.0 * x * x.transpose();
    });
}

}  // namespace

PlaneMoments union_moments(const std::vector<Disc>& discs) {
    PlaneMoments sum;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        if (discs[i].radius <= 0.0) continue;
        for (const Arc& arc : exposed_arcs(discs, i)) add_arc(discs[i], arc, sum);
    }
    return sum;
}

}  // namespace cutterflow::geometry
