#include "postproc/analysis/measures/grain_maps.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/base/sphere.hpp"
#include "postproc/analysis/measures/connected.hpp"

namespace cutterflow::postproc {

namespace {

constexpr int k_fine = 8;  ///< parts of a cell's side

int parts(double length, double cell) {
    return std::max(1, static_cast<int>(std::ceil(length / cell - 1e-9)));
}

double between(const std::vector<double>& values, int columns, int rows, double u, double v) {
    const double a = std::clamp(u, 0.0, columns - 1.0), b = std::clamp(v, 0.0, rows - 1.0);
    const int i = std::min(static_cast<int>(a), std::max(0, columns - 2)), j = std::min(static_cast<int>(b), std::max(0, rows - 2));
    const int right = std::min(i + 1, columns - 1), up = std::min(j + 1, rows - 1);
    const auto at = [&](int column, int row) { return values[static_cast<std::size_t>(row) * columns + column]; };
    const double low = at(i, j) + (a - i) * (at(right, j) - at(i, j)), high = at(i, up) + (a - i) * (at(right, up) - at(i, up));
    return low + (b - j) * (high - low);
}

}  // namespace

int PlaneGrid::columns() const {
    return parts(box.upper[first()] - box.lower[first()], cell);
}

int PlaneGrid::rows() const {
    return parts(box.upper[second()] - box.lower[second()], cell);
}

SolidMap solid_map(const Grains& grains, const PlaneGrid& grid, double fast) {
    const std::vector<Vec3>& points = unit_sphere_points();
    const int columns = grid.columns(), rows = grid.rows(), a = grid.first(), b = grid.second();
    const double width = grid.width(), height = grid.height();
    SolidMap map;
    map.volume.assign(grid.cells(), 0.0);
    map.volume_by_velocity.assign(grid.cells(), Vec3::Zero());
    for (std::size_t n = 0; n < grains.size(); ++n) {
        const double radius = 0.5 * grains.diameter[n], speed = grains.velocity[n].norm();
        const double part = sphere_volume(grains.diameter[n]) / static_cast<double>(points.size());
        const auto reach = (grains.position[n] - grid.box.lower).array();
        if ((reach < -radius).any() || (reach > (grid.box.upper - grid.box.lower).array() + radius).any()) continue;
        for (const Vec3& point : points) {
            const Vec3 place = grains.position[n] + radius * point;
            if (!is_within(grid.box, place)) continue;
            const int i = std::min(columns - 1, static_cast<int>((place[a] - grid.box.lower[a]) / width));
            const int j = std::min(rows - 1, static_cast<int>((place[b] - grid.box.lower[b]) / height));
            const std::size_t cell = static_cast<std::size_t>(j) * columns + i;
            map.volume[cell] += part;
            map.volume_by_velocity[cell] += part * grains.velocity[n];
            map.speed_sum += part * speed;
            if (speed > fast) map.faster_volume += part;
        }
    }
    return map;
}

std::vector<double> void_fraction(const SolidMap& map, const PlaneGrid& grid) {
    const double cell = grid.width() * grid.height() * (grid.box.upper - grid.box.lower)[grid.across];
    std::vector<double> fraction;
    for (const double volume : map.volume) fraction.push_back(1.0 - volume / cell);
    return fraction;
}

VoidArea void_area(const std::vector<double>& void_fraction, const PlaneGrid& grid, double seed_x, double seed_z, double threshold) {
    const int columns = grid.columns(), rows = grid.rows(), fine_columns = k_fine * columns, fine_rows = k_fine * rows;
    const double width = grid.width() / k_fine, height = grid.height() / k_fine;
    std::vector<bool> empty;
    for (int j = 0; j < fine_rows; ++j)
        for (int i = 0; i < fine_columns; ++i)
            empty.push_back(between(void_fraction, columns, rows, (i + 0.5) / k_fine - 0.5, (j + 0.5) / k_fine - 0.5) >= threshold);
    const auto index = [](double place, double start, double size, int count) {
        return std::clamp(static_cast<int>((place - start) / size), 0, count - 1);
    };
    const double x0 = grid.box.lower[grid.first()], z0 = grid.box.lower[grid.second()];
    const int seed_i = index(seed_x, x0, width, fine_columns), seed_j = index(seed_z, z0, height, fine_rows);
    const std::vector<bool> marked = connected_to(empty, fine_columns, fine_rows, static_cast<std::size_t>(seed_j) * fine_columns + seed_i);
    VoidArea result;
    int left = fine_columns, right = -1, low = fine_rows, high = -1;
    const auto is_marked = [&](int i, int j) {
        return i >= 0 && j >= 0 && i < fine_columns && j < fine_rows && marked[static_cast<std::size_t>(j) * fine_columns + i];
    };
    for (int j = 0; j < fine_rows; ++j) {
        for (int i = 0; i < fine_columns; ++i) {
            if (!is_marked(i, j)) continue;
            result.area += width * height;
            left = std::min(left, i), right = std::max(right, i), low = std::min(low, j), high = std::max(high, j);
            if (is_marked(i - 1, j) && is_marked(i + 1, j) && is_marked(i, j - 1) && is_marked(i, j + 1)) continue;
            result.outline_x.push_back(x0 + (i + 0.5) * width);
            result.outline_z.push_back(z0 + (j + 0.5) * height);
        }
    }
    if (right < 0) return result;
    result.equivalent_diameter = std::sqrt(4.0 * result.area / k_pi);
    result.width = (right - left + 1) * width;
    result.height = (high - low + 1) * height;
    return result;
}

}  // namespace cutterflow::postproc
