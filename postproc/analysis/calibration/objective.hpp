#pragma once
/// \file What the runs of a calibration are to agree with, and how far they are from it.
#include <string>
#include <vector>

namespace cutterflow::postproc::calibration {

/// A measured quantity: one number, or heights of a profile at places along it.
struct Target {
    std::string name;
    std::vector<double> values;  ///< one, or one for each place of a profile
    double tolerance = 0.0;      ///< half of its 95 % interval, in its own unit
    double weight = 1.0;         ///< in the objective
};

/// Held-out targets are a list of their own: no function that adds up an objective takes them.
struct Targets {
    std::vector<Target> fitted, held_out;
};

/// Distance of one target from what a run gives for it.
struct ObjectiveFunction {
    const char* name;
    const char* equation;
    /// \param model  as many values as the target has
    double (*misfit)(const Target& target, const std::vector<double>& model);
    bool relative;  ///< divides by the target: a target of 0 is refused
    const char* help;
    const char* reference;  ///< key in docs/references.bib, may be empty
};

/// "relative_error" and "squared_misfit".
const std::vector<ObjectiveFunction>& objective_functions();

/// The row of a name; null when there is none.
const ObjectiveFunction* find_objective(const std::string& name);

/// Sum over the targets of weight times misfit.
/// \param model  values of each target
double objective_of(const ObjectiveFunction& function, const std::vector<Target>& targets, const std::vector<std::vector<double>>& model);

}  // namespace cutterflow::postproc::calibration
