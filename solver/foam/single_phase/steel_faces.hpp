#pragma once
/// \file Wall faces of the mesh as triangles of steel.
#include <vector>

#include "solver/ports/fluid_engine.hpp"

namespace Foam {
class fvMesh;
}

namespace cutterflow::foam {

/// Triangles of all wall patches of the whole mesh, the same on every rank, in their zone's frame.
struct SteelFaces {
    std::vector<coupling::SteelTriangle> rotor;
    std::vector<coupling::SteelTriangle> stator;
};

/// Gathers the faces of every patch of type wall; a face belongs to the rotor when its cell does. Collective.
/// \param in_rotor  one per cell of this rank, 1 for rotor cells
/// \param rotor_angle  [rad] of the mesh
SteelFaces gather_steel_faces(const Foam::fvMesh& mesh, gsl::span<const std::uint8_t> in_rotor, const RotationAxis& axis,
                              double rotor_angle);

}  // namespace cutterflow::foam
