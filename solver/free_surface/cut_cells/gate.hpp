#pragma once
/// \file A gate: a wall that stands until a time and then rises at its own speed.
#include <algorithm>

#include "solver/free_surface/cut_cells/still_solids.hpp"

namespace cutterflow::free_surface {

struct Gate {
    SolidBox closed;                ///< where it stands before it rises
    double speed = 0.0;             ///< upward [m/s]
    double start = 0.0, end = 0.0;  ///< it rises from start to end [s]

    /// By how much it has risen [m].
    double rise(double time) const { return speed * std::clamp(time - start, 0.0, end - start); }
    SolidBox at(double time) const {
        const Vec3 way(0.0, 0.0, rise(time));
        return {closed.from + way, closed.to + way};
    }
};

}  // namespace cutterflow::free_surface
