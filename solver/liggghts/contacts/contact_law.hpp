#pragma once
/// \file The contact law: Hertz-Mindlin with micro-slip and damping, a pure function of one contact, its memory and one time step.
#include "geometry/base/vec3.hpp"

namespace cutterflow::liggghts {

/// Elastic constants of a pair of materials of the same Young's modulus E.
struct ElasticPair {
    double youngs = 0.0;  ///< E* [Pa], 1/E* = sum (1 - nu^2)/E
    double shear = 0.0;   ///< G* [Pa], 1/G* = sum (2 - nu)/G with G = E / (2 (1 + nu))
};

/// Effective constants of a pair. [NieuwboerVanRheeKeetels2023]
ElasticPair elastic_pair(double youngs_modulus, double poisson_a, double poisson_b);

struct Contact {
    Vec3 normal = Vec3::Zero();         ///< unit, from the other body towards the rock
    double overlap = 0.0;               ///< delta [m], >= 0
    double normal_speed = 0.0;          ///< [m/s], positive when separating
    double impact_speed = 0.0;          ///< normal speed at the first touch [m/s]
    Vec3 slip_velocity = Vec3::Zero();  ///< tangential velocity of the rock's surface relative to the other's [m/s]
    double radius = 0.0;                ///< R* [m], 1/R* = sum 1/R
    double mass = 0.0;                  ///< m* [kg], 1/m* = sum 1/m, masses with added mass
    ElasticPair elastic;
    double damping_factor = 0.0;  ///< alpha [-], from the restitution (physics::hertz_damping_factor)
    double friction = 0.0;        ///< mu [-]
};

/// Springs that share a contact's area, each of which sticks or slips independently. With 4 an oblique impact is within 1 % of 64 springs.
inline constexpr int k_springs = 4;

/// History of a contact's tangential motion; only doubles, because LIGGGHTS stores them in its histories.
struct SlipMemory {
    double contact_radius = 0.0;        ///< a of the previous step [m]
    double stretch[k_springs][3] = {};  ///< s of each spring [m]
};

/// Force [N] on the rock, with the contact's radius a = sqrt(R* delta):
///
///   F_n = max(0, k_n delta - eta u_n) n,  k_n = 4/3 E* a,  eta = alpha sqrt(m* k_n)
///   F_t = sum over springs of -k_i s_i - eta_i u_t, each at most mu |F_n| p_i,  k_i = 8 G* l_i,  eta_i = eta l_i / a
///
/// Spring i covers the part l_i of (0, a) from i to i + 1 quarters of the radius that the impact reaches, the last one all beyond, and
/// bears the share p_i of Hertz' pressure; so slip begins at the edge and works inwards (Cattaneo and Mindlin), and the sums are Mindlin's
/// stiffness 8 G* a and Coulomb's limit. This is the method of dimensionality reduction, exact as the springs become many while slip keeps
/// its line [PopovHess2015]. Newly touched area begins without stretch and separating area takes its force away, so that no history creates
/// energy. \param time_step  [s]; 0 evaluates the force and leaves the memory unchanged. [AntypovElliott2011, NieuwboerVanRheeKeetels2023]
Vec3 contact_force(const Contact& contact, double time_step, SlipMemory& memory);

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
/// F_n is at least 0 unless it may pull. Of memory the first spring is used, s. What slips carries the limit in the spring. [Chen2019]
/// \param time_step  [s]; 0 evaluates the force and leaves the memory
Vec3 linear_contact_force(const LinearLaw& law, const Contact& contact, double time_step, SlipMemory& memory);

}  // namespace cutterflow::liggghts
