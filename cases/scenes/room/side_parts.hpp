#pragma once
/// \file Parts of a room's sides on which boundary conditions hold.
#include "cases/scenes/room/room_scene.hpp"

namespace cutterflow::cases {

/// The box around a part of a side; it has no thickness across the side.
BoxRegion bounds_of(const SidePart& part, coupling::DomainSide side, const RoomScene& scene);

/// Area [m2] of the part of all sides of a boundary.
double area_of(const RoomBoundary& boundary, const RoomScene& scene);

/// Whether two boundaries have faces of a side in common, by the boxes around their parts.
bool overlap(const RoomBoundary& a, const RoomBoundary& b, const RoomScene& scene);

}  // namespace cutterflow::cases
