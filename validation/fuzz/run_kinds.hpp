#pragma once
#include <vector>

#include "validation/fuzz/trials.hpp"

namespace cutterflow::validation {

/// The study, points and feeds (CSV), the files of a run directory, checkpoints.
std::vector<FuzzKind> run_kinds();

}  // namespace cutterflow::validation
