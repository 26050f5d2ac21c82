#pragma once
/// \file OpenFOAM dictionaries of a room's medium: fields, properties, schemes and control of the run.
#include <vector>

#include "cases/scenes/flow/flow_files.hpp"
#include "cases/scenes/room/room_scene.hpp"
#include "meshing/room/room_mesh_plan.hpp"

namespace cutterflow::cases {

/// 0/: U, p and, with a model of turbulence, k, epsilon, nut. The medium begins at rest. p is p/rho - g.x, 0 where a boundary gives the
/// pressure. Where something flows through a boundary, its discharge is speed times area of the part: of the medium alone where it comes
/// in, of medium and grains where it goes out. constant/: transportProperties, turbulenceProperties, dynamicMeshDict, g. system/:
/// controlDict, fvSchemes, fvSolution. \pre scene.medium.present()
std::vector<FoamFile> room_flow_files(const RoomScene& scene, const meshing::RoomMeshPlan& plan);

/// The patch whose flow and pressure the run's balance reports: that of the first outflow, else of the first pressure; empty: none.
std::string outlet_patch(const RoomScene& scene);

/// Fastest speed through a boundary [m/s]; 0 when nothing flows through.
double fastest_flow(const RoomScene& scene);

}  // namespace cutterflow::cases
