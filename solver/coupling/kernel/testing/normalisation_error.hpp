#pragma once
/// \file How well the weights of stencils are normalised.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gsl/span>

#include "solver/coupling/kernel/mapping.hpp"

namespace cutterflow::coupling::testing {

/// Largest |sum of w * V - 1| over the rocks and both weights. Collective.
inline double normalisation_error(const Stencils& stencils, gsl::span<const double> cell_volume, Communicator& communicator) {
    std::vector<double> sums(2 * stencils.size(), 0.0);
    for (std::size_t p = 0; p < stencils.size(); ++p)
        for (std::size_t i = stencils.first[p]; i < stencils.first[p + 1]; ++i) {
            const double volume = cell_volume[static_cast<std::size_t>(stencils.cell[i])];
            sums[2 * p] += stencils.deposit[i] * volume;
            sums[2 * p + 1] += stencils.sample[i] * volume;
        }
    communicator.sum(sums);
    double worst = 0.0;
    for (const double sum : sums) worst = std::max(worst, std::abs(sum - 1.0));
    return worst;
}

}  // namespace cutterflow::coupling::testing
