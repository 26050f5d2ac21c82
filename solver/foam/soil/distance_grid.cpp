#include "solver/foam/soil/distance_grid.hpp"

#include <algorithm>
#include <cmath>

namespace cutterflow::foam {

DistanceGrid::DistanceGrid(const Vec3& lower, const Vec3& upper, double spacing, const std::function<double(const Vec3&)>& distance)
    : lower_(lower), spacing_(spacing) {
    for (int i = 0; i < 3; ++i)
        nodes_[static_cast<std::size_t>(i)] = static_cast<std::ptrdiff_t>(std::ceil((upper[i] - lower[i]) / spacing)) + 2;
    values_.reserve(static_cast<std::size_t>(nodes_[0] * nodes_[1] * nodes_[2]));
    for (std::ptrdiff_t k = 0; k < nodes_[2]; ++k)
        for (std::ptrdiff_t j = 0; j < nodes_[1]; ++j)
            for (std::ptrdiff_t i = 0; i < nodes_[0]; ++i) {
                const Vec3 steps(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
                values_.push_back(static_cast<float>(distance(lower_ + spacing_ * steps)));
            }
}

double DistanceGrid::at(const Vec3& point) const {
    std::array<double, 3> share{};
    std::ptrdiff_t node = 0, stride = 1;
    std::array<std::ptrdiff_t, 3> strides{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        const double steps = std::clamp((point[axis] - lower_[axis]) / spacing_, 0.0, static_cast<double>(nodes_[i] - 1));
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
        value += weight * static_cast<double>(values_[static_cast<std::size_t>(at)]);
    }
    return value;
}

}  // namespace cutterflow::foam
