#pragma once
/// \file The mesh stage of a room: from a plan to constant/polyMesh and mesh.json.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "meshing/dictionary/foam_steps.hpp"
#include "meshing/quality/check_mesh.hpp"
#include "meshing/room/room_mesh_plan.hpp"

namespace cutterflow::meshing {

struct RoomMeshReport {
    CheckMeshFigures quality;
    CheckMeshSize size;
    double predicted_cells = 0.0;
    std::vector<MeshGate> gates;
    std::vector<std::pair<std::string, double>> program_core_s;  ///< programs in the order in which they ran [s]
    double wall_s = 0.0, core_s = 0.0;
};

/// The gates of a room's mesh:
///   failed checks of checkMesh                              0
///   non-orthogonality [deg], skewness                       75, 4
///   parts that no face connects                             1
///   patches of the plan that are missing                    0
///   |volume / medium_volume - 1|                            0.01 + 0.3 solid_volume / medium_volume, at most 0.05 (a closed pipe, a lost
///   solid)
std::vector<MeshGate> check_room_mesh(const RoomMeshPlan& plan, const CheckMeshFigures& quality, const CheckMeshSize& size);

/// mesh.json (docs/design/001-contracts.md).
nlohmann::json to_json(const RoomMeshReport& report);

/// Writes the mesher's case mesh/: dictionaries, and copies of geometry/<solid>.stl. Existing files are overwritten; copy the user's
/// changes over them before build_room_mesh. \return the files that were written, relative to the run directory
std::vector<std::filesystem::path> write_room_mesh_case(const std::filesystem::path& run_directory, const RoomMeshPlan& plan);

/// blockMesh, surfaceFeatureExtract and snappyHexMesh (where solids or smaller cells are), topoSet and createPatch (boundaries), checkMesh;
/// moves the mesh to constant/polyMesh of the run directory and writes mesh.json. A mesh whose gates failed is kept for inspection:
/// require_gates decides. \pre write_room_mesh_case was called \throws ToolError  when a program is missing or fails
RoomMeshReport build_room_mesh(const std::filesystem::path& run_directory, const RoomMeshPlan& plan, const MeshObserver& observer = {});

}  // namespace cutterflow::meshing
