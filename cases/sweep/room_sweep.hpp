#pragma once
/// \file Sweeps over keys of a room's study, with repeats that pour anew.
#include "cases/sweep/key_axes.hpp"
#include "cases/sweep/sweep.hpp"
#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::cases {

/// All combinations of the axes' values, each `repeats` times. Repeat n has the study's seed plus n for all combinations, so that they are
/// compared in pairs. Points whose beds are the same share one.
/// \param values  of the study, from read_placed_room: the points lie in other folders
/// \param ranks  of each run \throws UserError  with every mistake of all points
std::vector<SweepPoint> room_sweep_points(const std::filesystem::path& study, const ParameterValues& values,
                                          const std::vector<KeyAxis>& axes, const RepeatRange& repeats, int ranks);

}  // namespace cutterflow::cases
