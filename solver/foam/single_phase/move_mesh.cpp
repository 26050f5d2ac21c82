#include "solver/foam/single_phase/cutter_fluid.hpp"

#include "fvc.H"

namespace cutterflow::foam {

using namespace Foam;

/// Faces carry their flux relative to the mesh along, as what turns with the mesh does, except where the boundary condition states the
/// velocity.
void CutterFluid::move_mesh() {
    rotation_.move();
    if (rotation_.overlap() != nullptr) parts_.couple(*rotation_.overlap());
    if (!mesh_.moving()) return;
    forAll(phi_.boundaryField(), patch) {
        if (!U_.boundaryField()[patch].fixesValue()) continue;
        phi_.boundaryFieldRef()[patch] =
            (mesh_.Sf().boundaryField()[patch] & U_.boundaryField()[patch]) - mesh_.phi().boundaryField()[patch];
    }
}

}  // namespace cutterflow::foam
