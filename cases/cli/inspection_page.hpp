#pragma once
/// \file The files of `cutterflow inspect`: inspection.json and a page with pictures.
#include <filesystem>

#include "geometry/head/geometry_report.hpp"

namespace cutterflow::cases {

/// Writes inspection.json (as geometry.json) and index.html, one file that needs no network: three views of the surface, the contour r(z),
/// the numbers, and the defects with marks at their places.
/// \param surface  in the file's frame [m]
/// \param folder   created if missing
/// \throws UserError  when the folder holds anything already
void write_inspection(const geometry::GeometryInspection& inspection, const geometry::TriangleSurface& surface,
                      const std::filesystem::path& folder);

}  // namespace cutterflow::cases
