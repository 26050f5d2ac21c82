#pragma once
/// \file Sliding interfaces (cyclicAMI) and the flows through their two sides. Only for .cpp files of this folder.
#include <vector>

#include "fvMesh.H"
#include "surfaceFields.H"

namespace cutterflow::foam {

class OverlapFlux;

/// The patches on the two sides of one interface.
struct InterfacePair {
    Foam::label owner;
    Foam::label neighbour;
};

/// Empty on a mesh without sliding interface.
std::vector<InterfacePair> interface_pairs(const Foam::fvMesh& mesh);

/// The patches of all interfaces.
std::vector<Foam::label> interface_patches(const Foam::fvMesh& mesh);

/// Flows through all interfaces [m3/s], phi_f the flow through face f, positive out of its cell.
struct InterfaceFlow {
    double gross = 0.0;      ///< sum |phi_f| over the faces of both sides
    double net = 0.0;        ///< sum phi_f
    double imbalance = 0.0;  ///< sum over interfaces of |sum phi_f over both sides|: one interface does not make up for another
    /// sum |phi_f + sum_g A_fg phi_g / A_g| / 2 over the faces f of both sides, g the other side's faces, A_fg the area that overlaps: what
    /// the two sides disagree by face by face, also where the disagreements add up to nothing
    double mismatch = 0.0;
};

/// \param parts  where interfaces have fluxes of parts, the mismatch is of those: sum |phi_f + sum_g Q_gf| / 2 with Q_gf what the other
/// side's face g has as flow through its part with f. Collective.
InterfaceFlow interface_flow(const Foam::surfaceScalarField& flux, const OverlapFlux* parts = nullptr);

}  // namespace cutterflow::foam
