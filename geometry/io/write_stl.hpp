#pragma once
#include <filesystem>

#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// Writes a binary STL: the same surface gives the same bytes. Coordinates are rounded to single precision.
/// \throws UserError  when the file cannot be written
void write_stl(const TriangleSurface& surface, const std::filesystem::path& file);

}  // namespace cutterflow::geometry
