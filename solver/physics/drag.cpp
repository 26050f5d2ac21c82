#include "solver/physics/drag.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::physics {
namespace {

// Below this Reynolds number Cd Re is constant to rounding; the floor keeps 1/Re and log10(Re) finite at no slip.
constexpr double k_smallest_reynolds = 1e-12;

}  // namespace

double brown_lawler_drag_coefficient(double reynolds) {
    return 24.0 / reynolds * (1.0 + 0.150 * std::pow(reynolds, 0.681)) + 0.407 / (1.0 + 8710.0 / reynolds);
}

double di_felice_exponent(double particle_reynolds) {
    const double distance = 1.5 - std::log10(particle_reynolds);
    return 3.7 - 0.65 * std::exp(-0.5 * distance * distance);
}

double di_felice_factor(double void_fraction, double particle_reynolds) {
    return std::pow(void_fraction, 1.0 - di_felice_exponent(particle_reynolds));
}

double drag_coefficient_per_slip(const RockInFluid& rock, double slip_speed, DragLaw drag, HindranceLaw hindrance, double modifier) {
    const double reynolds = std::max(slip_speed * rock.diameter / rock.kinematic_viscosity, k_smallest_reynolds);
    // Cd |slip| written with Re, so that no slip gives Stokes' limit instead of infinity times zero.
    const double cd_times_slip = drag(reynolds) * reynolds * rock.kinematic_viscosity / rock.diameter;
    const double area = k_pi / 4.0 * rock.diameter * rock.diameter;
    return modifier * 0.5 * rock.fluid_density * area * cd_times_slip * hindrance(rock.void_fraction, rock.void_fraction * reynolds);
}

double sphere_volume(double diameter) {
    return k_pi / 6.0 * diameter * diameter * diameter;
}

Vec3 fluid_acceleration_force(double volume, double fluid_density, double added_mass_coefficient, const Vec3& material_acceleration) {
    return (1.0 + added_mass_coefficient) * fluid_density * volume * material_acceleration;
}

}  // namespace cutterflow::physics
