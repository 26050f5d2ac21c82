#pragma once
/// \file The dictionaries of a room's mesh stage.
#include "meshing/dictionary/foam_dictionary.hpp"
#include "meshing/room/room_mesh_plan.hpp"

namespace cutterflow::meshing {

FoamDictionary room_background(const RoomMeshPlan& plan);  ///< blockMeshDict: the box, a wall for each side
FoamDictionary room_cut(const RoomMeshPlan& plan);         ///< snappyHexMeshDict. \pre plan.is_cut()
FoamDictionary room_selection(const RoomMeshPlan& plan);   ///< topoSetDict: a faceSet for each patch of the input, none in two
FoamDictionary room_patches(const RoomMeshPlan& plan);     ///< createPatchDict

}  // namespace cutterflow::meshing
