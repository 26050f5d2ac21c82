#pragma once
/// \file The contact law: Hertz-Mindlin with micro-slip and damping, a pure function of one contact, its memory and one time step.
#include <limits>

#include "geometry/base/vec3.hpp"

namespace cutterflow::liggghts {

/// Elastic constants of a pair of materials of the same Young's modulus E.
struct ElasticPair {
    double youngs = 0.0;  ///< E* [Pa], 1/E* = sum (1 - nu^2)/E
    double shear = 0.0;   ///< G* [Pa], 1/G* = sum (2 - nu)/G with G = E / (2 (1 + nu))
};

/// Effective constants of a pair. [NieuwboerVanRheeKeetels2023]
ElasticPair elastic_pair(double youngs_modulus, double poisson_a, double poisson_b);

/// Radius [m] that a contact reaches in an impact without damping:  sqrt(R* delta_max), delta_max Hertz' largest overlap.
/// \param radius  R* [m] \param mass  m* [kg] \param speed  normal, at the first touch [m/s] [AntypovElliott2011]
double impact_radius(const ElasticPair& elastic, double radius, double mass, double speed);

struct Contact {
    Vec3 normal = Vec3::Zero();         ///< unit, from the other body towards the rock
    double overlap = 0.0;               ///< delta [m], >= 0
    double normal_speed = 0.0;          ///< [m/s], positive when separating
    double impact_radius = 0.0;         ///< radius that the contact reaches in its impact [m], see impact_radius
    Vec3 slip_velocity = Vec3::Zero();  ///< tangential velocity of the rock's surface relative to the other's [m/s]
    double radius = 0.0;                ///< R* [m], 1/R* = sum 1/R
    double mass = 0.0;                  ///< m* [kg], 1/m* = sum 1/m, masses with added mass
    ElasticPair elastic;
    bool begins = false;            ///< the bodies first touched within this time step
    double damping_factor = 0.0;    ///< alpha [-], from the restitution (physics::hertz_damping_factor)
    double friction = 0.0;          ///< mu [-]
    double rolling_friction = 0.0;  ///< mu_r [-]
    double most_slip_damping = std::numeric_limits<double>::infinity();  ///< [kg/s], see resolved_slip_damping
};

/// Largest damping [kg/s] of slip that a time step resolves: m*/(20 dt). Damping eta on the lever R takes the spin of a sphere with 2/3 eta
/// R^2 per contact from 2/5 m R^2; between z contacts of equal spheres that spin against each other that is a rate of 20 z/12 eta/m*. The
/// limit keeps the rate times dt at 1 for z = 12; at 2 an explicit step adds energy.
inline double resolved_slip_damping(double mass, double time_step) {
    return mass / (20.0 * time_step);
}

/// Springs that share a contact's area, each of which sticks or slips independently. With 4 an oblique impact is within 1 % of 64 springs.
inline constexpr int k_springs = 4;

/// History of a contact's tangential motion; only doubles, because LIGGGHTS stores them in its histories.
struct SlipMemory {
    double contact_radius = 0.0;        ///< a of the previous step [m]
    double stretch[3][k_springs] = {};  ///< s [m]: x of all springs, then y, then z

