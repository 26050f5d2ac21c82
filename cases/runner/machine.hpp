#pragma once
/// \file What of the machine a run needs: cores, an OpenFOAM environment that fits.

namespace cutterflow::cases {

/// Cores that this process may use.
int available_cores();

/// Core time of a fixed piece of work, of the kind that the flow's solvers spend theirs on, over that on the machine on which costs were
/// measured (docs/design/003-meshing.md): above 1 on a slower machine, and while other programs share its memory. Takes a tenth of a
/// second.
double machine_slowness();

/// Refuses what would fail later.
/// \throws UserError  for more ranks than cores, and when the environment of an OpenFOAM other than v1912 is loaded
void require_machine(int ranks);

}  // namespace cutterflow::cases
