#include "solver/physics/settling.hpp"

#include <cmath>
#include <stdexcept>

namespace cutterflow::physics {
namespace {

double drag_force(const SettlingRock& settling, double speed) {
    return drag_coefficient_per_slip(settling.rock, speed, settling.drag, settling.hindrance) * speed;
}

double submerged_weight(const SettlingRock& settling) {
    return (settling.density - settling.rock.fluid_density) * sphere_volume(settling.rock.diameter) * settling.gravity;
}

}  // namespace

double terminal_slip_speed(const SettlingRock& settling) {
    const double weight = submerged_weight(settling);
    if (!(weight > 0.0)) throw std::invalid_argument("only a rock that is heavier than the fluid settles");
    double lower = 0.0;
    double upper = 1.0;
    while (drag_force(settling, upper) < weight) upper *= 2.0;
    while (upper - lower > 1e-13 * upper) {
        const double middle = 0.5 * (lower + upper);
        (drag_force(settling, middle) < weight ? lower : upper) = middle;
    }
    return 0.5 * (lower + upper);
}

std::vector<FallState> fall_from_rest(const SettlingRock& settling, double added_mass_coefficient, double duration, double time_step) {
    const double weight = submerged_weight(settling);
    const double inertia =
        (settling.density + added_mass_coefficient * settling.rock.fluid_density) * sphere_volume(settling.rock.diameter);
    const auto acceleration = [&](double speed) { return (weight - drag_force(settling, speed)) / inertia; };
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

}  // namespace cutterflow::physics
