#pragma once
/// \file Wall faces of the mesh as triangles of steel.
#include <vector>

#include "solver/foam/mesh_motion/moving_zones.hpp"

#include "label.H"

namespace Foam {
class fvMesh;
}

namespace cutterflow::foam {

/// Triangles of the steel of the whole mesh, by zone, the same on every rank, in their zone's frame.
using SteelFaces = std::vector<std::vector<coupling::SteelTriangle>>;

/// Gathers the faces of some patches; a face belongs to its cell's zone. Collective.
/// \param time  [s] of the mesh's position
SteelFaces gather_steel_faces(const Foam::fvMesh& mesh, const std::vector<Foam::label>& patches, const MovingZones& zones, double time);

}  // namespace cutterflow::foam
