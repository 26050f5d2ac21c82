#pragma once
/// \file What a rock that samples the fluid where it is laid sees of itself: its own solid, the water that makes way for it, its wake. The
/// drag laws are of the slip against the fluid that the rock does not disturb.
///
/// A rock of volume V and drag F = D s (s the slip that it sees) in an even stream, laid with w and sampling with psi: linearised about the
/// stream, the fluid's velocity in Fourier space is  -F (1 - c^2) w / (rho (nu k^2 + i |s| k c)) + c^2 V w s,  c the cosine of wave and
/// slip. Sampled, with O = sum(w psi) over cells, an isotropic mean of c^2 of 1/3 and one of c^4 of 1/5:
///   own solid fraction   V O
///   velocity by wake     -W s, W = D / (mu sigma / stokes + rho |s| sigma^2 / wake); the limits of small and large R are exact
///   by making way        +V O s / 3
///   acceleration         -A s, A = (2/3) O D / rho R^2 / (R^2 + push_1 R + push_2)
/// with R = |s| sigma / nu.
/// A rock that moves at v through the cells is laid elsewhere in each step dt of Euler. That adds, as far as the waves are resolved,
///   velocity by wake     -(dt/2) A s (v.s)^2 / |s|^4, less where v^2 dt is large beside |s| sigma
///   acceleration         +V O <k^2> dt (s v^2 + 2 v (v.s)) / 15
/// Steady: a wake grows in sigma / |s|. Of molecular viscosity: what turbulence spreads of the wake is not in it. [Balachandar2019]
#include <algorithm>
#include <cmath>

#include "geometry/base/vec3.hpp"

namespace cutterflow::physics {

/// Of a rock that samples by the deposit kernel and of one by the near weight, sigma = 1.
struct OwnResponse {
    double overlap;         ///< integral of w psi
    double stokes;          ///< mean velocity by a unit force in a Stokes flow of viscosity 1: integral of w psi' / (6 pi |x - x'|)
    double wake;            ///< without viscosity at unit speed and density: half the integral of w times psi, both projected along it
    double bend;            ///< <k^2>: integral of grad w times grad psi, over that of w times psi
    double push_1, push_2;  ///< fit of the share of inertia in the acceleration, exact to 0.002
};
inline constexpr OwnResponse k_deposit_response{0.0309951, 0.0337875, 0.0500125, 1.73912, 2.9, 3.1};
inline constexpr OwnResponse k_near_response{0.0603181, 0.0423918, 0.0783235, 2.66399, 3.6, 4.8};

/// Fit of where the step's part of the wake saturates, to 0.1 of it.
inline constexpr double k_wake_saturation = 0.27;

/// Largest W: what is taken out follows the slip of the step before, which would swing for W above 1/2.
inline constexpr double k_largest_wake = 1.0 / 3.0;

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
    bool is_limited = false;           ///< its wake is more than k_largest_wake
};

/// A rock and how it samples.
struct Sampler {
    double volume;   ///< [m3]
    double overlap;  ///< sum over cells of deposit and sampling weight times volume [1/m3]
    double width;    ///< sigma [m]
    double share;    ///< of the near weight in what it samples [-]
};

/// Of a rock alone, see above; its velocity by the slip without its wake, s / (1 - W). A wall beside the rock that makes its overlap
/// larger makes its wake larger alike. \param slip  u_seen - v [m/s], \param velocity  of the rock through the cells [m/s], \param
/// drag_rate D over the fluid's density [m3/s], \param step  the fluid's last [s]
inline OwnTrace own_trace(const Vec3& slip, const Vec3& velocity, double drag_rate, const Sampler& rock, double kinematic_viscosity,
                          double step) {
    const double speed = slip.norm();
    if (speed == 0.0) return {};
    const auto of_both = [&](double OwnResponse::*response) {
        return rock.share * k_near_response.*response + (1.0 - rock.share) * k_deposit_response.*response;
    };
    const double width2 = rock.width * rock.width, reynolds = speed * rock.width / kinematic_viscosity;
    const double free_overlap = of_both(&OwnResponse::overlap), beside_walls = rock.overlap * width2 * rock.width / free_overlap;
    const double bend = rock.share * k_near_response.overlap * k_near_response.bend / free_overlap +
                        (1.0 - rock.share) * k_deposit_response.overlap * k_deposit_response.bend / free_overlap;
    const double opposed =
        kinematic_viscosity * rock.width / of_both(&OwnResponse::stokes) + speed * width2 / of_both(&OwnResponse::wake);  // [m3/s]
    const double whole_wake = beside_walls * drag_rate / opposed, wake = std::min(k_largest_wake, whole_wake);
    const double push = 2.0 / 3.0 * rock.overlap * drag_rate * reynolds * reynolds /
                        (reynolds * reynolds + of_both(&OwnResponse::push_1) * reynolds + of_both(&OwnResponse::push_2));  // [1/s]
    const double way = rock.volume * rock.overlap;

    const double along = velocity.dot(slip) / (speed * speed);  // v over s
    const double of_step = 0.5 * step * push * along * along / (1.0 + k_wake_saturation * along * along * speed * step / rock.width);
    const Vec3 bent = velocity.squaredNorm() * slip + 2.0 * velocity.dot(slip) * velocity;
    return {(wake / (1.0 - wake) + of_step - way / 3.0) * slip, push * slip - way * bend * step / (15.0 * width2) * bent,
            whole_wake > k_largest_wake};
}

}  // namespace cutterflow::physics
