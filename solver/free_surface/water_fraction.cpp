#include "solver/free_surface/water_fraction.hpp"

#include <algorithm>

namespace cutterflow::free_surface {

namespace {

constexpr double k_smallest_room = 0.35;  // of a kernel: below, too few particles are in its reach for a fraction of its own
constexpr int k_sliver_passes = 4;

/// Calls visit(neighbour, open share) for every open face of a cell.
template <typename Visit>
void for_each_open_face(const StaggeredGrid& grid, const CutCells& cells, int cell, const Visit& visit) {
    for (const int d : grid.directions()) {
        const int below = cell - grid.stride(d), above = cell + grid.stride(d);
        if (cells.open[d][cell] > 0.0) visit(below, cells.open[d][cell]);
        if (cells.open[d][above] > 0.0) visit(above, cells.open[d][above]);
    }
}

/// Cells without a fraction of their own take the mean of their neighbours that have one; so do, in turn, those behind them.
void fill_slivers(const StaggeredGrid& grid, const CutCells& cells, CellField& fraction) {
    std::vector<int> slivers;
    for (const int cell : cells.cut) {
        if (cells.room[cell] < k_smallest_room && !cells.closed[cell]) slivers.push_back(cell);
    }
    constexpr double unknown = -1.0;
    for (const int cell : slivers) fraction[cell] = unknown;
    for (int pass = 0; pass < k_sliver_passes && !slivers.empty(); ++pass) {
        std::vector<std::pair<int, double>> means;
        std::vector<int> left;
        for (const int cell : slivers) {
            double sum = 0.0, weights = 0.0;
            for_each_open_face(grid, cells, cell, [&](int neighbour, double open) {
                if (fraction[neighbour] < 0.0) return;
                const double weight = open * cells.open_volume[neighbour];
                sum += weight * fraction[neighbour];
                weights += weight;
            });
            if (weights > 0.0) {
                means.emplace_back(cell, sum / weights);
            } else {
                left.push_back(cell);
            }
        }
        for (const auto& [cell, mean] : means) fraction[cell] = mean;
        slivers.swap(left);
    }
    for (const int cell : slivers) fraction[cell] = 0.0;  // pockets that no water reaches
}

}  // namespace

void find_water(const StaggeredGrid& grid, const CellField& particle_share, const CutCells& cells, WaterFraction& water) {
    water.fraction = particle_share;
    grid.for_each_cell([&](int cell, int, int, int) {
        if (water.fraction[cell] > 0.0 && cells.room[cell] > 0.0) water.fraction[cell] /= cells.room[cell];
    });
    fill_slivers(grid, cells, water.fraction);

    water.kind.assign(grid.size(), CellKind::closed);
    water.water.clear();
    grid.for_each_cell([&](int cell, int, int, int) {
        if (cells.closed[cell]) return;
        const bool is_water = water.fraction[cell] >= 0.5;
        water.kind[cell] = is_water ? CellKind::water : CellKind::air;
        if (is_water) water.water.push_back(cell);
    });
}

bool is_beside_air(const StaggeredGrid& grid, const CutCells& cells, const WaterFraction& water, int cell) {
    bool beside = false;
    for_each_open_face(grid, cells, cell, [&](int neighbour, double) { beside = beside || water.kind[neighbour] == CellKind::air; });
    return beside;
}

double occupied_volume(const StaggeredGrid& grid, const CutCells& cells, const WaterFraction& water) {
    double sum = 0.0;
    grid.for_each_cell([&](int cell, int, int, int) {
        if (cells.closed[cell]) return;
        const bool inside = water.kind[cell] == CellKind::water && !is_beside_air(grid, cells, water, cell);
        sum += cells.open_volume[cell] * (inside ? 1.0 : std::min(1.0, water.fraction[cell]));
    });
    return sum * grid.cell_volume();
}

}  // namespace cutterflow::free_surface
