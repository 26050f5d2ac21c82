#include "solver/space/distance_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cutterflow::coupling {

DistanceGrid::DistanceGrid(const Vec3& lower, const Vec3& upper, double spacing, std::function<double(const Vec3&)> distance)
    : spacing_(spacing), distance_(std::move(distance)) {
    for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        first_[i] = static_cast<std::ptrdiff_t>(std::floor(lower[axis] / spacing));
        nodes_[i] = static_cast<std::ptrdiff_t>(std::ceil(upper[axis] / spacing)) - first_[i] + 2;
    }
    values_.assign(static_cast<std::size_t>(nodes_[0] * nodes_[1] * nodes_[2]), std::numeric_limits<float>::quiet_NaN());
}

double DistanceGrid::at(const Vec3& point) {
    std::array<double, 3> share{};
    std::ptrdiff_t node = 0, stride = 1;
    std::array<std::ptrdiff_t, 3> strides{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double steps = std::clamp(point[static_cast<Eigen::Index>(i)] / spacing_ - static_cast<double>(first_[i]), 0.0,
                                        static_cast<double>(nodes_[i] - 1));
        const std::ptrdiff_t first = std::min(static_cast<std::ptrdiff_t>(steps), nodes_[i] - 2);
        share[i] = steps - static_cast<double>(first);
        node += stride * first;
        strides[i] = stride;
        stride *= nodes_[i];
    }
    double value = 0.0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        double weight = 1.0;
        std::ptrdiff_t at = node;
        for (std::size_t i = 0; i < 3; ++i) {
            const bool next = (corner >> i & 1u) != 0;
            weight *= next ? share[i] : 1.0 - share[i];
            at += next ? strides[i] : 0;
        }
        value += weight * at_node(at);
    }
    return value;
}

double DistanceGrid::at_node(std::ptrdiff_t node) {
    float& value = values_[static_cast<std::size_t>(node)];
    if (!std::isnan(value)) return value;
    Vec3 place;
    for (std::size_t i = 0; i < 3; ++i) {
        place[static_cast<Eigen::Index>(i)] = spacing_ * static_cast<double>(first_[i] + node % nodes_[i]);
        node /= nodes_[i];
    }
    return value = static_cast<float>(distance_(place));
}

}  // namespace cutterflow::coupling
