#pragma once
/// \file Convex plane polygons in space: cut by upright planes, and made into triangles of bounded quality.
#include <vector>

#include "geometry/soil/convex_polygon.hpp"

namespace cutterflow::geometry {

/// Corners of a convex polygon in one plane, in order.
using Facet = std::vector<Vec3>;

/// The part of a facet on the side of an upright plane where (p - on) . inwards >= 0, p the point's first two coordinates. Empty when there
/// is none.
Facet clipped(const Facet& facet, const Eigen::Vector2d& on, const Eigen::Vector2d& inwards);

/// What of a facet lies outside an upright prism, in convex parts. \param prism  its convex section, counter-clockwise \param least_width
/// of what the prism must take to matter [m]
std::vector<Facet> outside(const Facet& facet, const PlanarLoop& prism, double least_width);

/// Smallest distance of two parallel lines that hold the facet between them [m].
double width_of(const Facet& facet);

/// Of the triangles of a facet.
struct TileBounds {
    double least_width = 0.0;     ///< [m]; what is narrower is left out, and corners nearer to each other become one
    double edge_length = 0.0;     ///< largest [m]
    double smallest_angle = 0.0;  ///< [rad], less than 20 degrees
};

/// Adds triangles of the facet within the bounds: it is halved across its longest extent until every part has some. They face where the
/// facet's corners go counter-clockwise. Neighbouring parts need not share corners.
void add_tiles(Facet facet, const TileBounds& bounds, TriangleSurface& to);

}  // namespace cutterflow::geometry
