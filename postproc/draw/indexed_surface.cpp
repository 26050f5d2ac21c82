#include "postproc/draw/indexed_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace cutterflow::postproc {
namespace {

IndexedSurface on_grid(const TriangleSurface& surface, const Vec3& low, double step) {
    IndexedSurface result{low, step, {}, {}};
    std::map<std::array<std::uint16_t, 3>, std::uint32_t> numbers;
    const auto number_of = [&](const Vec3& corner) {
        std::array<std::uint16_t, 3> point{};
        for (int axis = 0; axis < 3; ++axis) {
            point[static_cast<std::size_t>(axis)] = static_cast<std::uint16_t>(std::lround((corner[axis] - low[axis]) / step));
        }
        const auto [found, is_new] = numbers.emplace(point, static_cast<std::uint32_t>(result.points.size()));
        if (is_new) result.points.push_back(point);
        return found->second;
    };
    for (const Triangle& triangle : surface) {
        const std::array<std::uint32_t, 3> corners{number_of(triangle[0]), number_of(triangle[1]), number_of(triangle[2])};
        if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) result.triangles.push_back(corners);
    }
    return result;
}

}  // namespace

IndexedSurface index_surface(const TriangleSurface& surface, std::size_t most_triangles) {
    if (surface.empty()) return {};
    Vec3 low = surface.front()[0], high = low;
    for (const Triangle& triangle : surface) {
        for (const Vec3& corner : triangle) {
            low = low.cwiseMin(corner);
            high = high.cwiseMax(corner);
        }
    }
    double step = std::max((high - low).maxCoeff(), 1e-9) / 65535.0;
    IndexedSurface indexed = on_grid(surface, low, step);
    while (indexed.triangles.size() > most_triangles) {
        step *= 2.0;
        indexed = on_grid(surface, low, step);
    }
    return indexed;
}

}  // namespace cutterflow::postproc
