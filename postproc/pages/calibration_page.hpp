#pragma once
/// \file calibration.json and the page of a calibration.
#include <filesystem>

#include "postproc/analysis/calibration/outcome.hpp"
#include "postproc/draw/plot.hpp"

namespace cutterflow::postproc {

/// The plots of the page: maps of the objective with the runs, targets along each parameter, profiles.
std::vector<Figure> calibration_figures(const calibration::Outcome& outcome);

/// Writes calibration.json and index.html anew. \return the page
/// \throws CheckFailure  when an objective is not that of the fitted targets alone
std::filesystem::path write_calibration(const calibration::Outcome& outcome, const std::filesystem::path& folder);

}  // namespace cutterflow::postproc
