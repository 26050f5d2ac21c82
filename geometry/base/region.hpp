#pragma once
/// \file Parts of space.
#include <variant>

#include "geometry/base/vec3.hpp"

namespace cutterflow {

/// Along the axes.
struct BoxRegion {
    Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();  ///< opposite corners [m]
};
struct SphereRegion {
    Vec3 centre = Vec3::Zero();  ///< [m]
    double radius = 0.0;         ///< [m]
};
struct CylinderRegion {
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< centres of its ends [m]
    double radius = 0.0;                          ///< [m]
};
/// The side of a plane to which its normal points.
struct HalfSpaceRegion {
    Vec3 point = Vec3::Zero();  ///< [m]
    Vec3 normal = Vec3::UnitZ();
};
struct EverywhereRegion {};

/// A part of space; its boundary belongs to it.
using Region = std::variant<EverywhereRegion, BoxRegion, SphereRegion, CylinderRegion, HalfSpaceRegion>;
bool is_within(const Region& region, const Vec3& point);

}  // namespace cutterflow
