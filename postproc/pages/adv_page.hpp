#pragma once
/// \file report/adv.html and adv.json: measured velocities beside the model's.
#include <filesystem>

#include "postproc/analysis/adv_comparison.hpp"

namespace cutterflow::postproc {

/// Writes both files into the run's report/. Without gnuplot the page has its tables and names the missing program.
/// \return the page
std::filesystem::path write_adv_report(const AdvComparison& comparison, const std::filesystem::path& run_directory);

}  // namespace cutterflow::postproc
