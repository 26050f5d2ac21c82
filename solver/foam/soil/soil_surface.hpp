#pragma once
/// \file The soil's surface from a file. Only for .cpp files of solver/foam.
#include <filesystem>

#include "solver/space/soil_surface.hpp"

namespace cutterflow::foam {

/// Reads an STL file in metres. \throws UserError  when it is not there, cannot be read or does not close
coupling::SoilSurface read_soil_surface(const std::filesystem::path& file);

}  // namespace cutterflow::foam
