#pragma once
/// \file Fall of one rock in still water, the reference that coupled runs are checked against.
#include <vector>

#include "geometry/base/sphere.hpp"
#include "solver/physics/settling.hpp"

namespace cutterflow::physics::testing {

struct FallState {
    double time = 0.0;      ///< [s]
    double speed = 0.0;     ///< [m/s], downward
    double distance = 0.0;  ///< [m]
};

/// Fall from rest in still fluid with added mass, (rho_s + C_AM rho_f) V dv/dt = (rho_s - rho_f) V g - D(v) v, by the classical Runge-Kutta
/// scheme. \return states at 0, dt, 2 dt, ... up to and including the first one at or after `duration`.
inline std::vector<FallState> fall_from_rest(const SettlingRock& settling, double added_mass_coefficient, double duration,
                                             double time_step) {
    const double volume = sphere_volume(settling.rock.diameter);
    const double weight = (settling.density - settling.rock.fluid_density) * volume * settling.gravity;
    const double inertia = (settling.density + added_mass_coefficient * settling.rock.fluid_density) * volume;
    const auto acceleration = [&](double speed) {
        return (weight - drag_coefficient_per_slip(settling.rock, speed, settling.drag, settling.hindrance) * speed) / inertia;
    };
    std::vector<FallState> states{FallState{}};
    for (int n = 1; states.back().time < duration; ++n) {
        const FallState& now = states.back();
        const double k1 = acceleration(now.speed);
        const double v2 = now.speed + 0.5 * time_step * k1;
        const double k2 = acceleration(v2);
        const double v3 = now.speed + 0.5 * time_step * k2;
        const double k3 = acceleration(v3);
        const double v4 = now.speed + time_step * k3;
        const double k4 = acceleration(v4);
        states.push_back({n * time_step, now.speed + time_step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4),
                          now.distance + time_step / 6.0 * (now.speed + 2.0 * v2 + 2.0 * v3 + v4)});
    }
    return states;
}

}  // namespace cutterflow::physics::testing
