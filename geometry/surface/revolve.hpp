#pragma once
/// \file Solids of revolution as triangle surfaces.
#include <vector>

#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// A point of a meridional section: radius >= 0 and axial coordinate, both in metres.
struct MeridianPoint {
    double r = 0.0;
    double z = 0.0;
};

/// Number of edges that a circle of `radius` [m] gets for edges of at most `edge_length` [m]: a multiple of 4, 16 or more.
std::size_t circle_segments(double radius, double edge_length);

/// \throws UserError  when edges of `edge_length` [m] divide an area [m2] into more than `most` triangles
void require_few_triangles(double area, double edge_length, double most);

/// The closed surface that a section sweeps about the z axis. Sides longer than `edge_length` [m] are divided. Points of the section lie on
/// the circles exactly, so that the solid is inscribed: its volume is smaller by (2 pi / segments)^2 / 6.
/// \param section   corners in either sense; a closed polygon, or an open line that starts and ends on the axis
/// \param segments  edges around the axis, 3 or more
TriangleSurface solid_of_revolution(const std::vector<MeridianPoint>& section, std::size_t segments, double edge_length);

}  // namespace cutterflow::geometry
