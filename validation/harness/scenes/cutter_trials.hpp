#pragma once
/// \file Short runs of the draft model cutter through the program itself, one option changed at a time: what the pareto cases of the
/// cutter's outflow share.
#include <optional>
#include <string>
#include <vector>

#include "cases/scenes/cutter/case_inputs.hpp"
#include "validation/harness/verification.hpp"

namespace cutterflow::validation {

/// What a trial changes in the study; what is absent stays at the program's default.
struct CutterOptions {
    std::optional<double> max_courant, gamma, dem_step, youngs_modulus;
    std::optional<cases::ConvectionScheme> convection;  ///< not a setting of a study: an override of the run
    /// Without: a quarter of a revolution of the flow alone, its outflow averaged over the last blade passing. With: a twelfth of the flow
    /// alone and a twelfth with 60 rocks, averaged over the latter.
    bool rock = false;
};

/// A value of an option.
struct CutterValue {
    std::string label;
    CutterOptions options;
    bool standard = false;  ///< the program's default
};

/// An option; the last value is the finest, which the others are held against.
struct CutterSweep {
    std::string title;
    std::vector<CutterValue> values;
};

/// Shows one chart and one table a sweep: processor time of the transient run, the outflow of the first bin below the ring
/// and the mean torque of the flow. All trials
/// share mesh and frozen-rotor flow, as the points of a sweep do; what an earlier start of the case finished is kept.
/// \param standard  the defaults, of which there is one run
void run_cutter_sweeps(Verification& verification, const CutterOptions& standard, const std::vector<CutterSweep>& sweeps);

}  // namespace cutterflow::validation
