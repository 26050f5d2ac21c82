#pragma once
#include "geometry/repair/welding.hpp"

namespace cutterflow::geometry::repair {

/// More pairs of crossing triangles than this are no damage but another kind of surface; dividing them would take minutes.
inline constexpr std::size_t k_most_crossings = 100000;

/// The boundary of what a surface winds about once or more: all triangles are divided where they cross (exactly), and of the pieces those
/// stay that have the solid on their inner side and none on the outer. Overlapping and nested shells become one, self-crossings and walls
/// inside the solid vanish, and so do sheets that bound nothing. count: pairs of crossing triangles.
/// \pre    no flat or duplicate triangles; closed except for sheets
/// \throws CheckFailure  when more than k_most_crossings pairs cross
Stepped outer_boundary(const TracedSurface& traced);

}  // namespace cutterflow::geometry::repair
