#pragma once
/// \file Open borders of a surface and their closing.
#include "geometry/repair/welding.hpp"

namespace cutterflow::geometry::repair {

/// A closed chain of open edges, each point once, in the sense in which a patch passes it (against that of the surface's triangles).
struct Hole {
    std::vector<std::uint32_t> points;
    std::vector<std::size_t> triangles;  ///< of the surface, along it
    double size = 0.0;                   ///< longest side of its bounding box [m]
    Vec3 middle = Vec3::Zero();          ///< mean of its points [m]
};

/// Every hole of a surface. Open edges that form no closed chain (triangles of opposite sense meet there) are in none.
std::vector<Hole> find_holes(const TriangleSurface& surface);

/// Volume [m3] by the divergence theorem with each hole closed by a cone on its middle; the enclosed volume of a closed surface.
double enclosed_volume(const TriangleSurface& surface);

/// A surface whose holes were closed.
struct Filled {
    TracedSurface traced;
    std::size_t count = 0;          ///< holes closed
    double area = 0.0;              ///< [m2] of the patches
    double uncertain_volume = 0.0;  ///< [m3]: each patch's area times a sixth of its hole's size, a corner of that size
    std::vector<Hole> left_open;    ///< for which there is no patch
};

/// Closes holes by triangles of least area without new points.
Filled fill_holes(const TracedSurface& traced, const std::vector<Hole>& holes);

}  // namespace cutterflow::geometry::repair
