#pragma once
/// \file A clump: overlapping spheres that move as one rigid rock.
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "geometry/base/error.hpp"
#include "geometry/base/vec3.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

struct Ball {
    Vec3 centre = Vec3::Zero();  ///< [m]
    double radius = 0.0;         ///< [m]
};

/// The rock is the union of the balls, of one density: room that two balls share counts once.
struct Clump {
    std::vector<Ball> balls;
    std::optional<double> sphericity{};  ///< of the rock that the clump stands for [-], for drag laws that use it
};

/// Areas of a solid's shadows.
struct ShadowAreas {
    double smallest = 0.0, largest = 0.0;  ///< [m2]
};

/// What a rigid body's motion and drag need of its shape. The principal frame has its origin in the centroid.
struct ClumpProperties {
    double volume = 0.0;                                 ///< [m3]
    double equivalent_diameter = 0.0;                    ///< of the sphere of this volume [m]
    Vec3 centroid = Vec3::Zero();                        ///< [m]
    Vec3 principal_moments = Vec3::Zero();               ///< per density, about the centroid, ascending [m5]
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: right-handed principal axes, in the order of the moments
    ShadowAreas shadow;
};

/// What is wrong with a clump: no ball, sizes that are not positive or finite, balls within others, parts that do not overlap.
std::vector<Mistake> clump_mistakes(const Clump& clump);

/// Volume, centroid and inertia of the union, of density 1, to 1e-7. Each cross-section is a union of discs, whose moments are exact; their
/// integral over z goes by Gauss' rule from one height to the next at which the section's boundary changes its pieces, with
/// z = m + h sin(pi u/2), which takes the square roots at both ends away. \pre no mistakes
MassProperties union_mass_properties(const Clump& clump);

/// Area [m2] of the shadow along a unit vector, exact to rounding.
double shadow_area(const Clump& clump, const Vec3& direction);

/// Smallest and largest shadow: the best of 2,000 even directions, improved until it turns by less than 1e-6 rad. A second extreme that is
/// deeper than the one found by less than 1e-3 of the area may be missed.
ShadowAreas extreme_shadows(const Clump& clump);

/// Principal moments and axes of a body.
struct PrincipalInertia {
    Vec3 moments = Vec3::Zero();                         ///< per density, ascending [m5]
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: right-handed, in the order of the moments
};

PrincipalInertia principal_inertia(const MassProperties& mass);

ClumpProperties clump_properties(const Clump& clump);

}  // namespace cutterflow::geometry
