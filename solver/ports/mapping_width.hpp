#pragma once
/// \file How wide a rock is laid over cells.
#include <algorithm>

#include "solver/ports/settings.hpp"

namespace cutterflow::coupling {

/// sigma = max(gamma d, min_width_in_cells dx) of map gaussian [m]; of the others the side of a rock's group of cells [m].
/// \param diameter  of the rock [m] \param cell_size  of the cells about it [m]
inline double mapping_width(const KernelSettings& kernel, double diameter, double cell_size) {
    if (kernel.map == k_gaussian_map) return std::max(kernel.gamma * diameter, kernel.min_width_in_cells * cell_size);
    return std::max(kernel.cluster_size, cell_size);
}

}  // namespace cutterflow::coupling
