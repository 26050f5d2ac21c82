#pragma once
/// \file Hydrodynamic closures of one rock: drag, hindrance, added mass, acceleration of the fluid. Slip velocity is always u_fluid -
/// v_rock.
#include "geometry/base/vec3.hpp"

namespace cutterflow::physics {

/// Arguments of a drag law.
struct DragState {
    double reynolds = 0.0;       ///< |slip| d / nu [-], > 0, without the void fraction
    double void_fraction = 1.0;  ///< [-]
    double sphericity = 1.0;     ///< surface of the sphere of equal volume over that of the rock [-]
};

/// Di Felice's exponent [-]:  beta = 3.7 - 0.65 exp(-(1.5 - log10 Re_p)^2 / 2).
/// \param particle_reynolds  void_fraction |slip| d / nu [-], > 0. [DiFelice1994]
double di_felice_exponent(double particle_reynolds);

/// Factor [-] by which the drag of a rock grows among others:  void_fraction^(1 - beta), for the momentum equation with the full pressure
/// gradient and a force balance with buoyancy in pure fluid. \param void_fraction in (0, 1], \param particle_reynolds with the void
/// fraction. [DiFelice1994, NieuwboerVanRheeKeetels2023]
double di_felice_factor(double void_fraction, double particle_reynolds);

/// Hindrance of drag laws that contain the void fraction, and of single rock [-]: 1.
double no_hindrance(double void_fraction, double particle_reynolds);

/// Properties of rock and surrounding fluid that determine the force.
struct RockInFluid {
    double diameter = 0.0;             ///< [m]
    double fluid_density = 0.0;        ///< [kg/m3]
    double kinematic_viscosity = 0.0;  ///< [m2/s]
    double void_fraction = 1.0;        ///< [-]
    double sphericity = 1.0;           ///< [-]
};

/// Drag and hindrance laws, as the catalogue holds them.
using DragLaw = double (*)(const DragState& state);
using HindranceLaw = double (*)(double void_fraction, double particle_reynolds);

/// Drag per slip velocity D [kg/s], so that the force is D * slip_velocity:
///   D = modifier rho_f (pi/8) d^2 Cd(Re, void_fraction, sphericity) |slip| hindrance(void_fraction, void_fraction Re).
/// Tends to Stokes' 3 pi mu d (times hindrance) for no slip at all.
double drag_coefficient_per_slip(const RockInFluid& rock, double slip_speed, DragLaw drag, HindranceLaw hindrance, double modifier = 1.0);

/// Force [N] on a rock in accelerating fluid:  (1 + C_AM) rho_f V Du/Dt: the pressure gradient of the accelerating fluid and the part of
/// added mass that follows the fluid. The other part, -C_AM rho_f V dv/dt, is part of the rock's inertia. [NieuwboerVanRheeKeetels2023]
Vec3 fluid_acceleration_force(double volume, double fluid_density, double added_mass_coefficient, const Vec3& material_acceleration);

/// The part of the undisturbed flow's stress on a rock that is viscous [N]:  V rho_f div(tau), tau = nu (grad u + grad u^T) less its
/// trace's part. By Navier-Stokes V (-grad p + rho_f div(tau)) = rho_f V (Du/Dt - g), so fluid_acceleration_force holds it: it must not be
/// added to that force; less it, that force is the pressure gradient's alone. \param stress_divergence  div(tau) [m/s2]
Vec3 viscous_force(double volume, double fluid_density, const Vec3& stress_divergence);

/// Added mass coefficient of a sphere in unbounded potential flow [-]. [NieuwboerVanRheeKeetels2023]
inline constexpr double k_sphere_added_mass = 0.5;

}  // namespace cutterflow::physics
