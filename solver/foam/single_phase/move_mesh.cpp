#include "solver/foam/single_phase/cutter_fluid.hpp"

#include "fvc.H"

namespace cutterflow::foam {

using namespace Foam;

/// Cells carry their velocity along, faces theirs: the flux is that of the old face velocity through the turned face, except where the
/// boundary condition states it.
void CutterFluid::move_mesh() {
    mesh_.update();
    if (!mesh_.moving()) return;
    phi_ = mesh_.Sf() & Uf_();
    forAll(phi_.boundaryField(), patch) {
        if (!U_.boundaryField()[patch].fixesValue()) continue;
        phi_.boundaryFieldRef()[patch] = mesh_.Sf().boundaryField()[patch] & U_.boundaryField()[patch];
    }
    fvc::makeRelative(phi_, U_);
}

}  // namespace cutterflow::foam
