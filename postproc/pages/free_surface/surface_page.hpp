#pragma once
/// \file The report of a free-surface run: report/results.json and report/index.html.
#include <filesystem>

#include "postproc/analysis/surface_comparison.hpp"

namespace cutterflow::postproc {

/// Sizes of the scene, written beside it when the run is set up.
inline constexpr const char* k_surface_scene = "scene.json";

/// Whether a run directory is one of a free-surface study.
bool is_surface_run(const std::filesystem::path& run_directory);

/// Reads a run directory, finished or not, and writes both files. Without gnuplot the page has numbers and pictures but no plots.
/// \return the page
/// \throws UserError  when nothing was computed yet or a file breaks its contract
std::filesystem::path write_surface_report(const std::filesystem::path& run_directory);

}  // namespace cutterflow::postproc
