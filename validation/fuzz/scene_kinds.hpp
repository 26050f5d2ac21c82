#pragma once
#include <vector>

#include "validation/fuzz/trials.hpp"

namespace cutterflow::validation {

/// Rooms, scenes with a free surface, clumps, calibrations, measures, measured points.
std::vector<FuzzKind> scene_kinds();

}  // namespace cutterflow::validation
