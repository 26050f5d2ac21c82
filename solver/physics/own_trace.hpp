#pragma once
/// \file What a rock that samples the fluid where it is laid sees of itself: its own solid, the water that makes way for it, its wake. All
/// of a kernel of width sigma with which a rock both deposits and samples, gaussian_weight() over its integral. The drag laws are of the
/// slip against the fluid that the rock does not disturb.
///
/// A rock of volume V with the drag F = D s (s the slip that it sees) in an even stream: linearised about the stream, the fluid's velocity
/// in Fourier space is  -F (1 - c^2) g / (rho (nu k^2 + i |s| k c)) + c^2 phi s,  c the cosine of wave and slip, phi = V g. Averaged with
/// the kernel once more, where c^2 averages to 1/3:
///   own solid fraction   phi_own = V sum(w psi)
///   slip by the wake     s F / (|s| (I_1^-1 mu sigma + I_2^-1 rho |s| sigma^2)), the exact limits of small and large |s| sigma / nu
///   slip by making way   -s phi_own / 3
///   acceleration         -(2/3) F sum(w psi) / rho, of the share of the wake that inertia makes
/// Steady: a wake grows in sigma / |s|. [Balachandar2019]
#include <cmath>

#include "geometry/base/vec3.hpp"

namespace cutterflow::physics {

/// Of the kernel g, sigma = 1, F along one axis: integral of g g' / (6 pi |x - x'|), the mean velocity in a Stokes flow of viscosity 1.
inline constexpr double k_own_stokes_velocity = 0.0337875;
/// Half the integral of g, projected along the stream, squared: the mean velocity in a wake without viscosity at unit speed and density.
inline constexpr double k_own_wake_velocity = 0.0500125;

/// Share of its own trace that a rock among others must not see:  S = (1 - phi)^4 / (1 + 2 phi)^2, the structure factor of hard spheres for
/// waves longer than their spacing. 1 for a rock alone; near 0 in a bed, where the others leave out as much around a rock as it adds, and
/// the mean of all, which laws of beds are of, has its trace in it. \param solid_fraction  of the others [-], in [0, 1). [Wertheim1963]
inline double own_trace_share(double solid_fraction) {
    const double free = 1.0 - solid_fraction, crowd = 1.0 + 2.0 * solid_fraction;
    return free * free * free * free / (crowd * crowd);
}

/// What a rock is to add to the flow that it sampled.
struct OwnTrace {
    Vec3 velocity = Vec3::Zero();      ///< [m/s]
    Vec3 acceleration = Vec3::Zero();  ///< [m/s2]
};

/// Of a rock alone, see above. \param slip  u_seen - v [m/s], \param drag_per_slip  D [kg/s], \param overlap  sum over cells of deposit and
/// sampling weight times volume [1/m3], \param width  sigma [m]
inline OwnTrace own_trace(const Vec3& slip, double drag_per_slip, double rock_volume, double overlap, double width, double fluid_density,
                          double kinematic_viscosity) {
    const double by_inertia = slip.norm() * width * width / k_own_wake_velocity;
    const double by_viscosity = kinematic_viscosity * width / k_own_stokes_velocity;
    const double drag_rate = drag_per_slip / fluid_density;  // [m3/s]
    const double wake = drag_rate / (by_inertia + by_viscosity);
    return {(wake - rock_volume * overlap / 3.0) * slip, 2.0 / 3.0 * overlap * drag_rate * by_inertia / (by_inertia + by_viscosity) * slip};
}

}  // namespace cutterflow::physics
