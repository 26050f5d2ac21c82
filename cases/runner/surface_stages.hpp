#pragma once
/// \file The stages of a free-surface study in its run directory: case, run, report.
#include "cases/runner/run_directory.hpp"
#include "cases/runner/stages.hpp"

namespace cutterflow::cases {

/// \param solver  cutterSurface
/// \throws UserError  with every mistake of the study file
std::vector<Stage> surface_stages(const RunDirectory& directory, const std::filesystem::path& study_file,
                                  const std::filesystem::path& solver);

}  // namespace cutterflow::cases
