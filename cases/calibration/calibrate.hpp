#pragma once
/// \file Runs the studies of a calibration until its method ends: every run is a point of one sweep, and is made once.
#include <filesystem>
#include <functional>

#include "cases/calibration/calibration_file.hpp"
#include "cases/sweep/sweep.hpp"
#include "postproc/analysis/calibration/outcome.hpp"

namespace cutterflow::cases {

struct CalibrateSettings {
    std::filesystem::path file;
    std::filesystem::path folder;   ///< calibration.toml, calibration.json, index.html; runs/ is the sweep
    std::filesystem::path program;  ///< cutterflow
    int ranks = 1;                  ///< of each run
    int jobs = 1;                   ///< runs in parallel
    bool resume = false;
    Launcher launcher = Launcher::local;
    StudyAccess access{};
};

/// \throws UserError  as read_calibration; when the folder holds something else, or a calibration by another file, or `resume` does not fit
CalibrationFile begin_calibration(const CalibrateSettings& settings);

/// Goes through the method of a calibration that was begun. A run that fails leaves its repeat out; a place where a target has no value at
/// all is left out. Lines for the user go to `say`.
/// \throws UserError    when a run has no such measure
/// \throws ToolError    when no place has values of all targets
/// \throws Interrupted  when the user stops it; finished runs are kept
calibration::Outcome run_calibration(const CalibrationFile& file, const CalibrateSettings& settings,
                                     const std::function<void(const std::string&)>& say);

}  // namespace cutterflow::cases
