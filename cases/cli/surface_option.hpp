#pragma once
/// \file A surface that is named on the command line, with its unit.
#include <optional>
#include <string>

#include "geometry/base/mistakes.hpp"
#include "geometry/io/read_surface.hpp"

namespace cutterflow::cli {

/// The surface in metres; none when a mistake was added: of the unit, of the file, or of both.
inline std::optional<geometry::ImportedSurface> import_surface(const std::string& file, const std::optional<std::string>& unit_name,
                                                               Mistakes& mistakes) {
    std::optional<geometry::LengthUnit> unit;
    std::optional<geometry::ImportedSurface> imported;
    const bool unit_is_known = mistakes.gather([&] {
        if (unit_name) unit = geometry::length_unit_of(*unit_name);
    });
    mistakes.gather([&] {
        if (unit_is_known)
            imported = geometry::import_cutter(file, unit);
        else
            geometry::read_surface(file);  // has to be a surface whatever its unit
    });
    return imported;
}

}  // namespace cutterflow::cli
