#pragma once
/// \file The rotor's axis and rotation about it. One source of the rotor angle for the fluid mesh, the DEM walls and the reports.
#include <cmath>

#include <Eigen/Geometry>

#include "geometry/base/vec3.hpp"

namespace cutterflow {

inline constexpr double k_pi = 3.14159265358979323846;

/// Axis of the rotor: a point [m] and a unit direction, from hub to ring (towards the suction side).
struct RotationAxis {
    Vec3 origin = Vec3::Zero();
    Vec3 direction = Vec3::UnitZ();
};

/// Position in the axis' cylindrical frame. radius [m], azimuth [rad] in [0, 2 pi), axial [m] from the axis' origin.
struct Cylindrical {
    double radius = 0.0;
    double azimuth = 0.0;
    double axial = 0.0;
};

/// Point rotated by `angle` [rad], right-handed about the axis.
inline Vec3 rotate_about(const RotationAxis& axis, double angle, const Vec3& point) {
    return axis.origin + Eigen::AngleAxisd(angle, axis.direction) * (point - axis.origin);
}

/// Cylindrical coordinates of `point` with azimuth 0 along `reference` (any vector that is not parallel to the axis;
/// only its part normal to the axis counts), positive by the right hand about the axis.
inline Cylindrical to_cylindrical(const RotationAxis& axis, const Vec3& reference, const Vec3& point) {
    const Vec3 e0 = (reference - axis.direction * axis.direction.dot(reference)).normalized();
    const Vec3 e1 = axis.direction.cross(e0);
    const Vec3 arm = point - axis.origin;
    const double x = arm.dot(e0);
    const double y = arm.dot(e1);
    double azimuth = std::atan2(y, x);
    if (azimuth < 0.0) azimuth += 2.0 * k_pi;
    return {std::hypot(x, y), azimuth, arm.dot(axis.direction)};
}

/// Angular speed [rad/s] of a speed in revolutions per minute.
inline constexpr double rpm_to_rad_s(double rpm) {
    return rpm * 2.0 * k_pi / 60.0;
}

}  // namespace cutterflow
