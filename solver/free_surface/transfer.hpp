#pragma once
/// \file Between particles and grid: kernels mirrored at the tank's walls, extrapolation beyond the surface, motion of the particles.
#include <initializer_list>

#include "solver/free_surface/cut_cells/slip_walls.hpp"
#include "solver/free_surface/water_particles.hpp"

namespace cutterflow::free_surface {

/// What particles put on the grid.
struct MappedWater {
    FaceField velocity;  ///< [m/s]; 0 where no particle reaches
    FaceField share;     ///< particle volume that a face sees over a cell's volume; 0: no particle reaches it
    CellField fraction;  ///< the same of cells: the numerator of the water fraction

    explicit MappedWater(const StaggeredGrid& grid) : velocity(grid.face_field()), share(grid.face_field()), fraction(grid.cell_field()) {}
};

/// u_f = sum V_p W v_p / sum V_p W. The tank's walls mirror: velocity normal to a wall changes its sign there, what is tangential does not.
/// Particles must be in the tank. They give to the faces that they read (SlipWalls), with the same weights: what a wall's faces take from
/// one particle comes from no other one.
void map_to_grid(const StaggeredGrid& grid, const SlipWalls& walls, const WaterParticles& particles, MappedWater& mapped);

/// The cells' part of map_to_grid alone.
void map_fraction(const StaggeredGrid& grid, const WaterParticles& particles, CellField& fraction);

/// Fills the ghosts of a face field that is 0 on walls, for gathering.
void mirror_faces(const StaggeredGrid& grid, FaceField& field);

/// What is known of a face.
enum class FaceValue : std::uint8_t {
    none,     ///< no value yet
    present,  ///< a value of its own; source of an extrapolation
    found,    ///< gets its value in the layer at hand
    held,     ///< a wall's or a body's: neither source nor target
};
using FaceValues = std::array<std::vector<FaceValue>, 3>;

/// Gives faces of one direction without a value the mean of their neighbours that have one, `layers` times; they are `present` then.
/// \param front   faces that are present at the beginning; in the end those of the last layer
/// \param fields  of that direction, all treated alike
void extrapolate(const StaggeredGrid& grid, int layers, std::vector<FaceValue>& values, std::vector<int>& front,
                 std::initializer_list<std::vector<double>*> fields);

/// How velocity on the grid moves particles in one step.
struct WaterMotion {
    const FaceField& velocity;   ///< at the step's end [m/s], ghosts filled
    const FaceField& increment;  ///< its change since the mapping [m/s], ghosts filled
    double step = 0.0;           ///< [s]
    double kept = 1.0;           ///< lambda: share of a particle's own velocity that is kept (1: FLIP, 0: PIC)
};

/// v <- lambda (v + sum W du) + (1 - lambda) sum W u, then Ralston's third-order Runge-Kutta in the grid's velocity. Particles stay within
/// the tank. [BrackbillRuppel1986] [Ralston1962]
void move_particles(const StaggeredGrid& grid, const SlipWalls& walls, const WaterMotion& motion, WaterParticles& particles);

/// Moves particles by a displacement on faces (ghosts filled), each component at most `largest` [m]; velocities stay.
void displace_particles(const StaggeredGrid& grid, const SlipWalls& walls, const FaceField& displacement, double largest,
                        WaterParticles& particles);

/// Value of a face field with filled ghosts at a place [m].
Vec3 value_at(const StaggeredGrid& grid, const SlipWalls& walls, const FaceField& field, const Vec3& place);

/// Puts a place back into the tank: at least 1e-6 of a cell from its walls.
void keep_in_tank(const StaggeredGrid& grid, Vec3& place);

}  // namespace cutterflow::free_surface
