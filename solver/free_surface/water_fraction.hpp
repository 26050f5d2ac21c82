#pragma once
/// \file Which cells are water: the particles' share of the room that solids leave, the surface between cells, the occupied volume.
#include "solver/free_surface/cut_cells/cut_cells.hpp"
#include "solver/free_surface/transfer.hpp"

namespace cutterflow::free_surface {

enum class CellKind : std::uint8_t { air, water, closed };

struct WaterFraction {
    CellField fraction;          ///< alpha: 1 in water at rest, 1/2 on the surface
    std::vector<CellKind> kind;  ///< ghosts are closed
    std::vector<int> water;      ///< the water cells in storage order
};

/// alpha_c = sum V_p W(x_c - x_p) / (V room_c), room_c the integral of W over what solids leave, summed by quarters of cells. The surface
/// is where alpha is 1/2: of particles that fill a half space exactly so. A cell of which solids leave less than 0.7 takes the mean of its
/// neighbours through its open faces: no particle may be in its sliver.
void find_water(const StaggeredGrid& grid, const CellField& particle_share, const CutCells& cells, WaterFraction& water);

/// Share theta of the way from a water cell's centre to the air cell's at which the surface stands, at least 0.1.
/// [EnrightNguyenGibouFedkiw2003]
inline double surface_distance(double water, double air) {
    const double theta = (water - 0.5) / (water - air);
    return theta > 0.1 ? (theta < 1.0 ? theta : 1.0) : 0.1;
}

/// Whether a water cell has air behind one of its open faces.
bool is_beside_air(const StaggeredGrid& grid, const CutCells& cells, const WaterFraction& water, int cell);

/// Volume [m3] that the water occupies: sum of phi times 1 inside and min(1, alpha) elsewhere. Particles that clump occupy less than they
/// are.
double occupied_volume(const StaggeredGrid& grid, const CutCells& cells, const WaterFraction& water);

}  // namespace cutterflow::free_surface
