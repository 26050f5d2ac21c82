#pragma once
/// \file The files of a room's cases: runs of the DEM for its preparation, and the run itself.
#include <string>
#include <vector>

#include "cases/scenes/room/bed.hpp"
#include "cases/scenes/room/room_scene.hpp"
#include "meshing/room/room_mesh_plan.hpp"

namespace cutterflow::cases {

/// A file of a case.
struct CaseText {
    std::string path;  ///< in the case
    std::string text;
};

/// Files of a piece of the preparation, a case without a medium.
/// \param start    folder of a checkpoint whose grains are there at first, as seen from the case; empty: none
/// \param to_run   from the case to the run directory, as "../../"
std::vector<CaseText> bed_case(const RoomScene& scene, const BedPiece& piece, const std::string& start, const std::string& to_run);

/// Files of the run's grains: couplingProperties, rockFeed.csv, shapes. \param start  as above \param first_id  of grains that are fed
std::vector<CaseText> grain_files(const RoomScene& scene, const std::string& start, int first_id);

/// The other files of a run without a medium: g, controlDict.
std::vector<CaseText> dry_files(const RoomScene& scene);

/// The other files of a run with a medium: fields, properties, system/ (room_flow_files).
std::vector<CaseText> flow_files(const RoomScene& scene, const meshing::RoomMeshPlan& plan);

/// The name of a bed: of the files of its pieces and the surfaces of its solids.
std::string bed_name(const RoomScene& scene, const std::vector<BedPiece>& pieces);

/// geometry/<name>.stl, from the run directory.
std::string surface_file(const RoomSolid& solid);

}  // namespace cutterflow::cases
