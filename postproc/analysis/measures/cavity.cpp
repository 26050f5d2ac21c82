#include "postproc/analysis/measures/cavity.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/base/axis_frame.hpp"
#include "postproc/analysis/measures/connected.hpp"

namespace cutterflow::postproc {

namespace {

/// Height between the middles of cells, bilinear; constant beyond the outer ones.
double height_at(const HeightMap& map, const Eigen::Vector2d& place) {
    const double u = std::clamp((place.x() - map.x0) / map.cell - 0.5, 0.0, map.columns - 1.0);
    const double v = std::clamp((place.y() - map.y0) / map.cell - 0.5, 0.0, map.rows - 1.0);
    const int i = std::min(static_cast<int>(u), std::max(0, map.columns - 2)), j = std::min(static_cast<int>(v), std::max(0, map.rows - 2));
    const int right = std::min(i + 1, map.columns - 1), up = std::min(j + 1, map.rows - 1);
    const double low = map.at(i, j) + (u - i) * (map.at(right, j) - map.at(i, j));
    const double high = map.at(i, up) + (u - i) * (map.at(right, up) - map.at(i, up));
    return low + (v - j) * (high - low);
}

bool in_map(const HeightMap& map, const Eigen::Vector2d& place) {
    return place.x() >= map.x0 && place.x() <= map.x0 + map.columns * map.cell && place.y() >= map.y0 &&
           place.y() <= map.y0 + map.rows * map.cell;
}

/// Where the surface first rises to the level, from the centre outwards.
Eigen::Vector2d rim(const HeightMap& map, const Eigen::Vector2d& centre, const Eigen::Vector2d& direction, double level) {
    const double step = 0.1 * map.cell;
    Eigen::Vector2d place = centre;
    while (in_map(map, place) && height_at(map, place) < level) place += step * direction;
    return place;
}

/// The largest of the connected areas of the marked cells.
std::vector<bool> largest_area(std::vector<bool> marked, int columns, int rows) {
    std::vector<bool> largest(marked.size(), false);
    std::ptrdiff_t size = 0;
    for (std::size_t seed = 0; seed < marked.size(); ++seed) {
        if (!marked[seed]) continue;
        const std::vector<bool> area = connected_to(marked, columns, rows, seed);
        for (std::size_t cell = 0; cell < marked.size(); ++cell)
            if (area[cell]) marked[cell] = false;
        const auto cells = std::count(area.begin(), area.end(), true);
        if (cells <= size) continue;
        size = cells;
        largest = area;
    }
    return largest;
}

void add_chords(Cavity& cavity) {
    std::vector<double> lengths;
    for (int n = 0; n < k_chords; ++n) {
        const double turn = n * k_pi / k_chords;
        const Eigen::Vector2d direction(std::cos(turn), std::sin(turn));
        cavity.chords.emplace_back(rim(cavity.surface, cavity.centre, -direction, cavity.level),
                                   rim(cavity.surface, cavity.centre, direction, cavity.level));
        lengths.push_back((cavity.chords.back().second - cavity.chords.back().first).norm());
        cavity.chord_mean += lengths.back() / k_chords;
    }
    double squares = 0.0;
    for (const double length : lengths) squares += (length - cavity.chord_mean) * (length - cavity.chord_mean);
    cavity.chord_spread = std::sqrt(squares / (k_chords - 1));
}

}  // namespace

double surface_level(const Grains& grains, const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, double cell) {
    const HeightMap map = median_filtered(height_map(grains, lower, upper, cell, 0.0), mean_diameter(grains));
    return std::accumulate(map.height.begin(), map.height.end(), 0.0) / static_cast<double>(map.height.size());
}

bool has_bare_corner(const Grains& grains, const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, double cell) {
    const HeightMap map = median_filtered(height_map(grains, lower, upper, cell, 0.0), mean_diameter(grains));
    const int right = map.columns - 1, far = map.rows - 1;
    return std::min({map.at(0, 0), map.at(right, 0), map.at(0, far), map.at(right, far)}) <= 0.0;
}

std::optional<Cavity> cavity_of(const Grains& grains, const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, double undisturbed,
                                double cell) {
    const double diameter = mean_diameter(grains);
    Cavity cavity;
    cavity.surface = median_filtered(height_map(grains, lower, upper, cell, 0.0), diameter);
    cavity.level = undisturbed - 0.5 * diameter;
    const HeightMap& map = cavity.surface;
    std::vector<bool> below;
    for (const double height : map.height) below.push_back(height < cavity.level);
    const std::vector<bool> area = largest_area(below, map.columns, map.rows);
    if (std::find(area.begin(), area.end(), true) == area.end()) return std::nullopt;
    const HeightMap floor = mean_filtered(map, k_floor_diameters * diameter);
    const auto in_area = [&](int i, int j) {
        return i >= 0 && j >= 0 && i < map.columns && j < map.rows && area[static_cast<std::size_t>(j) * map.columns + i];
    };
    for (int j = 0; j < map.rows; ++j) {
        for (int i = 0; i < map.columns; ++i) {
            if (!in_area(i, j)) continue;
            cavity.depth = std::max(cavity.depth, undisturbed - floor.at(i, j));
            cavity.area += cell * cell;
            cavity.volume += cell * cell * (undisturbed - map.at(i, j));
            cavity.centre += cell * cell * Eigen::Vector2d(map.x(i), map.y(j));
            if (i == 0 || j == 0 || i + 1 == map.columns || j + 1 == map.rows) cavity.at_border = true;
            if (in_area(i - 1, j) && in_area(i + 1, j) && in_area(i, j - 1) && in_area(i, j + 1)) continue;
            cavity.outline_x.push_back(map.x(i));
            cavity.outline_y.push_back(map.y(j));
        }
    }
    cavity.centre /= cavity.area;
    cavity.diameter = std::sqrt(4.0 * cavity.area / k_pi);
    add_chords(cavity);
    return cavity;
}

}  // namespace cutterflow::postproc
