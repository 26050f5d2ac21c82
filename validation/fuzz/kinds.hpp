#pragma once
/// \file The kinds of file that users and earlier runs hand to Cutterflow, each with good examples and the functions that read it.
#include <vector>

#include "validation/fuzz/trials.hpp"

namespace cutterflow::validation {

/// Every kind, in a fixed order.
std::vector<FuzzKind> fuzz_kinds();

}  // namespace cutterflow::validation
