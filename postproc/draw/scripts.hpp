#pragma once
/// \file The scripts inside every page, linked into the program.
#include <string>

namespace cutterflow::postproc::scripts {

std::string plotly();  ///< third_party/plotly-cartesian.min.js.gz
std::string three();   ///< third_party/three.min.js.gz
std::string page();    ///< page.js: draws plots and head over their pictures

}  // namespace cutterflow::postproc::scripts
