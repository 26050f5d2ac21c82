#include "validation/harness/scenes/falling_rock.hpp"

#include <algorithm>
#include <cmath>

namespace cutterflow::validation {

double fall_acceleration(const FallingRock& rock, double slip) {
    const double re = std::max(slip * rock.diameter / rock.viscosity, 1e-9);
    const double drag = 24.0 / re * (1.0 + 0.150 * std::pow(re, 0.681)) + 0.407 / (1.0 + 8710.0 / re);
    const double distance = 1.5 - std::log10(rock.void_fraction * re);
    const double exponent = 1.0 - (3.7 - 0.65 * std::exp(-0.5 * distance * distance));
    // Over the rock's volume: drag area / volume = 3/(2 d).
    const double drag_force = 0.75 / rock.diameter * rock.fluid_density * drag * slip * slip * std::pow(rock.void_fraction, exponent);
    return ((rock.density - rock.fluid_density) * rock.gravity - drag_force) / (rock.density + 0.5 * rock.fluid_density);
}

double terminal_slip(const FallingRock& rock) {
    double low = 0.0, high = 100.0;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (fall_acceleration(rock, middle) > 0.0 ? low : high) = middle;
    }
    return low;
}

double fall_speed(const FallingRock& rock, double start, double time) {
    const int steps = std::max(1, static_cast<int>(std::ceil(time / 1e-4)));
    const double dt = time / steps;
    double v = start;
    for (int i = 0; i < steps; ++i) {
        const double k1 = fall_acceleration(rock, v), k2 = fall_acceleration(rock, v + 0.5 * dt * k1);
        const double k3 = fall_acceleration(rock, v + 0.5 * dt * k2), k4 = fall_acceleration(rock, v + dt * k3);
        v += dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    return v;
}

}  // namespace cutterflow::validation
