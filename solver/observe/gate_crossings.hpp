#pragma once
/// \file Crossings of gates by centres of rock.
#include <vector>

#include "solver/ports/bed_operations.hpp"
#include "solver/ports/dem_engine.hpp"

namespace cutterflow::coupling {

struct GateCrossing {
    std::size_t gate = 0;  ///< its number
    int sense = 0;         ///< +1 along its normal, -1 against it
    double share = 0.0;    ///< of the way from the place before to the place after
    Vec3 place = Vec3::Zero();
};

/// Gates that the straight way of a centre crosses. A centre that ends on a gate's plane has crossed it only when it goes on.
std::vector<GateCrossing> crossings(const std::vector<GateSettings>& gates, const Vec3& before, const Vec3& after);

}  // namespace cutterflow::coupling
