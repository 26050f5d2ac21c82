#pragma once
/// \file What a room's study asks for and what its run will take.
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cases/scenes/room/bed.hpp"
#include "cases/scenes/room/room_scene.hpp"

namespace cutterflow::cases {

struct RoomPrediction {
    std::string name;
    std::string medium;
    std::size_t solids = 0;
    std::size_t grains = 0;       ///< poured
    double mass = 0.0;            ///< [kg]
    double contact_step = 0.0;    ///< [s]; 0 without grains
    double bed_time = 0.0;        ///< of the preparation, without the time that grains take to come to rest [s]
    double end = 0.0;             ///< of the run [s]
    double core_seconds = 0.0;    ///< of grains alone, at most: to the run's end
    std::vector<std::string> on;  ///< what the run computes, and why
};

RoomPrediction predict(const RoomScene& scene, const std::vector<BedPiece>& pieces);

std::string to_text(const RoomPrediction& prediction);
nlohmann::json to_json(const RoomPrediction& prediction);

}  // namespace cutterflow::cases
