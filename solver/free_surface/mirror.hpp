#pragma once
/// \file The tank's walls as mirrors: which node a ghost stands for.
#include "solver/free_surface/grid.hpp"

namespace cutterflow::free_surface {

/// Calls visit(inside, ghost) for the nodes next to the tank's two walls in direction e: of cells, or of faces normal to e, whose own node
/// stands on the wall.
template <typename Visit>
void for_each_mirror(const StaggeredGrid& grid, int e, bool on_wall, const Visit& visit) {
    const std::array<int, 2> others{(e + 1) % 3, (e + 2) % 3};
    const int lower = on_wall ? 1 : 0, upper = grid.cells(e) - 1;
    const int lower_ghost = -1, upper_ghost = grid.cells(e) + (on_wall ? 1 : 0);
    std::array<int, 3> place{};
    const auto range = [&](int d) {
        return grid.is_plane() && d == 1 ? std::array<int, 2>{0, 1} : std::array<int, 2>{-1, grid.cells(d) + 2};
    };
    const std::array<int, 2> a = range(others[0]), b = range(others[1]);
    const auto index = [&](int n) {
        place[e] = n;
        return grid.at(place[0], place[1], place[2]);
    };
    for (place[others[0]] = a[0]; place[others[0]] < a[1]; ++place[others[0]]) {
        for (place[others[1]] = b[0]; place[others[1]] < b[1]; ++place[others[1]]) {
            visit(index(lower), index(lower_ghost));
            visit(index(upper), index(upper_ghost));
        }
    }
}

inline constexpr int k_centres = 3;  ///< stands for the nodes in the cells' centres, as a direction does for its faces

/// Adds what was put on ghosts to the nodes that they mirror. \param direction  of the faces, or k_centres
inline void fold(const StaggeredGrid& grid, int direction, double sign_normal, std::vector<double>& field) {
    for (const int e : grid.directions()) {
        const double sign = e == direction ? sign_normal : 1.0;
        for_each_mirror(grid, e, e == direction, [&](int inside, int ghost) { field[inside] += sign * field[ghost]; });
    }
}

}  // namespace cutterflow::free_surface
