#pragma once
/// \file Fields that the stages of the fluid solver make. Only for .cpp files of this folder.
#include "volFields.H"

namespace cutterflow::foam {

/// Of a field that is neither read, written nor found by name.
inline Foam::IOobject unregistered(const Foam::word& name, const Foam::fvMesh& mesh) {
    return Foam::IOobject(name, mesh.time().timeName(), mesh, Foam::IOobject::NO_READ, Foam::IOobject::NO_WRITE, false);
}

/// Within a step the mesh has one geometry, but OpenFOAM makes a gradient anew at each use while a mesh moves. While this lives, a gradient
/// that `cache` of fvSolution names is kept from one use to the next, as on a mesh at rest. What moves the mesh evaluates the boundary of
/// the velocity, which ages its gradients. \pre nothing needs the volumes before the step
class KeptGradients {
public:
    explicit KeptGradients(Foam::fvMesh& mesh) : mesh_(mesh), moving_(mesh.moving(false)) {}
    ~KeptGradients() { mesh_.moving(moving_); }
    KeptGradients(const KeptGradients&) = delete;
    KeptGradients& operator=(const KeptGradients&) = delete;

private:
    Foam::fvMesh& mesh_;
    bool moving_;
};

/// Rate at which cells grow [1/s]: 0 on a mesh that is still, rounding errors on one that turns.
Foam::tmp<Foam::volScalarField::Internal> growth_rate(const Foam::fvMesh& mesh);

/// Volumes of the cells before the step [m3].
inline const Foam::scalarField& old_volumes(const Foam::fvMesh& mesh) {
    return mesh.moving() ? mesh.V0().field() : mesh.V().field();
}

}  // namespace cutterflow::foam
