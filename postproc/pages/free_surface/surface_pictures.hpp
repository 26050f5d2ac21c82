#pragma once
/// \file Snapshots of a free-surface run with their scales.
#include <filesystem>
#include <string>

#include "postproc/analysis/surface_results.hpp"
#include "postproc/draw/page.hpp"

namespace cutterflow::postproc {

/// Six times of the fields that a run wrote, as figures (markup): water by its share of a cell and its speed, solids, bodies, a bar of
/// length and the speeds of the colours. Empty without fields.
std::string surface_pictures(const Page& page, const SurfaceRows& rows, const std::filesystem::path& run_directory);

}  // namespace cutterflow::postproc
