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
    std::uint64_t seed = 0;         ///< of the places
    std::vector<FeedClass> classes;
};

/// One rock of the schedule.
struct CutRock {
    double time = 0.0;         ///< [s]
    std::vector<Vec3> places;  ///< just ahead of a blade; the first one at the contour, those after it farther inwards
    std::size_t rock_class = 0;
};

/// Rock of a cut face.
struct CutSchedule {
    std::vector<CutRock> rocks;        ///< in the order of time
    double share_without_blade = 0.0;  ///< of the cut face's flux: at heights where the steel closes the circumference
};

/// Mass rate of dry rock [kg/s] that a cut section gives:  v_h A_cut rho_grain (1 - n).
/// \param swing_speed  v_h [m/s] \param grain_density  [kg/m3] \param porosity  n [-]
double cut_mass_rate(const geometry::CutFace& face, double swing_speed, double grain_density, double porosity);

/// Rock in the order of time, from `begin` to `end`. A leading face that passes a patch of the face takes what the patch gave since the
/// passing before, v_h (n.e_s) times its area. These masses are added up in the order of time, for each class its share, and what does not
/// make a whole rock is carried on: at any time the rock so far is within one rock of each class of what the passings so far took.
/// The seed draws which passing a rock comes with. Its place has its surface 0.05 d within the contour, ahead of the steel by 0.05 d or
/// more, at a height where a leading face exists: rock of patches where the ring or the hub closes the circumference goes in as far within
/// the nearest such height as it was cut beyond it. For rock that finds its place taken there are more, by whole diameters farther inwards,
/// to half the contour's radius or to where the blade ends. d is the diameter of the sphere around a rock, whatever its orientation.
/// \throws UserError  when no blade has a leading face with room for a rock of some class, or the rocks are too many
CutSchedule cut_face_schedule(const CutRequest& request, const CuttingHead& head);

}  // namespace cutterflow::cases
