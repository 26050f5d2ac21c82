#pragma once
/// \file The readers of a room's tables, in the order in which read_room calls them: later ones need what earlier ones read. Each collects
/// the mistakes of its tables and goes on.
#include <string>

#include "cases/scenes/room/reader/room_reading.hpp"

namespace cutterflow::cases {

void read_space(RoomReading& room);
void read_materials(RoomReading& room);
void read_all_grains(RoomReading& room);
/// Young's modulus and Poisson's ratio of the grains, once their material is known, and those of the solids.
/// \param where  of the grains' material, in the study
void read_elasticity(RoomReading& room, const std::string& where);
void read_solids(RoomReading& room);
void read_moves(RoomReading& room);
void read_boundaries(RoomReading& room);
void read_ramps(RoomReading& room);
void read_pairs(RoomReading& room);
void read_preparation(RoomReading& room);
void read_measures(RoomReading& room);
void read_run(RoomReading& room);
void read_events(RoomReading& room);
void require_something(RoomReading& room);

}  // namespace cutterflow::cases
