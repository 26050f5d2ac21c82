#pragma once
/// \file Shear lift on one rock. Slip velocity is always u_fluid - v_rock.
#include "geometry/base/vec3.hpp"
#include "solver/physics/drag.hpp"

namespace cutterflow::physics {

/// McLaughlin's ratio J [-] of the shear lift to Saffman's, in Mei's fit;  eps = sqrt(Re_G)/Re_p:
///   eps < 0.1:   -140 eps^5 ln(eps^-2)
///   up to 20:    0.3 {1 + tanh[2.5 (log10 eps + 0.191)]} {0.667 + tanh[6 (eps - 0.32)]}
///   above 20:    1 - 0.287 eps^-2
/// J(1) = 0.722, J(5) = 0.989. The pieces miss each other by 0.004 at 0.1 and by 0.0008 at 20. [McLaughlin1991, Mei1992]
double shear_lift_ratio(double eps);

/// Lift coefficient [-], of the frontal area and the slip's dynamic pressure:  C_L = 4.11 eps J(eps). [Mei1992]
/// \param particle_reynolds  |slip| d / nu, > 0 \param shear_reynolds  |vorticity| d^2 / nu, >= 0
double mei_lift_coefficient(double particle_reynolds, double shear_reynolds);

using LiftLaw = double (*)(double particle_reynolds, double shear_reynolds);

/// Lift [N]:  (pi/8) C_L rho_f d^2 |slip| (slip x vorticity)/|vorticity|; 0 without slip or vorticity. The coefficient is that of slip
/// normal to the vorticity; the effect of slip along it is neglected. \param vorticity  curl of the fluid's velocity [1/s]
Vec3 lift_force(const RockInFluid& rock, const Vec3& slip, const Vec3& vorticity, LiftLaw lift);

}  // namespace cutterflow::physics
