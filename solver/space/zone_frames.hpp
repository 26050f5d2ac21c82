#pragma once
/// \file The two zones of the mesh and the change between their frames.
#include <array>
#include <cstddef>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::coupling {

/// Zones of the mesh; steel and cells do not move in their zone's frame. The stator's frame is the absolute one.
enum Zone : std::size_t { stator = 0, rotor = 1 };
inline constexpr std::array<Zone, 2> k_zones{stator, rotor};

/// Positions of both zones at one rotor angle.
class ZoneFrames {
public:
    ZoneFrames() = default;
    ZoneFrames(const RotationAxis& axis, double angle)
        : origin_(axis.origin), to_absolute_(Eigen::AngleAxisd(angle, axis.direction)), to_rotor_(to_absolute_.transpose()) {}

    /// A point [m] given in the frame of `from`, in the frame of `to`.
    Vec3 change(Zone from, Zone to, const Vec3& point) const {
        if (from == to) return point;
        return origin_ + (to == rotor ? to_rotor_ : to_absolute_) * (point - origin_);
    }
    Vec3 from_absolute(Zone to, const Vec3& point) const { return change(stator, to, point); }
    Vec3 to_absolute(Zone from, const Vec3& point) const { return change(from, stator, point); }

private:
    Vec3 origin_ = Vec3::Zero();
    Eigen::Matrix3d to_absolute_ = Eigen::Matrix3d::Identity();
    Eigen::Matrix3d to_rotor_ = Eigen::Matrix3d::Identity();
};

}  // namespace cutterflow::coupling
