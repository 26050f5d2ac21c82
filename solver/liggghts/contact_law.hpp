#pragma once
/// \file The contact law: Hertz-Mindlin with damping, a pure function of one contact at one instant.
#include "geometry/base/vec3.hpp"

namespace cutterflow::liggghts {

/// Elastic constants of a pair of materials of the same Young's modulus E.
struct ElasticPair {
    double youngs = 0.0;  ///< E* [Pa], 1/E* = sum (1 - nu^2)/E
    double shear = 0.0;   ///< G* [Pa], 1/G* = sum (2 - nu)/G with G = E / (2 (1 + nu))
};

/// \see seeds S0-18, S0-19
ElasticPair elastic_pair(double youngs_modulus, double poisson_a, double poisson_b);

struct Contact {
    Vec3 normal = Vec3::Zero();         ///< unit, from the other body towards the rock
    double overlap = 0.0;               ///< delta [m], >= 0
    double normal_speed = 0.0;          ///< [m/s], positive when separating
    Vec3 slip_velocity = Vec3::Zero();  ///< tangential velocity of the rock's surface relative to the other's [m/s]
    double radius = 0.0;                ///< R* [m], 1/R* = sum 1/R
    double mass = 0.0;                  ///< m* [kg], 1/m* = sum 1/m, masses with added mass
    ElasticPair elastic;
    double damping_factor = 0.0;  ///< alpha [-], from the restitution (physics::hertz_damping_factor)
    double friction = 0.0;        ///< mu [-]
};

/// Force [N] on the rock:
///
///   F_n = (k_n delta - eta u_n) n,  k_n = 4/3 E* sqrt(R* delta),  eta = alpha sqrt(m* k_n)
///   F_t = -k_t s - eta u_t,  k_t = 8 G* sqrt(R* delta),  |F_t| <= mu |F_n|
///
/// The normal force may pull at the end of a contact, as the derivation of alpha assumes. The spring s follows from u_t over `time_step`
/// and stays in the tangential plane; while the contact slides it carries the limit alone. \param time_step  [s]; 0 evaluates the force and
/// leaves the spring \param spring     s [m], updated \see seeds S0-18 to S0-20
Vec3 contact_force(const Contact& contact, double time_step, Vec3& spring);

}  // namespace cutterflow::liggghts
