#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// Writes a surface as VTK XML polygons, which ParaView opens. \param cell_data  integers by name, one per triangle
/// \throws UserError  when the file cannot be written
void write_vtp(const TriangleSurface& surface, const std::map<std::string, std::vector<std::int64_t>>& cell_data,
               const std::filesystem::path& file);

}  // namespace cutterflow::geometry
