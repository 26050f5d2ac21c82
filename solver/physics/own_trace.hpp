#pragma once
/// \file What a rock that samples the fluid where it is laid sees of itself: its own solid, the water that makes way for it, its wake. The
/// drag laws are of the slip against the fluid that the rock does not disturb.
///
/// A rock of volume V with the drag F = D s (s the slip that it sees) in an even stream, laid with w and sampling with psi: linearised
/// about the stream, the fluid's velocity in Fourier space is  -F (1 - c^2) w / (rho (nu k^2 + i |s| k c)) + c^2 V w s,  c the cosine of
/// wave and slip. Sampled, with O = sum(w psi) over cells, an isotropic mean of c^2 of 1/3 and one of c^4 of 1/5:
///   own solid fraction      V O
///   slip by the wake        s D / (mu sigma / stokes + rho |s| sigma^2 / wake), the exact limits of small and large |s| sigma / nu
///   slip by making way      -s V O / 3
///   acceleration            -(2/3) O F / rho, of the share of the wake that inertia makes
///   by a step dt of Euler   of the slip (dt/2) (2/3) O F / rho, of the acceleration s V O |s|^2 dt <k^2> / 5
/// Steady: a wake grows in sigma / |s|. [Balachandar2019]
#include <cmath>

#include "geometry/base/vec3.hpp"

namespace cutterflow::physics {

/// What a unit force does to what is sampled, sigma = 1, of a rock that samples by the deposit kernel and of one by the near weight.
struct OwnResponse {
    double stokes;  ///< mean velocity in a Stokes flow of viscosity 1: integral of g psi' / (6 pi |x - x'|)
    double wake;    ///< in a wake without viscosity at unit speed and density: half the integral of g times psi, both projected along it
    double bend;    ///< mean of k^2 of what is sampled of the kernel: integral of grad g times grad psi, over that of g times psi
};
inline constexpr OwnResponse k_deposit_response{0.0337875, 0.0500125, 1.73912}, k_near_response{0.0423918, 0.0783235, 2.66399};

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

/// A rock and how it samples.
struct Sampler {
    double volume;   ///< [m3]
    double overlap;  ///< sum over cells of deposit and sampling weight times volume [1/m3]
    double width;    ///< sigma [m]
    double share;    ///< of the near weight in what it samples [-]
};

/// Of a rock alone, see above. \param slip  u_seen - v [m/s], \param drag_rate  D over the fluid's density [m3/s], \param step  the
/// fluid's last [s]
inline OwnTrace own_trace(const Vec3& slip, double drag_rate, const Sampler& rock, double kinematic_viscosity, double step) {
    const auto of_both = [&](double OwnResponse::*response) {
        return rock.share * k_near_response.*response + (1.0 - rock.share) * k_deposit_response.*response;
    };
    const double speed = slip.norm(), width2 = rock.width * rock.width;
    const double by_inertia = speed * width2 / of_both(&OwnResponse::wake);
    const double by_viscosity = kinematic_viscosity * rock.width / of_both(&OwnResponse::stokes);
    const double wake = drag_rate / (by_inertia + by_viscosity);
    const double push = 2.0 / 3.0 * rock.overlap * drag_rate * by_inertia / (by_inertia + by_viscosity);  // [1/s]
    const double way = rock.volume * rock.overlap;
    return {(wake + 0.5 * step * push - way / 3.0) * slip,
            (push - 0.2 * way * speed * speed * step * of_both(&OwnResponse::bend) / width2) * slip};
}

}  // namespace cutterflow::physics
