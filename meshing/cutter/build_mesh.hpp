#pragma once
/// \file The mesh stage: from a plan and the steel's surfaces to constant/polyMesh and mesh.json.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "meshing/cutter/mesh_report.hpp"

namespace cutterflow::meshing {

/// Folder of a run directory in which the mesh is made: an OpenFOAM case of its own, with dictionaries and logs.
inline constexpr const char* k_mesh_case = "mesh";

/// Called before each program with the share of the stage that is done and the program's name.
using MeshObserver = std::function<void(double fraction, const std::string& program)>;

/// Writes the case in which the mesh is made: dictionaries, and copies of geometry/{cutter,backplate,suction_pipe}.stl. What is there
/// already is overwritten; the user's own changes belong on top of it before build_mesh.
/// \param ranks  of snappyHexMesh; above 1 a decomposeParDict is written too
/// \return the files that were written, relative to the run directory
std::vector<std::filesystem::path> write_mesh_case(const std::filesystem::path& run_directory, const MeshPlan& plan, int ranks = 1);

/// Makes the mesh in the case that write_mesh_case wrote, moves it to constant/polyMesh of the run directory and writes mesh.json.
/// blockMesh (rotor and stator without common points), surfaceFeatureExtract and snappyHexMesh (steel), cutterInterfaceRestore
/// (interface points back in place), topoSet and createPatch (outlet, cyclicAMI), checkMesh and cutterMeshProbe (figures).
/// \param programs  folder of cutterInterfaceRestore and cutterMeshProbe
/// \param ranks     of snappyHexMesh, as write_mesh_case was told; decomposePar and reconstructParMesh stand before and after it when there
///                  are several
/// \param retries   what was tried before, for the report
/// \return the report; a mesh whose gates failed is kept, to be looked at: require_mesh_gates decides
/// \throws ToolError  when a program is missing or fails
MeshReport build_mesh(const std::filesystem::path& run_directory, const MeshPlan& plan, const std::filesystem::path& programs,
                      int ranks = 1, const MeshObserver& observer = {}, const std::vector<MeshRetry>& retries = {});

/// Ranks that snappyHexMesh of this plan is worth: `ranks`, or 1 for a mesh so small that decomposing it costs what the ranks save.
int ranks_that_pay(const MeshPlan& plan, int ranks);

/// What to try next when a gate of the mesh of `input` failed: the first attempt's cells, made smaller a little at a time, which moves
/// every face of the background against the steel. None after the last attempt. \param attempts  how many meshes were made so far, 1 or
/// more
std::optional<MeshRetry> next_attempt(const MeshReport& failed, int attempts, MeshInput& input);

/// Rotor angles [rad] at which the interface is measured: within one azimuthal pitch, and the same offsets spread over the turn.
std::vector<double> probe_angles(const RotorZone& rotor);

}  // namespace cutterflow::meshing
