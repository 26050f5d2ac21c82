#pragma once
/// \file The stages of a room's study in its run directory: geometry, bed, mesh (with a medium), case, run, report.
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "cases/runner/run_directory.hpp"
#include "cases/runner/stages.hpp"
#include "cases/scenes/room/bed.hpp"
#include "cases/scenes/room/room_study.hpp"
#include "meshing/room/room_mesh_plan.hpp"

namespace cutterflow::cases {

/// A checked study of a room.
struct RoomRequest {
    ParameterValues values;  ///< files by absolute paths
    RoomScene scene;
    std::vector<BedPiece> pieces;
    std::optional<meshing::RoomMeshPlan> mesh;  ///< with a medium
};

/// \param values  whose files are named relative to `folder` \throws UserError  with every mistake
RoomRequest room_request(const ParameterValues& values, const std::filesystem::path& folder);

/// \throws UserError  with every mistake of the file
RoomRequest read_room_request(const std::filesystem::path& study);

/// \throws UserError  for several ranks without a medium
void require_mesh_for_ranks(const RoomRequest& request, int ranks);

/// \param request  must outlive the stages, as must `directory` \param solver  cutterFoam \param ranks  of the run; beds are made on one
/// \param say  receives lines for the user
std::vector<Stage> room_stages(const RunDirectory& directory, const RoomRequest& request, const std::filesystem::path& solver, int ranks,
                               std::function<void(const std::string&)> say);

/// Takes geometry and bed of another run, if it has finished them with the same inputs and they are as it wrote them.
/// \param stages  of this run, which has not begun \return why they were not taken; empty when they were
std::string take_bed(const std::filesystem::path& donor, const RunDirectory& directory, const std::vector<Stage>& stages);

/// What the bed of a room depends on, by key: points of a sweep with equal ones share it.
std::map<std::string, std::string> bed_inputs(const ParameterValues& values);

}  // namespace cutterflow::cases
