#pragma once
/// \file Solids on their way through a room: what they go through.
#include <vector>

#include "cases/scenes/room/room_scene.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::cases {

/// Warnings of solids that go through sides of the room that are closed to grains, of those that overlap at the start, and of those that
/// run into one another. Solids are looked at on their way: each 5 degrees of a turn, one turn at most, and at 100 places of a straight
/// way. Points on their edges, up to some 2000, are held against the other solids; what reaches less than 0.001 of the smaller one's extent
/// into the other touches it: circles of triangles that fit into each other overlap by half of that.
std::vector<Mistake> motion_warnings(const ParameterValues& values, const RoomScene& scene);

}  // namespace cutterflow::cases
