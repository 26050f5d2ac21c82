#include "solver/free_surface/cut_cells/close_places.hpp"

#include <limits>

#include <fmt/format.h>

namespace cutterflow::free_surface {

namespace {

/// The least of the distances that are told, and how many are below k_close_cells.
struct Closest {
    double distance = std::numeric_limits<double>::max();  // [m]
    std::size_t first = 0, second = 0;
    int count = 0;

    void tell(double found, double cell, std::size_t a, std::size_t b) {
        if (found >= (k_close_cells - 1e-6) * cell) return;
        ++count;
        if (found < distance) {
            distance = found;
            first = a;
            second = b;
        }
    }
    std::string text(double cell) const { return fmt::format("{:.3g} m = {:.3g} cells apart", distance, distance / cell); }
};

/// Distance [m] of a body's surface to the nearest wall of the tank or solid.
double distance_to_walls(const StaggeredGrid& grid, const Body& body, gsl::span<const StillSolid> solids) {
    double nearest = std::numeric_limits<double>::max();
    for (const int d : grid.directions()) {
        if (d == 1 && !body.sphere) continue;
        nearest = std::min({nearest, body.position[d], grid.extent(d) - body.position[d]});
    }
    for (const StillSolid& solid : solids) nearest = std::min(nearest, (nearest_on(solid, body.position) - body.position).norm());
    return nearest - body.radius;
}

}  // namespace

std::vector<std::string> close_places(const StaggeredGrid& grid, gsl::span<const Body> bodies, gsl::span<const int> ids,
                                      gsl::span<const StillSolid> solids) {
    const double cell = grid.spacing();
    Closest pairs, walls;
    for (std::size_t a = 0; a < bodies.size(); ++a) {
        for (std::size_t b = a + 1; b < bodies.size(); ++b) {
            const double between = (bodies[a].position - bodies[b].position).norm() - bodies[a].radius - bodies[b].radius;
            pairs.tell(between, cell, a, b);
        }
        walls.tell(distance_to_walls(grid, bodies[a], solids), cell, a, a);
    }
    std::vector<std::string> lines;
    if (pairs.count > 0)
        lines.push_back(fmt::format("closer than two cells: {} pairs of bodies, closest {} and {}, {}", pairs.count, ids[pairs.first],
                                    ids[pairs.second], pairs.text(cell)));
    if (walls.count > 0)
        lines.push_back(fmt::format("closer than two cells: {} bodies and a wall or solid, closest body {}, {}", walls.count,
                                    ids[walls.first], walls.text(cell)));
    return lines;
}

}  // namespace cutterflow::free_surface
