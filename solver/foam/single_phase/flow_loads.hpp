#pragma once
/// \file What the flow does to the rotor and through the boundary. Only for .cpp files of this folder.
#include "solver/foam/single_phase/cutter_fluid.hpp"

namespace cutterflow::foam {

/// Loads at the present time over the whole mesh; collective.
/// \param in_rotor  one per cell of this rank, 1 for rotor cells
coupling::FluidLoads compute_loads(const CutterFluid& fluid, gsl::span<const std::uint8_t> in_rotor, const coupling::RotorMotion& motion);

}  // namespace cutterflow::foam