    Vec3 stretch_of(int spring) const { return {stretch[0][spring], stretch[1][spring], stretch[2][spring]}; }
    void set_stretch(int spring, const Vec3& value) {
        for (int axis = 0; axis < 3; ++axis) stretch[axis][spring] = value[axis];
    }
};

/// Force [N] on the rock, with the contact's radius a = sqrt(R* delta):
///
///   F_n = max(0, k_n delta - eta u_n) n,  k_n = 4/3 E* a,  eta = alpha sqrt(m* k_n)
///   F_t = sum over springs of -k_i s_i - eta_i u_t, each at most mu |F_n| p_i,  k_i = 8 G* l_i,  eta_i = min(eta, eta_m) l_i / a
///
/// eta_m is most_slip_damping. In the step of the first touch eta counts 1/2 + 4/5 tau, tau = delta/(|u_n| dt) the part of the step after
/// the touch: damping sets in with delta^(1/4) and acts from the touch to the middle of the next step. Counted as 1, the restitution of an
/// impact would depend on where in a step it begins, by up to 0.7 % at e = 0.5 and steps of a tenth of the Rayleigh time.
/// Spring i covers the part l_i of (0, a) from i to i + 1 quarters of the radius that the impact reaches, the last one all beyond, and
/// bears the share p_i of Hertz' pressure; so slip begins at the edge and works inwards (Cattaneo and Mindlin), and the sums are Mindlin's
/// stiffness 8 G* a and Coulomb's limit. This is the method of dimensionality reduction, exact as the springs become many while slip keeps
/// its line [PopovHess2015]. Newly touched area begins without stretch and separating area takes its force away, so that no history creates
/// energy. \param time_step  [s]; 0 evaluates the force and leaves the memory unchanged. [AntypovElliott2011, NieuwboerVanRheeKeetels2023]
Vec3 contact_force(const Contact& contact, double time_step, SlipMemory& memory);

enum class RollingLaw {
    spring,   ///< a spring up to the largest couple
    constant  ///< the largest couple at any rolling; a contact that should rest creeps
};

/// How two bodies turn over each other.
struct Rolling {
    Vec3 spin = Vec3::Zero();  ///< of the rock relative to the other body [rad/s]
    double twist = 0.0;        ///< mean spin of both along the normal [rad/s]
    double inertia = 0.0;      ///< I_r [kg m2], 1/I_r = sum 1/(I + m R^2): each about the point that touches
    double most_damping = std::numeric_limits<double>::infinity();  ///< [kg m2/s], see resolved_roll_damping
};

/// Largest damping [kg m2/s] of rolling that a time step resolves: I_r/(28 dt), as resolved_slip_damping with a rate of 28 z/12 eta_r/I_r.
inline double resolved_roll_damping(double inertia, double time_step) {
    return inertia / (28.0 * time_step);
}

/// History of a contact's rolling; only doubles, as SlipMemory.
struct RollMemory {
    double contact_radius = 0.0;  ///< a of the previous step [m]
    double angle[3] = {};         ///< theta [rad], in the tangent plane
};

/// Couple [N m] on the rock against rolling; the other body gets its opposite. With omega_r the relative spin without its part along the
/// normal and T_max = mu_r F_n R*:
///
///   spring:    T = -k_r theta - eta_r omega_r, |T| <= T_max,  k_r = 8 G* a R*^2,  eta_r = 2 zeta sqrt(I_r k_r), zeta = 0.3,
///              eta_r at most most_damping
///   constant:  T = -T_max omega_r/|omega_r|
///
/// theta grows by omega_r per time, turns with the normal and about it with the mean spin of both bodies; k_r is Mindlin's stiffness on the
/// lever R*. What rolls on carries T_max in the spring and no damping. As with slip, a growing contact keeps its couple and a shrinking one
/// loses some, so that no history creates energy. [Ai2011, IwashitaOda1998]
/// \param normal_force  F_n [N] \param time_step  [s]; 0 evaluates the couple and leaves the memory
Vec3 rolling_couple(RollingLaw law, const Contact& contact, const Rolling& rolling, double normal_force, double time_step,
                    RollMemory& memory);

/// Constants of the linear law, per mass of a contact.
struct LinearLaw {
    double stiffness = 0.0;         ///< k_n/m = g/(theta l) [1/s2]
    double damping = 0.0;           ///< a [-]
    double shear = 0.0;             ///< k_t/k_n = 1/(2 (1 + psi)) [-]
    bool accumulated_shear = true;  ///< else the spring is stretched by the slip of one step
    bool may_pull = false;
};

/// Force [N] on the rock by the linear law, m = contact.mass the mean mass of a pair or the mass at a wall:
///
///   F_n = k_n delta - c_n u_n,   F_t = -(k_t s + c_t u_t), |F_t| <= mu |F_n|,   c_n = 2 a sqrt(m k_n),   c_t = c_n/sqrt(2 (1 + psi))
///
/// F_n is at least 0 unless it may pull. Of memory the first spring is used, s. What slips carries the limit in the spring. In the step of
/// the first touch c counts 1/2 + tau, tau = delta/(|u_n| dt) the part of the step after the touch, and where a force that may pull ends
/// within the next step, 1/2 + the part of that step before the end. [Chen2019]
/// \param time_step  [s]; 0 evaluates the force and leaves the memory
Vec3 linear_contact_force(const LinearLaw& law, const Contact& contact, double time_step, SlipMemory& memory);

}  // namespace cutterflow::liggghts
