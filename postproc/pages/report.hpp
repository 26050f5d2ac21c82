#pragma once
/// \file The report of a run: report/results.json and report/index.html.
#include <filesystem>
#include <string>

#include "postproc/analysis/results.hpp"

namespace cutterflow::postproc {

struct ReportSummary {
    std::filesystem::path results_file;
    std::filesystem::path page_file;
    Results results;
    std::string note;  ///< what the page had to leave out and why; empty when nothing
};

/// Reads a run directory, finished or not, with or without rock, and writes both files; each is written beside its place and renamed, so
/// that a reader never meets an incomplete file. Without gnuplot the page has tables and pictures but no plots, and states it.
/// \throws UserError     when the directory is no run, nothing was computed yet, or a file breaks its contract
/// \throws CheckFailure  when the fates of the rock do not add up
/// \throws ToolError     when gnuplot is there and fails
ReportSummary write_report(const std::filesystem::path& run_directory);

/// The same for publishing: results.json and a still page with its pictures in `folder`; the run's own report stays as it is.
/// results.json has one key more, `published_run`: the SHA-256 of what distinguishes the run (study, cutter, repeat).
/// \throws UserError  also when the folder holds anything but an earlier publication of the same run
ReportSummary publish_report(const std::filesystem::path& run_directory, const std::filesystem::path& folder);

}  // namespace cutterflow::postproc
