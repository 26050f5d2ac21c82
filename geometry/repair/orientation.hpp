#pragma once
#include "geometry/repair/welding.hpp"

namespace cutterflow::geometry::repair {

/// Within each sheet (triangles connected over edges of exactly two) all triangles are oriented like the larger part by area.
/// count: triangles flipped.
Stepped orient_consistently(const TracedSurface& traced);

/// Closed components that enclose a negative volume are turned inside out, except those that lie wholly inside another one: they are
/// cavities. count: triangles flipped.
Stepped orient_outwards(const TracedSurface& traced);

}  // namespace cutterflow::geometry::repair
