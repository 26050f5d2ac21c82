#pragma once
/// \file Triangles of a binary STL file, for pictures.
#include <array>
#include <filesystem>
#include <vector>

#include "geometry/base/vec3.hpp"

namespace cutterflow::postproc {

using Triangle = std::array<Vec3, 3>;  ///< corners [m]
using TriangleSurface = std::vector<Triangle>;

/// \throws UserError  when the file cannot be read or is not a complete binary STL
TriangleSurface read_binary_stl(const std::filesystem::path& file);

}  // namespace cutterflow::postproc
