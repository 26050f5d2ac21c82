#pragma once
/// \file The stages of a free-surface study in its run directory: case, run, report.
#include "cases/runner/run_directory.hpp"
#include "cases/runner/stages.hpp"
#include "cases/scenes/free_surface/surface_study.hpp"

namespace cutterflow::cases {

/// \param check  of the study file; \param solver  cutterSurface
std::vector<Stage> surface_stages(const RunDirectory& directory, const std::filesystem::path& study_file, const SurfaceCheck& check,
                                  const std::filesystem::path& solver);

}  // namespace cutterflow::cases
