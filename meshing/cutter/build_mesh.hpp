#pragma once
/// \file The mesh stage: from a plan and the steel's surfaces to constant/polyMesh and mesh.json.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "meshing/cutter/mesh_report.hpp"
#include "meshing/dictionary/foam_steps.hpp"

namespace cutterflow::meshing {

/// Folder of a run directory in which the mesh is built: a separate OpenFOAM case with dictionaries and logs.
inline constexpr const char* k_mesh_case = "mesh";

/// Writes the case of the mesher: dictionaries, and copies of geometry/{cutter,backplate,suction_pipe}.stl. Existing files
/// are overwritten; copy the user's changes over them before build_mesh.
/// \param ranks  of snappyHexMesh; above 1 a decomposeParDict is written too
/// \return the files that were written, relative to the run directory
std::vector<std::filesystem::path> write_mesh_case(const std::filesystem::path& run_directory, const MeshPlan& plan, int ranks = 1);

/// Builds the mesh in the case of write_mesh_case, moves it to constant/polyMesh of the run directory and writes mesh.json.
/// blockMesh (rotor and stator without common points), surfaceFeatureExtract and snappyHexMesh (steel), cutterInterfaceRestore
/// (interface points back in place), topoSet and createPatch (outlet, cyclicAMI), checkMesh and cutterMeshProbe (figures).
/// \param programs  folder of cutterInterfaceRestore and cutterMeshProbe
/// \param ranks     of snappyHexMesh, as in write_mesh_case; above 1 decomposePar and reconstructParMesh run before and after it
/// \param retries   earlier attempts, for the report
/// \return the report; a mesh whose gates failed is kept for inspection: require_mesh_gates decides
/// \throws ToolError  when a program is missing or fails
MeshReport build_mesh(const std::filesystem::path& run_directory, const MeshPlan& plan, const std::filesystem::path& programs,
                      int ranks = 1, const MeshObserver& observer = {}, const std::vector<MeshRetry>& retries = {});

/// Ranks for snappyHexMesh of this plan: `ranks`, or 1 for a mesh so small that decomposing it costs more than the ranks save.
int ranks_that_pay(const MeshPlan& plan, int ranks);

/// The next attempt when a gate of the mesh of `input` failed: cells slightly smaller than those of the first attempt, which moves
/// every face of the background against the steel. None after the last attempt. \param attempts  how many meshes were made so far, 1 or
/// more
std::optional<MeshRetry> next_attempt(const MeshReport& failed, int attempts, MeshInput& input);

/// Rotor angles [rad] at which the interface is measured: within one azimuthal pitch, and the same offsets spread over the turn.
std::vector<double> probe_angles(const RotorZone& rotor);

}  // namespace cutterflow::meshing
