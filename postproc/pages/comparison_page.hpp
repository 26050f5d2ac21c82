#pragma once
/// \file The page of a comparison, and what is written beside it.
#include <filesystem>

#include "postproc/analysis/comparison.hpp"
#include "postproc/draw/page.hpp"

namespace cutterflow::postproc {

/// Writes comparison.json and index.html into a folder, which is made; a still page has its pictures there, too.
/// \return the page
/// \throws UserError  when the folder holds something else already
/// \throws ToolError  when gnuplot is there and fails
std::filesystem::path write_comparison(const Comparison& comparison, const std::filesystem::path& folder, PageForm form = PageForm::live);

}  // namespace cutterflow::postproc
