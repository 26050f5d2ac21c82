#pragma once
/// \file Convex polygons in the plane, clipped by lines.
#include "geometry/cgal/planar_region.hpp"

namespace cutterflow::geometry {

/// Area and first moment of a region of the plane; those of a part add to or are taken from those of the whole.
struct PlanarMoment {
    double area = 0.0;                                ///< [m2]
    Eigen::Vector2d first = Eigen::Vector2d::Zero();  ///< area times centroid [m3]
    PlanarMoment operator-(const PlanarMoment& part) const { return {area - part.area, first - part.first}; }
};

/// Of a polygon; negative when its corners go clockwise.
PlanarMoment moment_of(const PlanarLoop& polygon);

/// The part of a convex polygon on the side of a line where (p - on) . inwards >= 0. Empty when there is none.
PlanarLoop clipped(const PlanarLoop& convex, const Eigen::Vector2d& on, const Eigen::Vector2d& inwards);

/// The common part of two convex polygons. \param by  counter-clockwise
PlanarLoop clipped(const PlanarLoop& convex, const PlanarLoop& by);

/// The polygon moved.
PlanarLoop moved(PlanarLoop polygon, const Eigen::Vector2d& by);

}  // namespace cutterflow::geometry
