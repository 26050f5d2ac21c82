#pragma once
/// \file Rules about closures.* and kernel.* that every kind of study has alike.
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/error.hpp"
#include "geometry/base/parameters/parameter.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::cases {

/// A drag law that holds the void fraction itself goes without hindrance. \pre closures.* have values
std::vector<Mistake> closure_mistakes(const ParameterValues& values);

/// The drag of rock among rock is counted twice, or not at all. \param dense  whether rock starts with a solid fraction above
/// k_dilute_solids
std::vector<Mistake> hindrance_warnings(const ParameterValues& values, bool dense);

inline constexpr double k_dilute_solids = 0.05;  ///< solid fraction up to which rock hardly hinders other rock

/// A length across which the flow changes.
struct Opening {
    std::string where;   ///< in the study
    std::string name;    ///< as its key
    double width = 0.0;  ///< [m]
    double cell = 0.0;   ///< size of the cells there [m]
};

/// A kernel spreads what rock takes of room and momentum past an opening below 4 of its widths; with kernel.sampling quadratic rock also
/// feels a speed that is off by more than a tenth, below 7 widths (case mouth). In coarse cells the kernel is wider than kernel.gamma makes
/// it (mapping_width). Maps without kernels have no warning. \param diameter  of the largest rock [m]
std::optional<Mistake> wide_kernel_warning(const Opening& opening, const coupling::KernelSettings& kernel, double diameter);

}  // namespace cutterflow::cases
