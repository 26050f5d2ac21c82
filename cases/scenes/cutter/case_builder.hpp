#pragma once
/// \file Writes an OpenFOAM case for cutterFoam, pimpleFoam and the frozen-rotor start. The mesh (constant/polyMesh) is meshing's.
#include <filesystem>
#include <vector>

#include "cases/scenes/cutter/case_inputs.hpp"
#include "meshing/dictionary/foam_dictionary.hpp"

namespace cutterflow::cases {

/// constant/couplingProperties, as docs/design/001-contracts.md lists its keys. Without inputs.rock it has no section `rock` and cutterFoam
/// solves the flow alone.
meshing::FoamDictionary coupling_dictionary(const CaseInputs& inputs);

/// A wall of the DEM and the surface in geometry/ of which its own is made.
struct WallSource {
    coupling::WallSettings wall;
    const char* surface;
};

/// The steel of a run directory: cutter (rotating), backplate, suction pipe.
std::vector<WallSource> wall_sources();
std::vector<coupling::WallSettings> standard_walls();

/// The soil of a study with a bank; write_contact_surfaces makes its file. \param hauling  with which it flows through its surface [m/s]
coupling::WallSettings bank_wall(const Vec3& hauling = Vec3::Zero());

/// The picks that the cutter's file does not have; write_contact_surfaces makes their file.
coupling::WallSettings pick_wall();

/// Writes 0/, constant/ and system/ of the transient run, constant/contour.csv, constant/samples/, the DEM's surfaces (copies of
/// geometry/*.stl, with rock only; write_contact_surfaces puts better ones in their place) and the empty file by which ParaView opens the
/// case. \param run_directory  exists; with rock it holds geometry/cutter.stl, backplate.stl, suction_pipe.stl \return the files that were
/// written, relative to the run directory \throws UserError  with every rule that the inputs break (check_case_inputs); nothing is written
/// then
std::vector<std::filesystem::path> write_case(const std::filesystem::path& run_directory, const CaseInputs& inputs);

/// Writes what cutterFoam needs of a replay: system/, constant/couplingProperties, properties and contour. No mesh, no fields, no surfaces.
/// \pre inputs.replay and inputs.rock are set; files of walls are absolute \throws UserError  with every rule that the inputs break
void write_replay_case(const std::filesystem::path& folder, const CaseInputs& inputs);

}  // namespace cutterflow::cases
