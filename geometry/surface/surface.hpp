#pragma once
/// \file Triangle surfaces as plain arrays, shared by import, generators, inspection and meshing.
#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/base/vec3.hpp"

namespace cutterflow::geometry {

/// Point indices of one triangle, counter-clockwise seen from outside the solid.
using Triangle = std::array<std::uint32_t, 3>;

/// A triangulated surface with shared points. Closed and outward oriented when it bounds a solid; `inspect_surface` checks it.
struct TriangleSurface {
    std::vector<Vec3> points;  ///< [m] unless a function says otherwise
    std::vector<Triangle> triangles;
};

/// Axis-parallel box. Empty (min > max) for a surface without points.
struct Bounds {
    Vec3 min;
    Vec3 max;
    Vec3 extent() const { return max - min; }
};

/// Volume integrals of the solid inside a closed, outward oriented surface of density 1.
struct MassProperties {
    double volume = 0.0;                                ///< [m3]; negative when the surface is inside out
    Vec3 centroid = Vec3::Zero();                       ///< [m]
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centroid [m5]
};

Bounds bounds_of(const TriangleSurface& surface);

/// Half the cross product of two edges [m2]: outward normal times area.
Vec3 area_vector(const TriangleSurface& surface, const Triangle& triangle);

Vec3 centroid_of(const TriangleSurface& surface, const Triangle& triangle);

/// Sum of the triangles' areas [m2].
double area_of(const TriangleSurface& surface);

/// Area [m2] of a closed convex surface seen along `direction` (of length 1): half the sum of |n . direction| A. Of a hollow one more than
/// its shadow.
double area_seen_along(const TriangleSurface& surface, const Vec3& direction);

/// Volume [m3] by the divergence theorem; meaningful for closed surfaces only, negative when inside out.
double volume_of(const TriangleSurface& surface);

/// \pre the surface is closed and its volume is not zero
MassProperties mass_properties(const TriangleSurface& surface);

/// The surface under x -> T x. A reflection also reverses the triangles, so that outward stays outward.
TriangleSurface transformed(const TriangleSurface& surface, const Eigen::Affine3d& transform);

/// The surfaces side by side in one, points not joined.
TriangleSurface joined(const std::vector<TriangleSurface>& surfaces);

/// Points with equal coordinates made one; points that no triangle uses dropped. Order of first appearance is kept.
TriangleSurface welded(const TriangleSurface& surface);

/// The same surface in the one order that does not depend on how it was made: points by coordinates, the smallest index of a triangle in
/// front, triangles by indices.
TriangleSurface sorted(const TriangleSurface& surface);

}  // namespace cutterflow::geometry
