#include "solver/foam/soil/soil_turbulence.hpp"

#include "fvMatrices.H"
#include "fvm.H"

namespace cutterflow::foam {

using namespace Foam;

void still_eddies(const volScalarField& share) {
    const fvMesh& mesh = share.mesh();
    if (!mesh.foundObject<volScalarField>("nut")) return;
    auto& eddy_viscosity = mesh.lookupObjectRef<volScalarField>("nut");
    forAll(share, cell) if (share[cell] >= 1.0) eddy_viscosity[cell] = 0.0;
    eddy_viscosity.correctBoundaryConditions();
}

SoilTurbulence::SoilTurbulence(const fvMesh& mesh, const volScalarField& sink)
    : fv::option("soil", "soilTurbulence", dictionary(), mesh), sink_(sink) {
    DynamicList<word> fields;
    for (const word& name : {word("k"), word("epsilon")})
        if (mesh.foundObject<volScalarField>(name)) fields.append(name);
    fieldNames_.transfer(fields);
    applied_.setSize(fieldNames_.size(), false);
}

void SoilTurbulence::addSup(fvMatrix<scalar>& equation, const label) {
    equation -= fvm::Sp(sink_.internalField(), equation.psi());
}

void SoilTurbulence::addSup(const volScalarField&, fvMatrix<scalar>& equation, const label field) {
    addSup(equation, field);
}

void SoilTurbulence::addSup(const volScalarField&, const volScalarField&, fvMatrix<scalar>& equation, const label field) {
    addSup(equation, field);
}

}  // namespace cutterflow::foam
