#pragma once
/// \file Shapes of rock that is no sphere.
#include <string>

#include "geometry/clump/unit_clump.hpp"

namespace cutterflow::coupling {

/// A clump that rock of the feed may name.
struct ClumpShape {
    std::string name;
    geometry::UnitClump clump;
};

}  // namespace cutterflow::coupling
