#pragma once
/// \file Turbulence in soil. Only for .cpp files of solver/foam.
#include "fvOption.H"
#include "volFields.H"

namespace cutterflow::foam {

/// Sets the eddy viscosity, if there is one, to 0 in cells that soil fills: k and epsilon fall to nothing there, and k^2/epsilon to
/// anything (a thousand m2/s, where epsilon comes to its bound before k). \param share  of soil
void still_eddies(const Foam::volScalarField& share);

/// The momentum's sink in k and epsilon: in soil both fall to nothing. omega has none: it is large at walls.
class SoilTurbulence final : public Foam::fv::option {
public:
    /// \param sink  [1/s]; must outlive this
    SoilTurbulence(const Foam::fvMesh& mesh, const Foam::volScalarField& sink);

    using Foam::fv::option::addSup;
    void addSup(Foam::fvMatrix<Foam::scalar>& equation, const Foam::label field) override;
    void addSup(const Foam::volScalarField& density, Foam::fvMatrix<Foam::scalar>& equation, const Foam::label field) override;
    void addSup(const Foam::volScalarField& alpha, const Foam::volScalarField& density, Foam::fvMatrix<Foam::scalar>& equation,
                const Foam::label field) override;

private:
    const Foam::volScalarField& sink_;
};

}  // namespace cutterflow::foam
