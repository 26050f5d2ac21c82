#pragma once
/// \file The scripts that stand inside every page, as text taken into the program when it is built.
#include <string_view>

namespace cutterflow::postproc::scripts {

std::string_view plotly();  ///< third_party/plotly-cartesian.min.js
std::string_view three();   ///< third_party/three.min.js
std::string_view page();    ///< page.js: draws plots and head over their pictures

}  // namespace cutterflow::postproc::scripts
