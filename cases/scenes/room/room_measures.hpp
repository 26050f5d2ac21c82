#pragma once
/// \file The tables [[measure]] of a room's study: their keys are those of the measures that can be made of a run.
#include <vector>

#include <nlohmann/json.hpp>

#include "cases/scenes/room/room_scene.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::cases {

/// Rows of all keys that some kind of measure has. Bounds and choices differ between kinds; check_measures knows them.
ParameterTable measure_rows();

/// A table as measures.json has it.
nlohmann::json measure_json(const ParameterValues& table);

/// Every mistake of a table by itself, with its place. \param number  of the table in its study, from 1
std::vector<Mistake> measure_mistakes(const ParameterValues& table, std::size_t number);

/// Gates that measures place themselves.
std::vector<RoomGate> gates_of(const nlohmann::json& measures);

}  // namespace cutterflow::cases
