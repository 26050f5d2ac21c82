#pragma once
/// \file Closed forms of contacts: wet restitution, Hertz and Rayleigh times, the stiffness for an impact speed.

namespace cutterflow::physics {

/// Impact Stokes number [-] with added mass:  St = (rho_s/rho_f + C_AM) u d / (9 nu). [Legendre2006]
/// \param impact_speed  normal speed at first contact [m/s], >= 0
double impact_stokes(double density_ratio, double added_mass_coefficient, double impact_speed, double diameter, double kinematic_viscosity);

/// Restitution in the fluid [-]:  e_wet = e_dry exp(-35/St); 0 for St = 0. [Legendre2006]
double wet_restitution(double dry_restitution, double stokes);

/// Damping factor alpha [-] of a Hertz contact without tension: the damping force is alpha sqrt(m* k_n) overlap^(1/4) times the normal
/// speed, k_n = 4/3 E* sqrt(R*), until it would outweigh the elastic force. With zeta = alpha/sqrt(5):
///
///   -ln e = 2 zeta acos(zeta) / sqrt(1 - zeta^2)
///
/// This is the linear dashpot's restitution when the contact ends without force [SchwagerPoeschel2007], which the substitution
/// q = overlap^(5/4) carries over to Hertz [AntypovElliott2011]. \param restitution in [k_smallest_restitution, 1]
double hertz_damping_factor(double restitution);

/// Just above that of critical damping, exp(-2). Lower values (2 % of the energy) need damping that the time steps of stiff contacts do not
/// resolve.
inline constexpr double k_smallest_restitution = 0.14;

/// A normal impact of two bodies, as the effective values of Hertz' law.
struct Impact {
    double mass = 0.0;     ///< 1/m* = sum 1/m [kg]
    double radius = 0.0;   ///< 1/R* = sum 1/R [m]
    double modulus = 0.0;  ///< 1/E* = sum (1 - nu^2)/E [Pa]
    double speed = 0.0;    ///< normal, at first contact [m/s]
};

/// Largest overlap [m] without damping:  (15 m* u^2 / (16 E* sqrt(R*)))^(2/5). [AntypovElliott2011]
double hertz_largest_overlap(const Impact& impact);

/// Duration of the contact [s] without damping:  2.9432751 overlap / u = 2.868 (m*^2 / (R* E*^2 u))^(1/5). [AntypovElliott2011]
double hertz_time(const Impact& impact);

/// Rayleigh time [s] of a sphere:  pi R sqrt(rho/G) / (0.1631 nu + 0.8766), G = E / (2 (1 + nu)).
double rayleigh_time(double radius, double density, double youngs_modulus, double poisson_ratio);

/// Young's modulus [Pa] with which a sphere that hits a flat wall at `speed` [m/s] overlaps it by `overlap_ratio` of its radius. From
/// Hertz' largest overlap with m* = 4/3 pi rho R^3, R* = R:  E = (5 pi/4) rho u^2 compliance / overlap_ratio^(5/2). It does not depend on
/// the size. \param inertia_density  rho_s + C_AM rho_f [kg/m3]: the mass that the contact has to stop, added mass included \param
/// compliance  E/E* [-]: 1 - nu^2 for a rigid wall, the sum over both bodies when wall and sphere share E
double youngs_modulus_for_overlap(double inertia_density, double speed, double overlap_ratio, double compliance);

/// The linear contact whose stiffness follows from weight: k_n = m g/(theta l), c_n = 2 a sqrt(m k_n), m the mean mass of a pair or the
/// mass at a wall. [Chen2019] Time step [s]:  (2 pi/gamma) sqrt(m/k_n) = (2 pi/gamma) sqrt(theta l/g)
double linear_contact_step(double theta, double reference_length, double gravity, double steps_per_period);

/// Restitution [-] of a linear spring and dashpot of damping ratio zeta < 1: exp(-pi zeta/sqrt(1 - zeta^2)) when the contact lasts half a
/// period and pulls at its end; exp(-2 zeta acos(zeta)/sqrt(1 - zeta^2)) when it ends as its force does. [SchwagerPoeschel2007]
double linear_restitution(double damping_ratio, bool may_pull);

/// Largest overlap [-] over the radius that the project accepts at the rotor's tip speed.
inline constexpr double k_largest_overlap_ratio = 0.05;

}  // namespace cutterflow::physics
