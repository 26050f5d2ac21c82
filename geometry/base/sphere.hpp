#pragma once
/// \file A rock's shape: volume, mass and inertia of a sphere.
#include "geometry/base/axis_frame.hpp"

namespace cutterflow {

/// Volume of a sphere [m3]:  pi/6 d^3.
inline constexpr double sphere_volume(double diameter) {
    return k_pi / 6.0 * diameter * diameter * diameter;
}

/// Mass of a sphere [kg] of uniform density [kg/m3].
inline constexpr double sphere_mass(double diameter, double density) {
    return density * sphere_volume(diameter);
}

/// Moment of inertia [kg m2] of a uniform sphere about its centre:  m d^2/10.
inline constexpr double sphere_inertia(double diameter, double mass) {
    return 0.1 * mass * diameter * diameter;
}

}  // namespace cutterflow
