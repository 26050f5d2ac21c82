#pragma once
/// \file The page of a comparison, and what is written beside it.
#include <filesystem>

#include "postproc/analysis/comparison.hpp"
#include "postproc/draw/page.hpp"

namespace cutterflow::postproc {

/// \throws UserError  when the folder holds anything but an earlier comparison of the same runs
void require_own_comparison(const Comparison& comparison, const std::filesystem::path& folder);

/// Writes comparison.json and index.html into a folder, which is made; a still page has its pictures there, too. Replaces what is there:
/// see require_own_comparison.
/// \return the page
/// \throws ToolError  when gnuplot is there and fails
std::filesystem::path write_comparison(const Comparison& comparison, const std::filesystem::path& folder, PageForm form = PageForm::live);

}  // namespace cutterflow::postproc
