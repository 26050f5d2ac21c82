#pragma once
/// \file What the flow does to the rotor and through the boundary. Only for .cpp files of this folder.
#include "solver/foam/mesh_motion/moving_zones.hpp"
#include "solver/foam/single_phase/cutter_fluid.hpp"

namespace cutterflow::foam {

/// Loads at the present time over the whole mesh; collective.
coupling::FluidLoads compute_loads(const CutterFluid& fluid, const MovingZones& zones, std::optional<Foam::label> outlet);

}  // namespace cutterflow::foam
