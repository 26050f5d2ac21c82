#pragma once
/// \file Where and when the grains of a pour or of a feed begin.
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "cases/scenes/room/room_scene.hpp"

namespace cutterflow::cases {

struct PlacedGrain {
    int id = 0;
    double time = 0.0;  ///< [s]
    Vec3 position = Vec3::Zero();
    double diameter = 0.0;
    double density = 0.0;
    Vec3 velocity = Vec3::Zero();
    std::string shape{};          ///< name of a kind of grains that are clumps; empty: a sphere
    std::optional<Vec3> above{};  ///< where it begins as long as its place is taken
};

/// Diameter and density of a grain that has no place yet.
struct DrawnGrain {
    double diameter = 0.0;  ///< [m]
    double density = 0.0;   ///< [kg/m3]
};

/// Grains, drawn until their mass is reached: the last one may exceed it by less than half of its own.
std::vector<DrawnGrain> draw_grains(const RoomGrains& grains, double mass, std::mt19937_64& random);
std::vector<DrawnGrain> draw_grains(const RoomGrains& grains, std::size_t count, std::mt19937_64& random);

/// Pours one after the other. A pour's grains begin at random places, in batches: each fills at most a share of 0.3 of the free part of the
/// region, above what has come down, and moves down at 1 m/s. The next batch comes when the one before it has had time to fall twice. Where
/// a grain that bounced takes a place then, the other grains of the batch may bury it; so grains of later batches may begin at the top of
/// their region, above their places.
class Pouring {
public:
    /// \param scene, random  must outlive the object
    Pouring(const RoomScene& scene, std::mt19937_64& random);
    ~Pouring();

    /// \throws UserError  when grains find no place
    void pour(const PourStep& step);

    /// Grains that have come down are taken out of a region: later pours begin lower where that is all that lies above a level. What
    /// another region takes out counts on.
    void trim(const Region& region);

    /// Grains of the pours since the last call, by their times, which begin at 0 again; ids go on.
    std::vector<PlacedGrain> take();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Grains of every FeedEvent at random places of their regions, at the times at which their mass is due; ids from `first_id` on. Solids
/// that are gone or have moved by then do not count.
/// \throws UserError  with every feed whose grains find no place
std::vector<PlacedGrain> place_feeds(const RoomScene& scene, int first_id, std::mt19937_64& random);

/// constant/rockFeed.csv.
std::string grain_feed_csv(const std::vector<PlacedGrain>& grains);

inline constexpr double k_most_grains = 1e6;  ///< of one pour or feed

/// A pour's share of the volume of a bed that has come down.
inline constexpr double k_packed_share = 0.60;

/// Of a region in which grains begin: a box or an upright cylinder.
double area_of(const Region& region);
double height_of(const Region& region);
/// What the solids leave of it, where they stand at first [m3].
double free_volume(const RoomScene& scene, const Region& region);

}  // namespace cutterflow::cases
