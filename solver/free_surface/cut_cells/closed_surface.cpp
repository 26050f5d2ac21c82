#include "solver/free_surface/cut_cells/closed_surface.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace cutterflow::free_surface {

namespace {

constexpr int k_most_bins = 256;  // along a side

/// The two directions across a line.
std::array<int, 2> across(int direction) {
    return {(direction + 1) % 3, (direction + 2) % 3};
}

/// Whether a place lies to the left of the edge from p to q, seen along the line. The edge is taken in the order of its points' numbers, so
/// that both of its triangles agree; on the edge the place counts as shifted towards +a, and less towards +b.
bool is_left(const geometry::TriangleSurface& surface, std::uint32_t p, std::uint32_t q, const std::array<int, 2>& plane,
             const Vec3& place) {
    const bool swapped = p > q;
    const Vec3 &from = surface.points[swapped ? q : p], &to = surface.points[swapped ? p : q];
    const auto [a, b] = plane;
    const double side = (to[a] - from[a]) * (place[b] - from[b]) - (to[b] - from[b]) * (place[a] - from[a]);
    const double tie = to[b] != from[b] ? from[b] - to[b] : to[a] - from[a];
    return ((side != 0.0 ? side : tie) > 0.0) != swapped;
}

}  // namespace

int ClosedSurface::Bins::at(int side, double place) const {
    return std::clamp(static_cast<int>((place - from[side]) * inverse[side]), 0, count - 1);
}

ClosedSurface::ClosedSurface(geometry::TriangleSurface surface) : surface_(std::move(surface)), search_(surface_) {
    for (const int d : {0, 1, 2}) fill_bins(d);
}

void ClosedSurface::fill_bins(int direction) {
    Bins& bins = bins_[direction];
    const geometry::Bounds bounds = geometry::bounds_of(surface_);
    const std::array<int, 2> plane = across(direction);
    bins.count = std::clamp(static_cast<int>(std::sqrt(surface_.triangles.size())), 1, k_most_bins);
    for (const int side : {0, 1}) {
        bins.from[side] = bounds.min[plane[side]];
        bins.inverse[side] = bins.count / bounds.extent()[plane[side]];
    }
    bins.triangles.resize(static_cast<std::size_t>(bins.count) * bins.count);
    for (std::uint32_t n = 0; n < surface_.triangles.size(); ++n) {
        std::array<int, 2> low{bins.count, bins.count}, high{-1, -1};
        for (const std::uint32_t point : surface_.triangles[n]) {
            for (const int side : {0, 1}) {
                const int bin = bins.at(side, surface_.points[point][plane[side]]);
                low[side] = std::min(low[side], bin);
                high[side] = std::max(high[side], bin);
            }
        }
        for (int v = low[1]; v <= high[1]; ++v) {
            for (int u = low[0]; u <= high[0]; ++u) bins.triangles[static_cast<std::size_t>(v) * bins.count + u].push_back(n);
        }
    }
}

/// Where a line passes a triangle [m], if it does.
std::optional<double> ClosedSurface::crossing(const geometry::Triangle& triangle, int direction, const Vec3& through) const {
    const std::array<int, 2> plane = across(direction);
    const bool left = is_left(surface_, triangle[0], triangle[1], plane, through);
    if (is_left(surface_, triangle[1], triangle[2], plane, through) != left) return {};
    if (is_left(surface_, triangle[2], triangle[0], plane, through) != left) return {};
    const Vec3 normal = geometry::area_vector(surface_, triangle);
    if (normal[direction] == 0.0) return {};
    const Vec3& corner = surface_.points[triangle[0]];
    double place = corner[direction];
    for (const int d : plane) place -= normal[d] / normal[direction] * (through[d] - corner[d]);
    return place;
}

std::vector<Interval> ClosedSurface::parts(int direction, const Vec3& through) const {
    const Bins& bins = bins_[direction];
    const std::array<int, 2> plane = across(direction);
    const std::size_t bin = static_cast<std::size_t>(bins.at(1, through[plane[1]])) * bins.count + bins.at(0, through[plane[0]]);
    std::vector<double> places;
    for (const std::uint32_t triangle : bins.triangles[bin]) {
        if (const auto place = crossing(surface_.triangles[triangle], direction, through)) places.push_back(*place);
    }
    if (places.size() % 2 != 0)
        throw std::runtime_error(fmt::format("the line along {} through ({:g}, {:g}, {:g}) m meets a surface {} times", "xyz"[direction],
                                             through.x(), through.y(), through.z(), places.size()));
    std::sort(places.begin(), places.end());
    std::vector<Interval> inside;
    for (std::size_t n = 0; n + 1 < places.size(); n += 2) inside.push_back({places[n], places[n + 1]});
    return inside;
}

bool ClosedSurface::contains(const Vec3& place) const {
    const std::vector<Interval> inside = parts(2, place);
    return std::any_of(inside.begin(), inside.end(), [&](const Interval& part) { return part.from < place.z() && place.z() < part.to; });
}

}  // namespace cutterflow::free_surface
