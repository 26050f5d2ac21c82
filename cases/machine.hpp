#pragma once
/// \file What of the machine a run needs: cores, programs, an OpenFOAM environment that fits.
#include <string>
#include <vector>

namespace cutterflow::cases {

/// Cores that this process may use.
int available_cores();

/// Refuses what would fail later.
/// \param programs  names, or paths, of what will be started
/// \throws UserError  for more ranks than cores, and when the environment of an OpenFOAM other than v1912 is loaded
/// \throws ToolError  naming every program that is not there
void require_machine(int ranks, const std::vector<std::string>& programs);

}  // namespace cutterflow::cases
