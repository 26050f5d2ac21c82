#pragma once
/// \file No cell holds more rock than fits into it.
#include <vector>

#include "solver/coupling/kernel/mapping.hpp"

namespace cutterflow::coupling {

/// Moves solid out of cells that hold more than `limit`: weights of every rock shrink in overfull cells in proportion and are normalised
/// again, until no cell holds more. Volume of every rock stays exact; the result is continuous in the rocks' positions. All `stencils`
/// (old and new positions of one step) take the same number of passes. Collective.
/// \return solid fraction of each of them, per cell; the largest value stays above `limit` only where the rocks' reach holds no more room
std::vector<std::vector<double>> redistribute(gsl::span<Stencils* const> stencils, gsl::span<const double> rock_volume,
                                              gsl::span<const double> cell_volume, double limit, Communicator& communicator);

}  // namespace cutterflow::coupling
