#include "solver/space/shadow_map.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cutterflow::coupling {
namespace {

/// Rounding of places on the cube and of squared distances: a sight line counts the edges of triangles.
constexpr double k_place_slack = 1e-5;
constexpr double k_distance_slack = 1e-5;

constexpr std::size_t k_sides = 6;

/// Coordinates of a direction on a side of the cube: along its axis, and across. Even sides look to positive coordinates.
struct OnSide {
    double along, u, v;
    OnSide(std::size_t side, const Vec3& direction)
        : along((side % 2 == 1 ? -1.0 : 1.0) * direction[axis(side, 0)]), u(direction[axis(side, 1)]), v(direction[axis(side, 2)]) {}
    static Eigen::Index axis(std::size_t side, std::size_t shift) { return static_cast<Eigen::Index>((side / 2 + shift) % 3); }
};

/// Range along one edge of a side, which is -1 to 1.
struct Extent {
    double low = 2.0, high = -2.0;
    void hold(double place) {
        low = std::min(low, place);
        high = std::max(high, place);
    }
    bool meets_side() const { return low <= 1.0 + k_place_slack && high >= -1.0 - k_place_slack; }
};

}  // namespace

/// Bin along an edge of a side; `place` is -1 to 1 on it.
std::size_t ShadowMap::bin_along(double place) {
    const double bin = 0.5 * (place + 1.0) * k_bins_per_edge;
    return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(k_bins_per_edge - 1)));
}

std::size_t ShadowMap::bin_of(const Vec3& direction) {
    Eigen::Index axis = 0;
    const double largest = direction.cwiseAbs().maxCoeff(&axis);
    const std::size_t side = 2 * static_cast<std::size_t>(axis) + (direction[axis] < 0.0 ? 1 : 0);
    const OnSide place(side, direction);
    const double scale = largest > 0.0 ? 1.0 / largest : 0.0;
    return (side * k_bins_per_edge + bin_along(place.u * scale)) * k_bins_per_edge + bin_along(place.v * scale);
}

/// The part of a side that a triangle shades: the rectangle around its projection, or nothing. Within the pyramid of a side a place is less
/// than sqrt(3) times as far from the point as along the axis, so that nothing of the triangle lies there below half of its distance.
std::optional<ShadowMap::Rectangle> ShadowMap::shaded_by(const std::array<Vec3, 3>& corners, double distance, std::size_t side) {
    const OnSide place[] = {{side, corners[0]}, {side, corners[1]}, {side, corners[2]}};
    const double nearest = 0.5 * distance;
    if (!(nearest > 0.0)) return Rectangle{0, k_bins_per_edge - 1, 0, k_bins_per_edge - 1};
    Extent u, v;
    const auto project = [&](double along, double across_u, double across_v) {
        u.hold(across_u / along);
        v.hold(across_v / along);
    };
    for (std::size_t i = 0; i < 3; ++i) {
        const OnSide &p = place[i], &q = place[(i + 1) % 3];
        if (p.along >= nearest) project(p.along, p.u, p.v);
        if ((p.along < nearest) == (q.along < nearest)) continue;
        const double share = (nearest - p.along) / (q.along - p.along);
        project(nearest, p.u + share * (q.u - p.u), p.v + share * (q.v - p.v));
    }
    if (!u.meets_side() || !v.meets_side()) return {};
    return Rectangle{bin_along(u.low - k_place_slack), bin_along(u.high + k_place_slack), bin_along(v.low - k_place_slack),
                     bin_along(v.high + k_place_slack)};
}

ShadowMap::ShadowMap(const SteelTree& steel, const Vec3& point, double reach) : steel_(steel), point_(point) {
    struct Shade {
        Entry entry;
        std::size_t side;
        Rectangle part;
    };
    std::vector<Shade> shades;
    steel.each_within(point, reach, [&](std::int32_t number, const SteelTriangle& triangle, double squared_distance) {
        const Entry entry{static_cast<float>(squared_distance * (1.0 - k_distance_slack)), number};
        const std::array<Vec3, 3> corners{triangle.a - point, triangle.b - point, triangle.c - point};
        for (std::size_t side = 0; side < k_sides; ++side)
            if (const auto part = shaded_by(corners, std::sqrt(entry.squared_distance), side)) shades.push_back({entry, side, *part});
    });
    std::sort(shades.begin(), shades.end(),
              [](const Shade& a, const Shade& b) { return a.entry.squared_distance < b.entry.squared_distance; });
    const auto each_bin = [&shades](const auto& call) {
        for (const Shade& shade : shades)
            for (std::size_t u = shade.part.low_u; u <= shade.part.high_u; ++u)
                for (std::size_t v = shade.part.low_v; v <= shade.part.high_v; ++v)
                    call((shade.side * k_bins_per_edge + u) * k_bins_per_edge + v, shade.entry);
    };
    each_bin([this](std::size_t bin, const Entry&) { ++first_[bin + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    entries_.resize(first_.back());
    std::array<std::uint32_t, k_bins + 1> next = first_;
    each_bin([&](std::size_t bin, const Entry& entry) { entries_[next[bin]++] = entry; });
}

bool ShadowMap::is_clear(const Vec3& offset) const {
    const std::size_t bin = bin_of(offset);
    return first_[bin] == first_[bin + 1] || offset.squaredNorm() < entries_[first_[bin]].squared_distance;
}

bool ShadowMap::blocks(const Vec3& offset) const {
    const std::size_t bin = bin_of(offset);
    const double squared_length = offset.squaredNorm();
    for (std::uint32_t i = first_[bin]; i < first_[bin + 1] && entries_[i].squared_distance <= squared_length; ++i)
        if (steel_.stops(entries_[i].triangle, point_, offset)) return true;
    return false;
}

}  // namespace cutterflow::coupling
