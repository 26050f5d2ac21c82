#pragma once
/// \file A surface with the source triangle in the file of each triangle.
#include <cstdint>

#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry::repair {

/// Source of a triangle that a repair has added (the patch of a hole).
inline constexpr std::int64_t k_added = -1;

struct TracedSurface {
    TriangleSurface surface;
    std::vector<std::int64_t> source;  ///< one per triangle: its index in the file, or k_added

    void add(const Triangle& triangle, std::int64_t from) {
        surface.triangles.push_back(triangle);
        source.push_back(from);
    }
};

/// The triangles for which `keep` is true, in order, with the points they use.
TracedSurface selected(const TracedSurface& traced, const std::vector<bool>& keep);

}  // namespace cutterflow::geometry::repair
