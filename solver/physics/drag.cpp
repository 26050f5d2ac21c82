#include "solver/physics/drag.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::physics {
namespace {

// Below this Reynolds number Cd Re is constant to rounding; the floor keeps 1/Re and log10(Re) finite at no slip.
constexpr double k_smallest_reynolds = 1e-12;

}  // namespace

double brown_lawler_drag_coefficient(const DragState& state) {
    const double re = state.reynolds;
    return 24.0 / re * (1.0 + 0.150 * std::pow(re, 0.681)) + 0.407 / (1.0 + 8710.0 / re);
}

double schiller_naumann_drag_coefficient(const DragState& state) {
    const double re = state.reynolds;
    return re < 1000.0 ? 24.0 / re * (1.0 + 0.15 * std::pow(re, 0.687)) : 0.44;
}

double haider_levenspiel_drag_coefficient(const DragState& state) {
    const double re = state.reynolds, psi = state.sphericity;
    const double a = 8.1716 * std::exp(-4.0655 * psi), b = 0.0964 + 0.5565 * psi;
    const double c = 73.69 * std::exp(-5.0748 * psi), d = 5.378 * std::exp(6.2122 * psi);
    return 24.0 / re * (1.0 + a * std::pow(re, b)) + c / (1.0 + d / re);
}

double gidaspow_drag_coefficient(const DragState& state) {
    const double re = state.reynolds, a = state.void_fraction;
    if (a <= 0.8) return 4.0 / 3.0 * (150.0 * (1.0 - a) / (a * a * re) + 1.75 / a);
    return schiller_naumann_drag_coefficient({a * re}) * std::pow(a, -2.65);
}

double koch_hill_drag_coefficient(const DragState& state) {
    const double re = state.reynolds, a = state.void_fraction, s = 1.0 - a;
    const double s_log_s = s > 0.0 ? s * std::log(s) : 0.0;
    const double dilute =
        (1.0 + 3.0 * std::sqrt(0.5 * s) + 135.0 / 64.0 * s_log_s + 16.14 * s) / (1.0 + 0.681 * s - 8.48 * s * s + 8.16 * s * s * s);
    const double f0 = s < 0.4 ? dilute : 10.0 * s / std::pow(a, 3);
    const double f3 = 0.0673 + 0.212 * s + 0.0232 / std::pow(a, 5);
    return 24.0 / re * a * (f0 + 0.5 * f3 * a * re);
}

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
    const double reynolds = std::max(slip_speed * rock.diameter / rock.kinematic_viscosity, k_smallest_reynolds);
    // Cd |slip| written with Re, so that no slip gives Stokes' limit instead of infinity times zero.
    const double cd_times_slip =
        drag({reynolds, rock.void_fraction, rock.sphericity}) * reynolds * rock.kinematic_viscosity / rock.diameter;
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
