#pragma once
/// \file The turning zones of the mesh as constant/dynamicMeshDict states them.
#include <cstdint>
#include <vector>

#include "solver/ports/fluid_engine.hpp"

namespace Foam {
class dynamicFvMesh;
}

namespace cutterflow::foam {

struct MovingZones {
    std::vector<coupling::ZoneMotion> motion;  ///< none on a mesh that stands still
    std::vector<std::uint8_t> of_cells;        ///< number of each cell's zone: 0 still, k that of motion[k - 1]
};

/// Reads which cells turn and how: solidBody with rotatingMotion of constant omega, for a cellZone, a cellSet or, with neither, the whole
/// mesh, in any of the key layouts OpenFOAM v1912 accepts. One zone at most. Collective.
/// \throws UserError  when the mesh moves in another way, the zone or set is not there, or the zone does not stand at its angle at the
/// present time
MovingZones read_moving_zones(const Foam::dynamicFvMesh& mesh);

}  // namespace cutterflow::foam
