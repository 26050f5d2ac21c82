#pragma once
/// \file Checks of the DEM's settings before LIGGGHTS reads them: LIGGGHTS ends the process at a mistake.
#include <vector>

#include "geometry/base/error.hpp"
#include "solver/ports/dem_settings.hpp"

namespace cutterflow::liggghts {

/// Every mistake of the settings, the walls' files not opened.
std::vector<Mistake> check_settings(const coupling::DemSettings& settings);

}  // namespace cutterflow::liggghts
