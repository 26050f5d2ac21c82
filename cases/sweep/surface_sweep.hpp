#pragma once
/// \file Sweeps over keys of a free-surface study, with repeats that differ in the jitter of the bodies' places.
#include "cases/sweep/key_axes.hpp"
#include "cases/sweep/sweep.hpp"

namespace cutterflow::cases {

/// All combinations of the axes' values, each `repeats` times. Repeat n has the study's seed plus n for all combinations, so that they are
/// compared in pairs.
/// \throws UserError  with every mistake of all points; repeats of a study whose bodies have no jitter are one
std::vector<SweepPoint> surface_sweep_points(const std::filesystem::path& study, const std::vector<KeyAxis>& axes,
                                             const RepeatRange& repeats);

}  // namespace cutterflow::cases
