#pragma once
/// \file The turbulence model as OpenFOAM's function objects look for it. Only for .cpp files of this folder.
#include "PhaseIncompressibleTurbulenceModel.H"
#include "singlePhaseTransportModel.H"
#include "turbulentTransportModel.H"

namespace cutterflow::foam {

/// The model that the fluid solver transports turbulence with: weighted with the void fraction.
using PhaseTurbulence = Foam::PhaseIncompressibleTurbulenceModel<Foam::singlePhaseTransportModel>;

/// Stands in the mesh's registry as turbulenceProperties in the place of the phase-weighted model and answers with its values.
///
/// forces, forceCoeffs, wallShearStress and turbulenceFields ask the registry for an incompressible::turbulenceModel, which a
/// phase-weighted model is not; forces then takes the laminar viscosity without a word. Wall functions ask for a turbulenceModel and find
/// this one.
///
/// The stress devReff is that of the mixture, -alpha nuEff dev(2 symm(grad u)) [m2/s2]: what the fluid puts on a wall, as it stands in the
/// momentum equation. nut, nuEff, k, epsilon and R are the fluid's own.
class RegisteredTurbulence final : public Foam::incompressible::turbulenceModel {
public:
    /// Takes the place of `model` in the registry. \pre model outlives this object
    RegisteredTurbulence(PhaseTurbulence& model, const Foam::surfaceScalarField& phase_flux);

    /// The model's type: wall functions find the production of turbulence by it.
    const Foam::word& type() const override { return model_.type(); }
    const Foam::dictionary& coeffDict() const override { return model_.coeffDict(); }
    bool read() override;

    Foam::tmp<Foam::volScalarField> nut() const override { return model_.nut(); }
    Foam::tmp<Foam::scalarField> nut(const Foam::label patch) const override { return model_.nut(patch); }
    Foam::tmp<Foam::volScalarField> nuEff() const override { return model_.nuEff(); }
    Foam::tmp<Foam::scalarField> nuEff(const Foam::label patch) const override { return model_.nuEff(patch); }
    Foam::tmp<Foam::volScalarField> k() const override { return model_.k(); }
    Foam::tmp<Foam::volScalarField> epsilon() const override { return model_.epsilon(); }
    Foam::tmp<Foam::volSymmTensorField> R() const override { return model_.R(); }
    Foam::tmp<Foam::volSymmTensorField> devReff() const override { return model_.devReff(); }
    Foam::tmp<Foam::volSymmTensorField> devRhoReff() const override { return model_.devRhoReff(); }
    Foam::tmp<Foam::fvVectorMatrix> divDevReff(Foam::volVectorField& U) const override { return model_.divDevReff(U); }
    Foam::tmp<Foam::fvVectorMatrix> divDevRhoReff(Foam::volVectorField& U) const override { return model_.divDevRhoReff(U); }

    void validate() override { model_.validate(); }
    void correct() override;

private:
    PhaseTurbulence& model_;
};

}  // namespace cutterflow::foam
