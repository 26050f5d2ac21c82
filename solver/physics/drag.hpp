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

/// Drag coefficient of a single sphere [-]:  Cd = 24/Re (1 + 0.150 Re^0.681) + 0.407 / (1 + 8710/Re). Valid for Re <= 2e5.
/// [BrownLawler2003]
double brown_lawler_drag_coefficient(const DragState& state);

/// Drag coefficient of a single sphere [-]:  Cd = 24/Re (1 + 0.15 Re^0.687) below Re = 1000, 0.44 from there on (it jumps up by 0.4 %
/// there). [SchillerNaumann1935]
double schiller_naumann_drag_coefficient(const DragState& state);

/// Drag coefficient of a single rock of sphericity psi [-], with diameter and frontal area of the sphere of equal volume:
///   Cd = 24/Re (1 + A Re^B) + C / (1 + D/Re),  A = 8.1716 e^(-4.0655 psi), B = 0.0964 + 0.5565 psi, C = 73.69 e^(-5.0748 psi),
///   D = 5.378 e^(6.2122 psi). [HaiderLevenspiel1989]
double haider_levenspiel_drag_coefficient(const DragState& state);

/// Gidaspow's law, which contains the void fraction a, as a drag coefficient of one rock [-] in the sense of drag_coefficient_per_slip
/// (with hindrance 1). The published momentum exchange coefficient belongs to the form in which the fluid feels a grad p (model A); with
/// the full pressure gradient and buoyancy in pure fluid (model B, the solver's form) the force on rock is that over a:
///   a <= 0.8, Ergun:   Cd = 4/3 (150 (1 - a) / (a^2 Re) + 1.75/a)
///   a >  0.8, Wen-Yu:  Cd = Cd0(a Re) a^(-2.65), Cd0 of Schiller and Naumann
/// The two differ where they meet: by 15 % in creeping flow, by a factor 3.7 at high Re. [Gidaspow1994]
double gidaspow_drag_coefficient(const DragState& state);

/// Koch's and Hill's law, as gidaspow_drag_coefficient in the form for the full pressure gradient; with the solid fraction s = 1 - a:
///   Cd = 24/Re a (F0 + F3 a Re / 2),  F3 = 0.0673 + 0.212 s + 0.0232/a^5,
///   F0 = [1 + 3 sqrt(s/2) + 135/64 s ln s + 16.14 s] / [1 + 0.681 s - 8.48 s^2 + 8.16 s^3] for s < 0.4, 10 s/a^3 from there on.
/// [KochHill2001]
double koch_hill_drag_coefficient(const DragState& state);

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
