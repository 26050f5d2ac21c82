#pragma once
/// \file The rock of a study, placed: constant/rockFeed.csv and feed.json.
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cases/scenes/cutter/cut_face_feed.hpp"
#include "cases/study/study.hpp"
#include "geometry/head/contour.hpp"
#include "geometry/soil/cut_face.hpp"
#include "geometry/surface/surface.hpp"
#include "solver/ports/feed_place.hpp"

namespace cutterflow::cases {

/// One rock of constant/rockFeed.csv.
struct PlacedRock {
    double time = 0.0;                        ///< [s]
    std::vector<coupling::FeedPlace> places;  ///< one or more, the best first
    std::size_t rock_class = 0;               ///< index in the feed's classes
};

/// Rock of a cut face that starts with the velocity of a body which turns about z. \param angular_velocity  [rad/s]
PlacedRock placed_rock(const CutRock& rock, double angular_velocity);

/// What became of one [[feed]].
struct PlacedFeed {
    FeedRequest request;
    std::size_t requested = 0;
    std::vector<PlacedRock> rocks;
    std::vector<std::string> reasons;                 ///< why rocks were rejected or start elsewhere
    bool is_spill_layer = false;                      ///< loose rock that the swing before left, of a feed from a cut face
    std::vector<std::pair<double, double>> layers{};  ///< of a cut face: thickness [m] of a layer, and its section that a swing takes [m2]
};

/// Number of rocks of each class: of `count` rocks in all, or of a mass [kg], such that masses are in proportion to the shares.
/// Rounded so that a given count is kept exactly. 0 of a cut face, whose rock is a matter of time.
std::vector<std::size_t> rocks_per_class(const FeedRequest& request);

/// What the rock is placed into.
struct FeedScene {
    geometry::Contour head;
    geometry::TriangleSurface cutter;      ///< at rotor angle 0, run's frame
    geometry::TriangleSurface stationary;  ///< closed
    HeadSize size;
    std::optional<geometry::CutFace> cut_face{};      ///< of a study with a bank
    std::optional<geometry::CutFace> spill_layer{};   ///< of a study whose swing before left one
    std::vector<std::pair<double, double>> layers{};  ///< as PlacedFeed has them
};

/// The scene of a study's cutter. \param cutter  as FeedScene has it
FeedScene feed_scene(const Study& study, const HeadSize& size, const geometry::Contour& head, const geometry::TriangleSurface& cutter);

/// Places every feed of a study, the cutter turned to its angle at the release. A feed of several classes is placed on the lattice of its
/// largest; which place gets which class is drawn with the feed's seed. Clumps have room for any orientation.
/// \throws UserError  with every feed whose region has no free place at all
std::vector<PlacedFeed> place_feeds(const Study& study, const FeedScene& scene);

/// Lines for the user: counts, and why rocks were rejected.
std::vector<std::string> feed_lines(const std::vector<PlacedFeed>& feeds);

/// Text of constant/rockFeed.csv and of feed.json (docs/design/001-contracts.md).
std::string rock_feed_csv(const std::vector<PlacedFeed>& feeds);
std::string feed_json(const std::vector<PlacedFeed>& feeds, const Study& study);

/// Speed [m/s] at which a rock of that class settles in still water.
double settling_speed(const Study& study, const FeedClass& rock);

}  // namespace cutterflow::cases
