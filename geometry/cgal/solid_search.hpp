#pragma once
/// \file Nearest point of a surface, and inside or outside of a solid.
#include <memory>

#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

struct NearestPoint {
    Vec3 point;            ///< on the surface [m]
    std::size_t triangle;  ///< index in the surface
    double distance;       ///< [m], 0 or more
};

/// A search tree over the triangles of a closed surface. Thread-safe to query after construction.
class SolidSearch {
public:
    /// \throws CheckFailure  when the triangles do not form a 2-manifold
    explicit SolidSearch(const TriangleSurface& surface);
    SolidSearch(SolidSearch&&) noexcept;
    ~SolidSearch();

    NearestPoint nearest(const Vec3& point) const;

    /// Is the point inside the solid (points of the surface included)? \pre the surface is closed
    bool contains(const Vec3& point) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cutterflow::geometry
