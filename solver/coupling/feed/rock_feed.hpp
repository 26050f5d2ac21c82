#pragma once
/// \file The rocks that enter a run, from constant/rockFeed.csv.
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "geometry/base/vec3.hpp"
#include "solver/ports/clump_shape.hpp"
#include "solver/ports/dem_engine.hpp"
#include "solver/ports/feed_place.hpp"

namespace cutterflow::coupling {

/// One rock to be placed.
struct FeedRock {
    int id = 0;                          ///< > 0, unique
    double time = 0.0;                   ///< [s]
    Vec3 position = Vec3::Zero();        ///< [m]
    double diameter = 0.0;               ///< [m]
    double density = 0.0;                ///< [kg/m3]
    std::optional<Vec3> velocity;        ///< [m/s]; absent: the local fluid velocity
    std::vector<FeedPlace> elsewhere{};  ///< where else it may go in, the best place first
    int shape = k_sphere_shape;          ///< as Rock::shape
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// Reads `id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3[,vx_m_s,vy_m_s,vz_m_s][,place][,shape][,qw,qx,qy,qz]`, sorted by time, then id.
/// With `place` a rock may have several rows, one below the other and alike but for place and velocity, numbered from 0. `shape` is a name
/// of `shapes`; none, or an empty field: a sphere. A clump without a quaternion has orientation_of_id.
/// \param in_domain  whether a rock may be placed there; without it, anywhere
/// \throws UserError  with every mistake of the file: missing column, not a number, id repeated or not positive, diameter or density not
/// positive, place outside the domain or out of order, unknown shape, quaternion not of length 1
std::vector<FeedRock> read_rock_feed(const std::filesystem::path& file, const std::function<bool(const Vec3&)>& in_domain = {},
                                     const std::vector<ClumpShape>& shapes = {});

/// An orientation drawn from all orientations alike, always the same for one id.
Eigen::Quaterniond orientation_of_id(int id);

/// Rock of the feed for the DEM, in the order of the list; rock without a velocity is at rest.
Rocks as_listed(const std::vector<FeedRock>& feed);
/// The same, sorted by id.
Rocks rocks_of(const std::vector<FeedRock>& feed);

}  // namespace cutterflow::coupling
