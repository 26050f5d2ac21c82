#pragma once
/// \file One rock that falls through the sliding interface into a turning zone and out again: what the cases of the crossing share.
#include <cmath>
#include <optional>
#include <vector>

#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/falling_rock.hpp"
#include "validation/harness/scenes/tank_mesh.hpp"

namespace cutterflow::validation {

/// A closed cylinder of water at rest about z. Gravity acts along -x, and a rock of 10 mm falls along the diameter.
struct CrossingCase {
    TankMesh mesh;
    std::optional<double> rpm;        ///< of the zone inside the interface; none: one mesh without an interface
    double start = 0.13;              ///< x at which the rock is released [m]
    double time_step = 1e-3;          ///< [s]
    double end_time = 0.35;           ///< [s]
    double picture_interval = 0.005;  ///< [s]
};

/// The box of a CrossingCase; numerics are its defaults.
BoxCase crossing_box(const CrossingCase& crossing);

/// Velocity [m/s] of its rock at a time [s] by its own force balance in water at rest. It begins below the terminal speed, so that the
/// approach to it is seen too.
Vec3 crossing_velocity(double time);

/// Root mean square over the pictures of |velocity of the rock - reference(number of the picture)| [m/s].
template <class Reference>
double rms_velocity_error(const std::vector<RockSnapshot>& pictures, const Reference& reference) {
    double square = 0.0;
    for (std::size_t i = 0; i < pictures.size(); ++i) square += (pictures[i].velocity.at(0) - reference(i)).squaredNorm();
    return std::sqrt(square / static_cast<double>(pictures.size()));
}

/// The same against the rock's own force balance.
double rms_error_of_crossing(const std::vector<RockSnapshot>& pictures);

}  // namespace cutterflow::validation
