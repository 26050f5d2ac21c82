#include "solver/space/shadow_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cutterflow::coupling {
namespace {

/// Rounding of angles [rad] and of squared distances: a sight line counts the edges of triangles.
constexpr double k_angle_slack = 1e-5;
constexpr double k_distance_slack = 1e-5;

/// Angle between the middle of a side of the cube and its corners, a little wider.
const double k_side_angle = std::acos(1.0 / std::sqrt(3.0)) + k_angle_slack;
const double k_side_cosine = std::cos(k_side_angle), k_side_sine = std::sin(k_side_angle);

/// Direction of a place on the side `axis` (0, 1, 2) of the cube, towards positive or negative coordinates; u and v in -1 to 1.
Vec3 on_cube(std::size_t axis, bool negative, double u, double v) {
    Vec3 direction;
    direction[static_cast<Eigen::Index>(axis)] = negative ? -1.0 : 1.0;
    direction[static_cast<Eigen::Index>((axis + 1) % 3)] = u;
    direction[static_cast<Eigen::Index>((axis + 2) % 3)] = v;
    return direction.normalized();
}

}  // namespace

const std::array<ShadowMap::Cap, ShadowMap::k_bins>& ShadowMap::caps() {
    static const std::array<Cap, k_bins> all = [] {
        std::array<Cap, k_bins> result;
        constexpr double width = 2.0 / k_bins_per_edge;
        for (std::size_t bin = 0; bin < k_bins; ++bin) {
            const std::size_t side = bin / k_bins_per_side, place = bin % k_bins_per_side;
            const double u = -1.0 + width * static_cast<double>(place / k_bins_per_edge);
            const double v = -1.0 + width * static_cast<double>(place % k_bins_per_edge);
            const auto direction = [&](double du, double dv) { return on_cube(side / 2, side % 2 == 1, u + du * width, v + dv * width); };
            Cap& cap = result[bin];
            cap.centre = direction(0.5, 0.5);
            double cosine = 1.0;
            for (const double du : {0.0, 1.0})
                for (const double dv : {0.0, 1.0}) cosine = std::min(cosine, cap.centre.dot(direction(du, dv)));
            const double angle = std::acos(cosine) + k_angle_slack;
            cap.cosine = std::cos(angle);
            cap.sine = std::sin(angle);
        }
        return result;
    }();
    return all;
}

std::size_t ShadowMap::bin_of(const Vec3& direction) {
    Eigen::Index axis = 0;
    const double largest = direction.cwiseAbs().maxCoeff(&axis);
    const auto index = [largest](double value) {
        const double place = 0.5 * (value / largest + 1.0) * k_bins_per_edge;
        return std::min(static_cast<std::size_t>(place), k_bins_per_edge - 1);
    };
    const std::size_t side = 2 * static_cast<std::size_t>(axis) + (direction[axis] < 0.0 ? 1 : 0);
    return (side * k_bins_per_edge + index(direction[(axis + 1) % 3])) * k_bins_per_edge + index(direction[(axis + 2) % 3]);
}

ShadowMap::ShadowMap(const SteelTree& steel, const Vec3& point, double reach)
    : squared_distance_(k_bins, std::numeric_limits<float>::infinity()) {
    steel.each_within(point, reach, [&](const SteelTriangle& triangle, double squared_distance) {
        const auto bound = static_cast<float>(squared_distance * (1.0 - k_distance_slack));
        const Vec3 towards = ((triangle.a + triangle.b + triangle.c) / 3.0 - point).normalized();
        double cosine = 1.0;
        for (const Vec3& corner : {triangle.a, triangle.b, triangle.c})
            cosine = std::min(cosine, towards.dot((corner - point).normalized()));
        // Caps of less than a half sphere are convex: the triangle is in the cap of its corners. A wider one, or a point on a corner,
        // shades everything.
        const bool is_narrow = cosine > 0.0;
        const double angle = is_narrow ? std::acos(std::min(cosine, 1.0)) + k_angle_slack : 0.0;
        const double cos_angle = std::cos(angle), sin_angle = std::sin(angle);
        // Both caps meet when the angle between their centres is at most the sum of theirs, which is below 180 degrees.
        const auto meets = [&](double along, double cap_cosine, double cap_sine) {
            return !is_narrow || along >= cos_angle * cap_cosine - sin_angle * cap_sine;
        };
        for (std::size_t side = 0; side < 6; ++side) {
            const double along = towards[static_cast<Eigen::Index>(side / 2)] * (side % 2 == 1 ? -1.0 : 1.0);
            if (!meets(along, k_side_cosine, k_side_sine)) continue;
            for (std::size_t bin = side * k_bins_per_side; bin < (side + 1) * k_bins_per_side; ++bin) {
                const Cap& cap = caps()[bin];
                if (meets(towards.dot(cap.centre), cap.cosine, cap.sine)) squared_distance_[bin] = std::min(squared_distance_[bin], bound);
            }
        }
    });
}

bool ShadowMap::is_clear(const Vec3& offset) const {
    return offset.squaredNorm() < squared_distance_[bin_of(offset)];
}

}  // namespace cutterflow::coupling
