#pragma once
/// \file The walls' surfaces that the DEM reads, made from those of geometry/.
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/surface/surface.hpp"

namespace cutterflow::cases {

inline constexpr const char* k_contact_surface_report = "contact_surfaces.json";

/// What became of one wall's surface.
struct WallSurfaceReport {
    std::string wall;
    std::size_t triangles_given = 0, triangles = 0;
    double smallest_angle_given = 0.0, smallest_angle = 0.0;  ///< [rad]
    double deviation = 0.0, allowed_deviation = 0.0;          ///< [m]
    std::string kept_because;                                 ///< why the given triangles were kept; empty: they were not
    std::string text() const;                                 ///< one line for the user
};

/// A wall whose surface need not be made.
struct MadeWall {
    std::filesystem::path file;  ///< in the run directory
    geometry::TriangleSurface surface;
    WallSurfaceReport report;
};

/// Writes the surface of every standard wall that rock of `smallest_diameter` [m] touches, no farther than 1 % of that from the surface in
/// geometry/, those that are made, and contact_surfaces.json. write_case has named the files. \return one report per wall
std::vector<WallSurfaceReport> write_contact_surfaces(const std::filesystem::path& run_directory, double smallest_diameter,
                                                      double ring_radius, const std::vector<MadeWall>& made);

}  // namespace cutterflow::cases
