#pragma once
/// \file The page of a comparison, and what is written beside it.
#include <filesystem>

#include "postproc/analysis/comparison.hpp"

namespace cutterflow::postproc {

/// Writes comparison.json and index.html into a folder, which is made.
/// \return the page
/// \throws UserError  when the folder holds something else already
/// \throws ToolError  when gnuplot is there and fails
std::filesystem::path write_comparison(const Comparison& comparison, const std::filesystem::path& folder);

}  // namespace cutterflow::postproc
