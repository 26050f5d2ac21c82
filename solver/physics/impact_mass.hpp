#pragma once
/// \file How inert a rigid body is to an impact.

namespace cutterflow::physics {

/// Least mass [kg] that a push meets whose line passes a point at the distance s from the centre of mass:  1/(1/M + s^2/I_min).
/// \param mass  M [kg] \param arm  s [m] \param least_moment  I_min, the smallest principal moment of inertia [kg m2]
inline double impact_mass(double mass, double arm, double least_moment) {
    return 1.0 / (1.0 / mass + arm * arm / least_moment);
}

}  // namespace cutterflow::physics
