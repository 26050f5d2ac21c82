#pragma once
/// \file Rock from a cut face: what a swinging head cuts, class by class, when and where a blade's leading face comes by.
#include <cstdint>
#include <vector>

#include "cases/study/study.hpp"
#include "geometry/head/contour.hpp"
#include "geometry/soil/cut_face.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::cases {

/// The head that cuts.
struct CuttingHead {
    geometry::Contour contour;
    const geometry::TriangleSurface& cutter;  ///< at rotor angle 0, run's frame
    double rotation_speed = 0.0;              ///< [rad/s], right-handed about the axis
};

/// What is cut.
struct CutRequest {
    geometry::CutFace face;
    double mass_rate = 0.0;         ///< of dry rock [kg/s]
    double begin = 0.0, end = 0.0;  ///< [s]
    double velocity_share = 0.5;    ///< c_v: rock starts with c_v (omega x r)
    std::uint64_t seed = 0;         ///< of the places
    std::vector<FeedClass> classes;
};

/// One rock of the schedule, just ahead of a blade.
struct CutRock {
    double time = 0.0;  ///< [s]
    Vec3 position = Vec3::Zero();
    Vec3 velocity = Vec3::Zero();
    std::size_t rock_class = 0;
};

/// Mass rate of dry rock [kg/s] that a cut section gives:  v_h A_cut rho_grain (1 - n).
/// \param swing_speed  v_h [m/s] \param grain_density  [kg/m3] \param porosity  n [-]
double cut_mass_rate(const geometry::CutFace& face, double swing_speed, double grain_density, double porosity);

/// Rock in the order of time, from `begin` to `end`. A leading face that passes a patch of the face takes what the patch gave since the
/// passing before, v_h (n.e_s) times its area. These masses are added up in the order of time, for each class its share, and what does not
/// make a whole rock is carried on: at any time the rock so far is within one rock of each class of what the passings so far took.
/// The seed draws which passing a rock comes with. It starts with its surface 0.05 d within the contour, ahead of the steel by 0.05 d or
/// more, at any height where a leading face exists (the nearest one where the ring or the hub closes the circumference). \throws UserError
/// when no blade has a leading face with room for a rock of some class, or the rocks are too many
std::vector<CutRock> cut_face_schedule(const CutRequest& request, const CuttingHead& head);

}  // namespace cutterflow::cases
