#pragma once
/// \file What rock does to the steel, on the report's page.
#include <string>

#include "postproc/analysis/results.hpp"
#include "postproc/draw/page.hpp"

namespace cutterflow::postproc {

/// The section with a map of the cutter, tables by wall and by axial bin, and what they are not; markup. Empty without numbers.
std::string steel_section(const Results& results, const RunData& run, const Page& page);

}  // namespace cutterflow::postproc
