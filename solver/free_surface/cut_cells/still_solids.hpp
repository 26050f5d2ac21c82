#pragma once
/// \file Solids that stand in the tank or move on a given path: boxes, plates across the tank, the outside of a round cavity, closed
/// surfaces of triangles.
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "solver/free_surface/cut_cells/closed_surface.hpp"

namespace cutterflow::free_surface {

/// Of a line parallel to a coordinate axis, or of a place, the part inside a solid. All lengths in [m].
struct Line {
    int direction = 0;  ///< of x, y, z
    Vec3 through = Vec3::Zero();
};

struct SolidBox {
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();
};

/// A convex polygon in x and z, counter-clockwise seen against y (x to the right, z up), that reaches across the whole tank.
struct SolidPrism {
    std::vector<Eigen::Vector2d> corners;
};

/// Everything outside a cylinder across the tank, or outside a sphere.
struct SolidCavity {
    Vec3 centre = Vec3::Zero();
    double radius = 0.0;
    bool sphere = false;
};

/// The inside of a closed surface of triangles.
struct SolidSurface {
    std::shared_ptr<const ClosedSurface> surface;
};

using StillSolid = std::variant<SolidBox, SolidPrism, SolidCavity, SolidSurface>;

/// Parts of a line inside a solid.
std::vector<Interval> covered_parts(const StillSolid& solid, const Line& line);

/// The place on the solid's surface nearest to a place inside it; none when the place is outside.
std::optional<Vec3> way_out(const StillSolid& solid, const Vec3& place);

/// The place on the solid's surface nearest to a place outside it; of a place inside anything.
Vec3 nearest_on(const StillSolid& solid, const Vec3& place);

inline bool is_inside(const StillSolid& solid, const Vec3& place) {
    return way_out(solid, place).has_value();
}

/// A plate of two parallel sides from one point to another in x and z [m]; its thickness lies to the left of the way.
SolidPrism plate(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double thickness);

}  // namespace cutterflow::free_surface
