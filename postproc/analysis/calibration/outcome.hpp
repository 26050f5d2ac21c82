#pragma once
/// \file What a calibration found: calibration.json (schema cutterflow.calibration/2), and the certificate of its objective.
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "postproc/analysis/calibration/estimate.hpp"

namespace cutterflow::postproc::calibration {

inline constexpr const char* k_calibration_schema = "cutterflow.calibration/2";

struct CalibrationCost {
    std::size_t runs = 0, failed_runs = 0;
    double core_h = 0.0;  ///< of all runs, as they noted it
    std::optional<double> budget_runs, budget_core_h;
};

/// A target beside what the chosen parameters give.
struct Agreement {
    std::string name;
    bool held_out = false;
    std::vector<double> target;
    double tolerance = 0.0;
    std::vector<double> fit;                   ///< of a fitted target, by the quadratic; empty without one
    std::optional<double> fit_standard_error;  ///< of a single value: scatter of the fit and misfit of the quadratic, where known
    std::size_t runs = 0;                      ///< at the answer that have a value
    std::vector<double> model;                 ///< mean of those runs; empty without any
    std::optional<double> standard_error;      ///< of the mean of a single value, from two runs on
    std::optional<double> relative_error;      ///< mean of |model - target|/|target|; none with a target of 0
    std::optional<double> in_tolerances;       ///< root mean square of (model - target)/tolerance
};

struct Calibration {
    std::string name, method;
    const ObjectiveFunction* objective = nullptr;
    std::vector<Range> ranges;
    Targets targets;
    std::vector<Evaluation> evaluations;
    CalibrationCost cost;
    std::string ended;  ///< why no further runs were made
};

struct Outcome {
    Calibration calibration;
    Eigen::VectorXd parameters;                 ///< chosen ones
    bool is_fitted_minimum = false;             ///< whether they are where the fit is least; else at the best evaluation
    std::vector<double> objectives;             ///< of each evaluation, at the means of its repeats
    std::optional<ParameterEstimate> estimate;  ///< none when the evaluations do not determine the quadratic
    std::optional<Evaluation> answer;           ///< runs at the chosen parameters, of all targets: no part of the fit
    std::vector<Agreement> agreements;          ///< fitted targets; with the answer then the held-out ones
    std::vector<std::string> undetermined;      ///< names of parameters that the targets do not determine

    /// Of a parameter; null without an estimate, and where the scatter is unknown.
    const ParameterInterval* interval(std::size_t parameter) const {
        return estimate && !estimate->intervals.empty() ? &estimate->intervals[parameter] : nullptr;
    }
};

/// The fit through all evaluations; none when they do not determine it. It sees no held-out target.
std::optional<ParameterEstimate> estimate_of(const Calibration& calibration);

/// Chooses the parameters.
/// \param fitted_minimum  whether the least value of the fit is chosen; else the best evaluation
/// \pre one evaluation or more
Outcome outcome_of(Calibration calibration, bool fitted_minimum);

/// Judges all targets by runs at the chosen parameters that had no part in the choice.
/// \param answer  of the fitted, then of the held-out targets; a target without any value is told so
void judge(Outcome& outcome, Evaluation answer);

nlohmann::json to_json(const Outcome& outcome);

/// Recomputes every objective of a calibration.json from the values of the targets that it says were fitted, and those alone.
/// \throws CheckFailure  when one differs by more than 1e-9 of itself, or a place has values of other targets: something else entered it,
/// such as a held-out target
void certify_objectives(const nlohmann::json& calibration);

/// "0.31 to 0.42", and where the targets leave it open. \param value  the chosen one; at an end of its range that is told
std::string interval_text(const ParameterInterval& interval, const Range& range, double value);

/// What is known of a parameter beside its value: "95 %: 0.31 to 0.42", or why there is no interval. Where the best
/// evaluation is chosen the interval lies around another value, which is told.
std::string known_text(const Outcome& outcome, std::size_t parameter);

/// The answer in a few lines of plain text.
std::string outcome_text(const Outcome& outcome);

}  // namespace cutterflow::postproc::calibration
