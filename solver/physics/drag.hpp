#pragma once
/// \file Hydrodynamic closures of one rock: drag, hindrance, added mass, acceleration of the fluid. Slip velocity is always u_fluid -
/// v_rock.
#include "geometry/base/vec3.hpp"

namespace cutterflow::physics {

/// Drag coefficient of a single sphere [-]:  Cd = 24/Re (1 + 0.150 Re^0.681) + 0.407 / (1 + 8710/Re),
/// \param reynolds  |slip| d / nu [-], > 0, without the void fraction. Valid for Re <= 2e5. [BrownLawler2003]
double brown_lawler_drag_coefficient(double reynolds);

/// Di Felice's exponent [-]:  beta = 3.7 - 0.65 exp(-(1.5 - log10 Re_p)^2 / 2).
/// \param particle_reynolds  void_fraction |slip| d / nu [-], > 0. [DiFelice1994]
double di_felice_exponent(double particle_reynolds);

/// Factor [-] by which the drag of a rock grows among others:  void_fraction^(1 - beta), for the momentum equation with the full pressure
/// gradient and a force balance with buoyancy in pure fluid. \param void_fraction in (0, 1], \param particle_reynolds with the void
/// fraction. [DiFelice1994, NieuwboerVanRheeKeetels2023]
double di_felice_factor(double void_fraction, double particle_reynolds);

/// What the surrounding fluid and the rock bring into its force.
struct RockInFluid {
    double diameter = 0.0;             ///< [m]
    double fluid_density = 0.0;        ///< [kg/m3]
    double kinematic_viscosity = 0.0;  ///< [m2/s]
    double void_fraction = 1.0;        ///< [-]
};

/// Drag laws of a single sphere and hindrance laws, as the catalogue holds them.
using DragLaw = double (*)(double reynolds);
using HindranceLaw = double (*)(double void_fraction, double particle_reynolds);

/// Drag per slip velocity D [kg/s], so that the force is D * slip_velocity:
///   D = modifier rho_f (pi/8) d^2 Cd(Re) |slip| hindrance(void_fraction, void_fraction Re).
/// Tends to Stokes' 3 pi mu d (times hindrance) for no slip at all.
double drag_coefficient_per_slip(const RockInFluid& rock, double slip_speed, DragLaw drag, HindranceLaw hindrance, double modifier = 1.0);

/// Volume of a sphere [m3].
double sphere_volume(double diameter);

/// Force [N] on a rock in accelerating fluid:  (1 + C_AM) rho_f V Du/Dt: the pressure gradient of the accelerating fluid and the part of
/// added mass that follows the fluid. The other part, -C_AM rho_f V dv/dt, stands in the rock's inertia. [NieuwboerVanRheeKeetels2023]
Vec3 fluid_acceleration_force(double volume, double fluid_density, double added_mass_coefficient, const Vec3& material_acceleration);

/// Added mass coefficient of a sphere in unbounded potential flow [-]. [NieuwboerVanRheeKeetels2023]
inline constexpr double k_sphere_added_mass = 0.5;

}  // namespace cutterflow::physics
