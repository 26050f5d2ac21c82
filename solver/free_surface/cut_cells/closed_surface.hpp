#pragma once
/// \file A closed surface of triangles as a solid that stands in a scene in space.
#include <memory>
#include <optional>
#include <vector>

#include "geometry/cgal/solid_search.hpp"
#include "solver/free_surface/cut_cells/covered_area.hpp"

namespace cutterflow::free_surface {

/// The solid that a closed, outward oriented surface bounds [m]. Lines along the axes are cut where they pass its triangles, exactly; a
/// line through an edge or a corner counts as one beside it, by a shift towards +a and less towards +b of the plane across it.
class ClosedSurface {
public:
    /// \pre the surface is sound (geometry::inspect_surface)
    explicit ClosedSurface(geometry::TriangleSurface surface);

    /// Parts of a line inside, in order. \param direction  of x, y, z
    /// \throws std::runtime_error  when the line meets the surface an odd number of times: it is not closed
    std::vector<Interval> parts(int direction, const Vec3& through) const;
    bool contains(const Vec3& place) const;
    const geometry::TriangleSurface& surface() const { return surface_; }
    /// Nearest point of the surface [m].
    Vec3 nearest(const Vec3& place) const { return search_.nearest(place).point; }

private:
    /// Triangles by their place in the plane across a direction: a square of bins over the surface's bounds.
    struct Bins {
        std::array<double, 2> from{}, inverse{};  ///< lower corner [m], bins a length [1/m]
        int count = 1;                            ///< along each side
        std::vector<std::vector<std::uint32_t>> triangles;
        /// The bin of a place along one side, clamped.
        int at(int side, double place) const;
    };
    void fill_bins(int direction);
    std::optional<double> crossing(const geometry::Triangle& triangle, int direction, const Vec3& through) const;

    geometry::TriangleSurface surface_;
    std::array<Bins, 3> bins_;
    geometry::SolidSearch search_;
};

}  // namespace cutterflow::free_surface
