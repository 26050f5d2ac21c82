#pragma once
/// \file Closed faces of what stands still, along which water slips.
#include "solver/free_surface/grid.hpp"

namespace cutterflow::free_surface {

/// Faces within the tank that what stands still closes, for particles beside it. Water slips along still solids as along the tank's walls:
/// the layer that sticks to them is thinner than a cell, and a kernel that reads their velocity 0 beside the flow would carry two thirds of
/// the flux through a hole of one cell. So a particle reads a closed face only in the row of cells in which it is itself, where the face is
/// in its way; a closed face of a row beside it counts as the face of its own row: the same mirror as at the tank's walls.
struct SlipWalls {
    std::array<std::vector<std::uint8_t>, 3> closed;  ///< of each face of a direction; empty: no solids
    std::vector<std::uint8_t> near;                   ///< 1 for cells whose particles' kernels reach a closed face

    bool empty() const { return near.empty(); }
};

}  // namespace cutterflow::free_surface
