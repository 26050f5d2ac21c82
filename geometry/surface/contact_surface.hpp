#pragma once
/// \file The surface of a wall for the DEM: few triangles of bounded quality, within a given distance of the steel.
#include <string>

#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// Bounds of a contact surface.
struct ContactSurfaceBounds {
    double deviation = 0.0;    ///< [m] largest distance of the steel's surface and the contact surface, both ways
    double edge_length = 0.0;  ///< [m]; edges get at most a third longer
};

struct ContactSurface {
    TriangleSurface surface;
    double deviation = 0.0;       ///< measured at points an eighth of the edge length apart [m]; 0 for the given triangles
    double smallest_angle = 0.0;  ///< [rad]
    std::string kept_because;     ///< why the given triangles were kept; empty: they were not
};

/// The wall's surface coarsened within the bounds. Borders stay, so that walls that share them still meet. The given triangles are kept
/// when the result would lie too far off, cross itself or have an angle below 1 degree (LIGGGHTS warns of less than 0.5), when they
/// form no 2-manifold, and when they are more than 200,000. \pre both bounds are positive
ContactSurface contact_surface(const TriangleSurface& wall, const ContactSurfaceBounds& bounds);

/// Smallest angle of all triangles [rad].
double smallest_angle_of(const TriangleSurface& surface);

}  // namespace cutterflow::geometry
