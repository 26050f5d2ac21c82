#pragma once
/// \file Shapes of rock in constant/couplingProperties.
#include <string>
#include <vector>

#include "meshing/dictionary/foam_dictionary.hpp"

namespace cutterflow::cases {

/// Section rock.shapes, which names each shape's file in the case; empty without shapes. \param names  of shapes whose files lie at
/// path_of_shape
meshing::FoamDictionary shapes_section(const std::vector<std::string>& names);

}  // namespace cutterflow::cases
