#include "solver/free_surface/water_particles.hpp"

#include <algorithm>
#include <cmath>

namespace cutterflow::free_surface {

void WaterParticles::add(const Vec3& at, std::uint8_t colour) {
    for (int d = 0; d < 3; ++d) {
        position[d].push_back(at[d]);
        velocity[d].push_back(0.0);
    }
    dye.push_back(colour);
}

double particle_volume(const StaggeredGrid& grid) {
    double count = 1.0;
    for (std::size_t d = 0; d < grid.directions().size(); ++d) count *= k_particles_per_cell_side;
    return grid.cell_volume() / count;
}

int cell_of(const StaggeredGrid& grid, const Vec3& place) {
    std::array<int, 3> cell{0, 0, 0};
    for (const int d : grid.directions()) cell[d] = std::clamp(static_cast<int>(place[d] / grid.spacing()), 0, grid.cells(d) - 1);
    return grid.at(cell[0], cell[1], cell[2]);
}

namespace {

template <typename T>
void reorder(const std::vector<int>& to, std::vector<T>& values) {
    std::vector<T> ordered(values.size());
    for (std::size_t p = 0; p < values.size(); ++p) ordered[to[p]] = values[p];
    values.swap(ordered);
}

}  // namespace

void sort_by_cell(const StaggeredGrid& grid, WaterParticles& particles) {
    std::vector<int> cell(particles.size()), first(grid.size() + 1, 0);
    for (std::size_t p = 0; p < cell.size(); ++p) {
        cell[p] = cell_of(grid, particles.place(p));
        ++first[cell[p] + 1];
    }
    for (std::size_t c = 0; c < grid.size(); ++c) first[c + 1] += first[c];
    std::vector<int> to(cell.size());
    for (std::size_t p = 0; p < cell.size(); ++p) to[p] = first[cell[p]]++;
    for (int d = 0; d < 3; ++d) {
        reorder(to, particles.position[d]);
        reorder(to, particles.velocity[d]);
    }
    reorder(to, particles.dye);
}

std::size_t fastest_particle(const WaterParticles& particles) {
    std::size_t fastest = 0;
    double largest = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const double square = particles.speed(p).squaredNorm();
        if (!std::isfinite(square)) return p;
        if (square <= largest) continue;
        largest = square;
        fastest = p;
    }
    return fastest;
}

double largest_speed(const WaterParticles& particles) {
    return particles.size() == 0 ? 0.0 : particles.speed(fastest_particle(particles)).norm();
}

}  // namespace cutterflow::free_surface
