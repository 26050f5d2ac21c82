#pragma once
/// \file Where rock of a feed may go in.
#include <optional>

#include "geometry/base/vec3.hpp"

namespace cutterflow::coupling {

struct FeedPlace {
    Vec3 position = Vec3::Zero();  ///< [m]
    std::optional<Vec3> velocity;  ///< [m/s]; absent: the local fluid velocity
};

}  // namespace cutterflow::coupling
