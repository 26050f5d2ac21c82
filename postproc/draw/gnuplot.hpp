#pragma once
/// \file Plots by gnuplot, a child program, as SVG inside a page.
#include <filesystem>
#include <string>
#include <vector>

namespace cutterflow::postproc {

/// A plot: gnuplot commands without terminal and output. Data are named blocks in the commands.
struct PlotScript {
    std::string name;  ///< letters and underscores; makes ids of the SVG unique in a page
    int width = 0, height = 0;
    std::string commands;
};

bool gnuplot_is_installed();

/// Draws a plot. Files needed for it are written into `scratch_directory` (made when absent).
/// \return an <svg> element that scales to its container; ids are unique to the plot
/// \throws ToolError  when gnuplot cannot be started or refuses the script
std::string draw_svg(const PlotScript& plot, const std::filesystem::path& scratch_directory);

/// Data block `$name` of rows of fields; text fields are quoted by the caller with quoted().
std::string data_block(const std::string& name, const std::vector<std::vector<std::string>>& rows);

/// Text as gnuplot reads it between double quotes.
std::string quoted(const std::string& text);

}  // namespace cutterflow::postproc
