#pragma once
/// \file The preparation of a room as runs of the DEM alone, each of which ends with its grains at rest.
#include <vector>

#include "cases/scenes/room/grain_placement.hpp"
#include "cases/scenes/room/room_scene.hpp"

namespace cutterflow::cases {

/// Grains come in, or some are taken out or frozen at its start; then all come to rest.
struct BedPiece {
    std::vector<PlacedGrain> grains;
    std::vector<RegionEvent> events;  ///< at 0 s
    double longest = 0.0;             ///< by when grains must be at rest, after the last has come in [s]

    double end() const;  ///< [s]
};

/// Pieces of the preparation: a step `settle` ends one; before grains are taken out or frozen they come to rest, and so they do at the end.
/// \throws UserError  with every pour whose grains find no place
std::vector<BedPiece> bed_pieces(const RoomScene& scene);

}  // namespace cutterflow::cases
