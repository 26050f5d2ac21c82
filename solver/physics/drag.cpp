#include "solver/physics/drag.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::physics {
namespace {

// Below this Reynolds number Cd Re is constant to rounding; the floor keeps 1/Re and log10(Re) finite at no slip.
constexpr double k_smallest_reynolds = 1e-12;

}  // namespace

double di_felice_exponent(double particle_reynolds) {
    const double distance = 1.5 - std::log10(particle_reynolds);
    return 3.7 - 0.65 * std::exp(-0.5 * distance * distance);
}

double di_felice_factor(double void_fraction, double particle_reynolds) {
    return std::pow(void_fraction, 1.0 - di_felice_exponent(particle_reynolds));
}

double no_hindrance(double /*void_fraction*/, double /*particle_reynolds*/) {
    return 1.0;
}

double drag_coefficient_per_slip(const RockInFluid& rock, double slip_speed, DragLaw drag, HindranceLaw hindrance, double modifier) {
    const double reynolds_per_speed = rock.diameter / rock.kinematic_viscosity, speed_per_reynolds = 1.0 / reynolds_per_speed;
    const double reynolds = std::max(slip_speed * reynolds_per_speed, k_smallest_reynolds);
    // Cd |slip| written with Re, so that no slip gives Stokes' limit instead of infinity times zero.
    const double cd_times_slip = drag({reynolds, rock.void_fraction, rock.sphericity}) * reynolds * speed_per_reynolds;
    const double area = k_pi / 4.0 * rock.diameter * rock.diameter;
    return modifier * 0.5 * rock.fluid_density * area * cd_times_slip * hindrance(rock.void_fraction, rock.void_fraction * reynolds);
}

Vec3 fluid_acceleration_force(double volume, double fluid_density, double added_mass_coefficient, const Vec3& material_acceleration) {
    return (1.0 + added_mass_coefficient) * fluid_density * volume * material_acceleration;
}

Vec3 viscous_force(double volume, double fluid_density, const Vec3& stress_divergence) {
    return volume * fluid_density * stress_divergence;
}

}  // namespace cutterflow::physics
