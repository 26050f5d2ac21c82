#pragma once
/// \file What stands so close in a scene that few cells resolve the water between it.
#include <string>

#include "solver/free_surface/cut_cells/cut_cells.hpp"

namespace cutterflow::free_surface {

inline constexpr double k_close_cells = 2.0;

/// Of bodies beside each other and of bodies beside walls and solids those that are closer than k_close_cells: a line for each of the two,
/// with the closest places and their number. \pre ids are the bodies'
std::vector<std::string> close_places(const StaggeredGrid& grid, gsl::span<const Body> bodies, gsl::span<const int> ids,
                                      gsl::span<const StillSolid> solids);

}  // namespace cutterflow::free_surface
