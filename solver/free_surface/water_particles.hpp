#pragma once
/// \file The water's particles: all of one volume, never split, merged or made anew, so that the water's mass is exact.
#include "solver/free_surface/grid.hpp"

namespace cutterflow::free_surface {

struct WaterParticles {
    std::array<std::vector<double>, 3> position;  ///< x, y, z [m]; y stays in the middle of a plane scene
    std::array<std::vector<double>, 3> velocity;  ///< [m/s]
    std::vector<std::uint8_t> dye;                ///< the box of water that a particle was filled in with
    double volume = 0.0;                          ///< of one particle [m3]

    std::size_t size() const { return dye.size(); }
    void add(const Vec3& place, std::uint8_t colour);
    Vec3 place(std::size_t p) const { return {position[0][p], position[1][p], position[2][p]}; }
    Vec3 speed(std::size_t p) const { return {velocity[0][p], velocity[1][p], velocity[2][p]}; }
};

/// Particles in a cell and direction.
inline constexpr int k_particles_per_cell_side = 2;

/// Volume [m3] of one particle on a grid.
double particle_volume(const StaggeredGrid& grid);

/// Fills a box [m] with resting particles on the regular lattice of the grid, where `is_open` allows it. Only places within the box and not
/// beyond its upper ends are taken: boxes that touch leave neither gap nor overlap.
template <typename IsOpen>
void fill_box(const StaggeredGrid& grid, const Vec3& from, const Vec3& to, std::uint8_t dye, const IsOpen& is_open,
              WaterParticles& particles) {
    particles.volume = particle_volume(grid);
    const double step = grid.spacing() / k_particles_per_cell_side;
    const int across = grid.is_plane() ? 1 : k_particles_per_cell_side * grid.cells(1);
    const double step_across = grid.extent(1) / across;
    const auto within = [&](int d, double place) { return place >= from[d] && place < to[d]; };
    for (int k = 0; k < k_particles_per_cell_side * grid.cells(2); ++k) {
        const double z = (k + 0.5) * step;
        if (!within(2, z)) continue;
        for (int j = 0; j < across; ++j) {
            const double y = (j + 0.5) * step_across;
            if (!grid.is_plane() && !within(1, y)) continue;
            for (int i = 0; i < k_particles_per_cell_side * grid.cells(0); ++i) {
                const Vec3 place((i + 0.5) * step, y, z);
                if (within(0, place.x()) && is_open(place)) particles.add(place, dye);
            }
        }
    }
}

/// Orders particles by cell; equal cells keep their order, so that repeated runs give the same bits.
void sort_by_cell(const StaggeredGrid& grid, WaterParticles& particles);

/// The cell that holds a place; the nearest one of the tank for places outside.
int cell_of(const StaggeredGrid& grid, const Vec3& place);

/// The fastest particle, or the first whose velocity is no number; 0 without any.
std::size_t fastest_particle(const WaterParticles& particles);

double largest_speed(const WaterParticles& particles);  ///< [m/s]

}  // namespace cutterflow::free_surface
