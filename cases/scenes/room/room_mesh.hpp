#pragma once
/// \file The mesh that a room's medium needs.
#include "cases/scenes/room/room_scene.hpp"
#include "meshing/room/room_mesh_plan.hpp"

namespace cutterflow::cases {

/// Box, refined parts, solids that the medium feels, patches of boundaries. \pre scene.medium.present()
meshing::RoomMeshInput mesh_input_of(const RoomScene& scene);

}  // namespace cutterflow::cases
