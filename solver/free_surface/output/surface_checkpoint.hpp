#pragma once
/// \file Checkpoints of a free-surface run: a folder that is renamed into place when it is whole.
#include <filesystem>

#include "solver/free_surface/surface_run.hpp"

namespace cutterflow::free_surface {

/// Writes checkpoints/<time> of a run folder, the DEM's part (may be null) among it.
void write_checkpoint(const std::filesystem::path& folder, const SurfaceState& state, coupling::DemEngine* bodies);

/// \throws UserError  when the file is not whole or of another scene (number of cells)
SurfaceState read_checkpoint(const std::filesystem::path& checkpoint, const StaggeredGrid& grid, coupling::DemEngine* bodies);

}  // namespace cutterflow::free_surface
