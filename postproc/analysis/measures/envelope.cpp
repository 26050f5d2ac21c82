#include "postproc/analysis/measures/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cutterflow::postproc {

std::vector<double> upper_envelope(const std::vector<double>& u, const std::vector<double>& z, const std::vector<double>& diameter,
                                   const Columns& columns, double empty) {
    std::vector<double> height(static_cast<std::size_t>(columns.count), empty);
    const double width = columns.width();
    for (std::size_t i = 0; i < u.size(); ++i) {
        const double radius = 0.5 * diameter[i];
        const int first = std::max(0, static_cast<int>(std::ceil((u[i] - radius - columns.from) / width - 0.5)));
        const int last = std::min(columns.count - 1, static_cast<int>(std::floor((u[i] + radius - columns.from) / width - 0.5)));
        for (int c = first; c <= last; ++c) {
            const double off = columns.middle(c) - u[i];
            height[c] = std::max(height[c], z[i] + std::sqrt(std::max(0.0, radius * radius - off * off)));
        }
    }
    return height;
}

HeightMap height_map(const Grains& grains, const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, double cell, double empty) {
    HeightMap map;
    map.x0 = lower.x();
    map.y0 = lower.y();
    map.cell = cell;
    map.columns = std::max(1, static_cast<int>(std::ceil((upper.x() - lower.x()) / cell - 1e-9)));
    map.rows = std::max(1, static_cast<int>(std::ceil((upper.y() - lower.y()) / cell - 1e-9)));
    map.height.assign(static_cast<std::size_t>(map.columns) * map.rows, empty);
    for (std::size_t n = 0; n < grains.size(); ++n) {
        const Vec3& place = grains.position[n];
        const double radius = 0.5 * grains.diameter[n];
        const auto first = [&](double centre, double start) {
            return std::max(0, static_cast<int>(std::ceil((centre - radius - start) / cell - 0.5)));
        };
        const auto last = [&](double centre, double start, int count) {
            return std::min(count - 1, static_cast<int>(std::floor((centre + radius - start) / cell - 0.5)));
        };
        for (int j = first(place.y(), map.y0); j <= last(place.y(), map.y0, map.rows); ++j) {
            for (int i = first(place.x(), map.x0); i <= last(place.x(), map.x0, map.columns); ++i) {
                const double dx = map.x(i) - place.x(), dy = map.y(j) - place.y();
                const double under = radius * radius - dx * dx - dy * dy;
                if (under < 0.0) continue;
                double& height = map.height[static_cast<std::size_t>(j) * map.columns + i];
                height = std::max(height, place.z() + std::sqrt(under));
            }
        }
    }
    return map;
}

namespace {

/// Every cell becomes `combine` of the cells whose middles lie within half of `diameter`.
template <class Combine>
HeightMap filtered(const HeightMap& map, double diameter, Combine combine) {
    HeightMap result = map;
    const int reach = static_cast<int>(0.5 * diameter / map.cell);
    const double limit = 0.25 * diameter * diameter / (map.cell * map.cell);
    std::vector<double> near;
    for (int j = 0; j < map.rows; ++j) {
        for (int i = 0; i < map.columns; ++i) {
            near.clear();
            for (int dj = std::max(-reach, -j); dj <= std::min(reach, map.rows - 1 - j); ++dj)
                for (int di = std::max(-reach, -i); di <= std::min(reach, map.columns - 1 - i); ++di)
                    if (di * di + dj * dj <= limit) near.push_back(map.at(i + di, j + dj));
            result.height[static_cast<std::size_t>(j) * map.columns + i] = combine(near);
        }
    }
    return result;
}

}  // namespace

HeightMap median_filtered(const HeightMap& map, double diameter) {
    return filtered(map, diameter, [](std::vector<double>& near) {
        const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
        std::nth_element(near.begin(), middle, near.end());
        return *middle;
    });
}

HeightMap mean_filtered(const HeightMap& map, double diameter) {
    return filtered(map, diameter, [](const std::vector<double>& near) {
        return std::accumulate(near.begin(), near.end(), 0.0) / static_cast<double>(near.size());
    });
}

}  // namespace cutterflow::postproc
