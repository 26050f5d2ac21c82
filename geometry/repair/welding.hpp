#pragma once
/// \file First steps of a repair: join what nearly coincides, drop what bounds nothing.
#include "geometry/repair/traced_surface.hpp"

namespace cutterflow::geometry::repair {

/// A surface after a step, and the number of changes.
struct Stepped {
    TracedSurface traced;
    std::size_t count = 0;
};

/// Points within `distance` [m] of an earlier one become that one. Greedy: no chain of points moves farther than `distance`.
/// count: points joined.
Stepped weld_points(const TracedSurface& traced, double distance);

/// Drops triangles with two equal points, or whose height over the longest side is at most `height` [m]. count: triangles dropped.
Stepped drop_flat_triangles(const TracedSurface& traced, double height);

/// Keeps one of the triangles with the same three points. Groups of such twins of opposite sense that separate two solids (two more
/// triangles at each edge of the group's border) are dropped altogether: they are a wall without thickness inside one solid. count:
/// triangles dropped.
Stepped drop_duplicates(const TracedSurface& traced);

/// Drops sheets attached to a surface by edges of an odd number of triangles and with a free border: they bound no solid. At each such
/// edge the sheet of the smallest area is dropped. count: triangles dropped.
Stepped drop_hanging_sheets(const TracedSurface& traced);

}  // namespace cutterflow::geometry::repair
