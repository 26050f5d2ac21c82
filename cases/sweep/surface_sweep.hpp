#pragma once
/// \file Sweeps over keys of a free-surface study, with repeats that differ in the jitter of the bodies' places.
#include "cases/sweep/sweep.hpp"

namespace cutterflow::cases {

/// The values of one key: `solid.hole_m=0,0.001`. A key of a repeated section changes every table of the file that gives it.
struct SurfaceAxis {
    std::string key;
    std::vector<std::string> values;  ///< as TOML writes them
};

/// \param words  of --set
/// \throws UserError  with every word that is no key with values
std::vector<SurfaceAxis> surface_axes(const std::vector<std::string>& words);

/// All combinations of the axes' values, each `repeats` times. Repeat n has the study's seed plus n for all combinations, so that they are
/// compared in pairs.
/// \throws UserError  with every mistake of all points
std::vector<SweepPoint> surface_sweep_points(const std::filesystem::path& study, const std::vector<SurfaceAxis>& axes, int repeats);

}  // namespace cutterflow::cases
