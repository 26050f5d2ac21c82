#pragma once
/// \file Cells in which the turbulence model raises a field to its least value. Only for .cpp files of solver/foam.
#include "fvOption.H"
#include "volFields.H"

namespace cutterflow::foam {

/// Counts cells of k, epsilon, omega and nuTilda below their least values. OpenFOAM's models call fvOptions between the solution of a field
/// and Foam::bound(), which raises it there and tells only the log. Cells in soil, where k and epsilon fall to nothing, do not count.
class TurbulenceClipping final : public Foam::fv::option {
public:
    /// \param model  settings of the turbulence model (turbulenceProperties), with kMin, epsilonMin ... where the user sets them
    /// \param soil   sink of momentum in soil [1/s], or none; must outlive this
    TurbulenceClipping(const Foam::fvMesh& mesh, const Foam::dictionary& model, const Foam::volScalarField* soil);

    void correct(Foam::volScalarField& field) override;

    /// Of this rank since the last call, each field's cells counted.
    Foam::label take_count();

private:
    const Foam::volScalarField* soil_;
    Foam::HashTable<Foam::scalar> least_;  // by field
    Foam::label count_ = 0;
};

}  // namespace cutterflow::foam
