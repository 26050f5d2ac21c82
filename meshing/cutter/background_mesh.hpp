#pragma once
/// \file The background mesh of a plan as blockMeshDict: an O-grid of rotor and stator blocks that share no point, so that the rotor's
/// interface is a surface of revolution, divided uniformly in azimuth on both sides.
#include "meshing/cutter/mesh_plan.hpp"
#include "meshing/dictionary/foam_dictionary.hpp"

namespace cutterflow::meshing {

// Patches of the background mesh on the interface. They are plain patches until the steel is cut: snappyHexMesh takes no cyclicAMI.
inline constexpr const char* k_rotor_side_patch = "rotor_side";
inline constexpr const char* k_stator_side_patch = "stator_side";
inline constexpr const char* k_stator_zone = "stator";  ///< cell zone of everything outside the rotor zone

/// blockMeshDict. Cell zones `rotor` and `stator`; patches inlet, tank_top, tank_bottom and the two sides of the interface.
FoamDictionary background_mesh(const MeshPlan& plan);

}  // namespace cutterflow::meshing
