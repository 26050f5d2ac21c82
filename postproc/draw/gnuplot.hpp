#pragma once
/// \file Plots drawn by gnuplot, a child program, as SVG that stands inside a page.
#include <filesystem>
#include <string>

#include "postproc/draw/plot.hpp"

namespace cutterflow::postproc {

bool gnuplot_is_installed();

/// gnuplot's commands for a plot, without terminal and output; its data stand in them as named blocks.
std::string gnuplot_commands(const Plot& plot);

/// Draws a plot. Files needed for it are written into `scratch_directory` (made when absent).
/// \return an <svg> element that scales to its container; ids are unique to the plot
/// \throws ToolError  when gnuplot cannot be started or refuses the plot
std::string draw_svg(const Plot& plot, const std::filesystem::path& scratch_directory);

}  // namespace cutterflow::postproc
