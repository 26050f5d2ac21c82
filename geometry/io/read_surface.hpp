#pragma once
/// \file Import of STL (ASCII and binary), OBJ and PLY.
#include <filesystem>
#include <optional>
#include <string>

#include "geometry/io/length_unit.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// Reads a surface in the file's own unit. Polygons are cut into triangles and points with equal coordinates are joined; nothing is
/// repaired. \throws UserError  when the file is missing, empty, truncated, no STL, OBJ or PLY, holds no triangles, coordinates that are
///                    not finite numbers, or a surface so far from the origin that single precision does not resolve it
TriangleSurface read_surface(const std::filesystem::path& file);

/// The ending of a file's name with its dot, in lower case: it tells the format.
std::string extension_of(const std::filesystem::path& file);

struct ImportedSurface {
    TriangleSurface surface;  ///< [m]
    UnitDecision unit;
};

/// read_surface, then decide_unit, scaled to metres.
ImportedSurface import_cutter(const std::filesystem::path& file, std::optional<LengthUnit> given);

}  // namespace cutterflow::geometry
