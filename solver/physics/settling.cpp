#include "solver/physics/settling.hpp"

#include <cmath>
#include <stdexcept>

#include "geometry/base/sphere.hpp"

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

}  // namespace cutterflow::physics
