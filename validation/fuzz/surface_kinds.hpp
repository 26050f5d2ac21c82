#pragma once
#include <string>
#include <vector>

#include "validation/fuzz/trials.hpp"

namespace cutterflow::validation {

/// STL (ASCII and binary), OBJ, PLY and the crown cutter's TOML.
std::vector<FuzzKind> surface_kinds();

/// The example crown cutter in a few hundred triangles.
std::string coarse_crown_file();

}  // namespace cutterflow::validation
