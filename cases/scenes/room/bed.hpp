#pragma once
/// \file The preparation of a room as runs of the DEM alone, each of which ends with its grains at rest.
#include <optional>
#include <vector>

#include "cases/scenes/room/grain_placement.hpp"
#include "cases/scenes/room/room_scene.hpp"
#include "geometry/base/error.hpp"

namespace cutterflow::cases {

/// Grains come in, or some are taken out or frozen at its start, or a solid is pressed on them; then all come to rest.
struct BedPiece {
    std::vector<PlacedGrain> grains;
    std::vector<RegionEvent> events;         ///< at 0 s
    double longest = 0.0;                    ///< by when grains must be at rest, after the last has come in [s]
    std::optional<CompressStep> compress{};  ///< then neither grains nor events

    double end() const;  ///< [s]
};

/// Pieces of the preparation: a step `settle` ends one, `compress` is one; before grains are taken out, frozen or compressed they come to
/// rest, and so they do at the end.
/// \throws UserError  with every pour whose grains find no place
std::vector<BedPiece> bed_pieces(const RoomScene& scene);

/// Steps `freeze` of a piece whose regions have no grains, after those before them have been done.
/// \param centres  of the grains that are there when the piece begins [m]
std::vector<Mistake> empty_freezes(const BedPiece& piece, std::vector<Vec3> centres);

/// Time step of the contacts [s]: a share of the smaller of Rayleigh and Hertz time of the smallest grains, or of spheres of their clumps.
/// 0 without grains. \param contact  of the run or of the preparation
double contact_step(const RoomScene& scene, const coupling::ContactSettings& contact);

/// Largest speed of a solid that compresses [m/s]: 0.05, and in a step of the contacts at most 0.3 of the overlap that the smallest grains
/// have under its pressure, (p d^2/(4/3 E* sqrt(d/4)))^(2/3). At 1.3 of an overlap its damper would swing.
double press_speed(const RoomScene& scene, const CompressStep& compress);

}  // namespace cutterflow::cases
