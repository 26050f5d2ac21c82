#include "solver/foam/single_phase/fields.hpp"

#include "fvMesh.H"

namespace cutterflow::foam {

using namespace Foam;

tmp<volScalarField::Internal> growth_rate(const fvMesh& mesh) {
    auto rate = tmp<volScalarField::Internal>::New(unregistered("growthRate", mesh), mesh, dimensionedScalar(dimless / dimTime, Zero));
    if (mesh.moving()) rate.ref().field() = (1.0 - mesh.V0().field() / mesh.V().field()) / mesh.time().deltaTValue();
    return rate;
}

}  // namespace cutterflow::foam
