#pragma once
/// \file The springs of a contact that resist slip, all side by side.
#include "solver/liggghts/contacts/contact_law.hpp"

namespace cutterflow::liggghts {

/// What the springs of one contact have in a step.
struct SlipSprings {
    double contact_radius = 0.0;  ///< a [m], above 0
    double width = 0.0;           ///< of the part that a spring covers [m]; the last one covers all beyond
    double stiffness = 0.0;       ///< 8 G* [Pa]: of a spring over the length l_i that it covers
    double damping = 0.0;         ///< min(eta, eta_m) of them all [kg/s], which they share by l_i / a
    double limit = 0.0;           ///< mu F_n [N]
};

/// Adds F_t of contact_force, spring by spring, to `force` [N]. Where the processor has vectors of four doubles (AVX2) they carry the
/// springs; everywhere the same bits. \param slip_velocity  [m/s] \param time_step  [s]; 0 leaves the memory
void add_slip_force(const SlipSprings& springs, const Vec3& normal, const Vec3& slip_velocity, double time_step, SlipMemory& memory,
                    Vec3& force);

}  // namespace cutterflow::liggghts
