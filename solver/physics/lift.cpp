#include "solver/physics/lift.hpp"

#include <cmath>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::physics {

double shear_lift_ratio(double eps) {
    if (eps < 0.1) return eps > 0.0 ? 280.0 * std::pow(eps, 5) * std::log(eps) : 0.0;
    if (eps > 20.0) return 1.0 - 0.287 / (eps * eps);
    return 0.3 * (1.0 + std::tanh(2.5 * (std::log10(eps) + 0.191))) * (0.667 + std::tanh(6.0 * (eps - 0.32)));
}

double mei_lift_coefficient(double particle_reynolds, double shear_reynolds) {
    const double eps = std::sqrt(shear_reynolds) / particle_reynolds;
    return 4.11 * eps * shear_lift_ratio(eps);
}

Vec3 lift_force(const RockInFluid& rock, const Vec3& slip, const Vec3& vorticity, LiftLaw lift) {
    const double speed = slip.norm(), rate = vorticity.norm(), d = rock.diameter;
    if (speed * rate == 0.0) return Vec3::Zero();
    const double coefficient = lift(speed * d / rock.kinematic_viscosity, rate * d * d / rock.kinematic_viscosity);
    return k_pi / 8.0 * coefficient * rock.fluid_density * d * d * speed * slip.cross(vorticity) / rate;
}

}  // namespace cutterflow::physics
