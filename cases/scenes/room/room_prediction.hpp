#pragma once
/// \file What a room's study asks for and what its run will take.
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cases/scenes/room/bed.hpp"
#include "cases/scenes/room/room_scene.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/parameters/parameter.hpp"
#include "meshing/room/room_mesh_plan.hpp"

namespace cutterflow::cases {

struct RoomPrediction {
    std::string name;
    std::string medium;
    std::size_t solids = 0;
    std::size_t grains = 0;      ///< poured
    double mass = 0.0;           ///< [kg]
    double fed = 0.0;            ///< grains of feeds
    double fed_mass = 0.0;       ///< [kg]
    double contact_step = 0.0;   ///< [s]; 0 without grains
    double bed_time = 0.0;       ///< of the preparation, without the time that grains take to come to rest [s]
    double end = 0.0;            ///< of the run [s]
    double cells = 0.0;          ///< of the mesh; 0 without a medium
    double flow_step = 0.0;      ///< [s]; 0 without a medium
    double grain_seconds = 0.0;  ///< core time of the contacts, at most: to the run's end [s]
    double mesh_seconds = 0.0;   ///< of the mesh stage [s]
    double flow_seconds = 0.0;   ///< of the medium and what it does to grains, to the run's end [s]
    double core_seconds() const { return grain_seconds + mesh_seconds + flow_seconds; }
    std::vector<std::string> on;  ///< models_of
};

/// What a room's run computes, and why, a line each.
std::vector<std::string> models_of(const RoomScene& scene);

/// \param mesh  of the medium; none without one
RoomPrediction predict(const RoomScene& scene, const std::vector<BedPiece>& pieces, const std::optional<meshing::RoomMeshPlan>& mesh);

/// What a run may be asked in spite of: solids that go through closed sides, grains that are soft for their bed, feeds that the run's end
/// cuts short; with a medium hindrance that counts twice or not at all, openings that kernels do not resolve or that grains may block,
/// solids thinner than cells.
///
/// \param values  of the study
std::vector<Mistake> room_warnings(const ParameterValues& values, const RoomScene& scene, const std::vector<BedPiece>& pieces,
                                   const std::optional<meshing::RoomMeshPlan>& mesh);

std::string to_text(const RoomPrediction& prediction);
nlohmann::json to_json(const RoomPrediction& prediction);

}  // namespace cutterflow::cases
