#pragma once
/// \file The file of a clump, as a study names it and as its case holds it.
#include <filesystem>
#include <string>

#include "geometry/base/parameters/parameter.hpp"
#include "geometry/clump/unit_clump.hpp"

namespace cutterflow::cases {

/// Where a case holds a shape of that name, relative to its folder.
std::string path_of_shape(const std::string& name);

struct ShapeFile {
    std::string name;            ///< of the shape in the case
    std::filesystem::path file;  ///< that the study names
    std::string text;            ///< of that file
    geometry::UnitClump clump;

    /// Diameter of the sphere around a rock over that of the sphere of its volume.
    double girth() const { return 2.0 * clump.reach(); }
};

/// The clump that a key of the study names. \param folder  to which its path is relative
/// \throws UserError  when there is no such file, or with all that is wrong with the clump
ShapeFile read_shape_file(const ParameterValues& values, const std::string& key, const std::string& name,
                          const std::filesystem::path& folder);

}  // namespace cutterflow::cases
