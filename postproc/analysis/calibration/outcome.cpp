#include "postproc/analysis/calibration/outcome.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/statistics/sample.hpp"

namespace cutterflow::postproc::calibration {

namespace {

constexpr double k_at_end = 1e-3;     // of the range
constexpr double k_same_place = 0.1;  // of an interval's width

std::vector<Eigen::VectorXd> scaled_places(const Calibration& calibration) {
    std::vector<Eigen::VectorXd> places;
    for (const Evaluation& evaluation : calibration.evaluations) places.push_back(scaled(calibration.ranges, evaluation.parameters));
    return places;
}

Agreement agreement_of(const Target& target, bool held_out) {
    Agreement agreement;
    agreement.name = target.name;
    agreement.held_out = held_out;
    agreement.target = target.values;
    agreement.tolerance = target.tolerance;
    return agreement;
}

/// The fitted targets as the quadratic has them at the chosen parameters.
std::vector<Agreement> agreements_of_fit(const Outcome& outcome) {
    const Calibration& calibration = outcome.calibration;
    std::vector<Agreement> agreements;
    for (const Target& target : calibration.targets.fitted) agreements.push_back(agreement_of(target, false));
    if (!outcome.estimate) return agreements;
    const Surface surface(calibration.ranges, calibration.targets.fitted, calibration.evaluations);
    const Eigen::VectorXd at = scaled(calibration.ranges, outcome.parameters);
    const std::vector<std::vector<double>> fit = surface.model(at);
    for (std::size_t t = 0; t < agreements.size(); ++t) {
        agreements[t].fit = fit[t];
        const Response& response = surface.response(t);
        if (fit[t].size() == 1 && response.scatter_is_known()) agreements[t].fit_standard_error = std::sqrt(response.variance(at));
    }
    return agreements;
}

/// \param runs  of each run at the answer, each place of a profile
void judge_target(Agreement& agreement, const Target& target, const std::vector<std::vector<double>>& runs) {
    agreement.runs = runs.size();
    if (runs.empty()) return;
    agreement.model = mean_of(runs);
    agreement.in_tolerances = std::sqrt(find_objective("squared_misfit")->misfit(target, agreement.model));
    const bool has_zero = std::count(target.values.begin(), target.values.end(), 0.0) > 0;
    if (!has_zero) agreement.relative_error = find_objective("relative_error")->misfit(target, agreement.model);
    if (target.values.size() > 1 || runs.size() < 2) return;
    std::vector<double> values;
    for (const std::vector<double>& run : runs) values.push_back(run.front());
    agreement.standard_error = standard_error(sample_of(values));
}

nlohmann::json numbers(const Eigen::VectorXd& values) {
    return std::vector<double>(values.data(), values.data() + values.size());
}

nlohmann::json target_json(const Target& target, bool held_out) {
    return {{"name", target.name},
            {"values", target.values},
            {"tolerance", target.tolerance},
            {"weight", held_out ? nlohmann::json() : nlohmann::json(target.weight)},
            {"held_out", held_out}};
}

nlohmann::json optional_json(const std::optional<double>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json parameters_json(const Outcome& outcome) {
    nlohmann::json rows = nlohmann::json::array();
    for (std::size_t k = 0; k < outcome.calibration.ranges.size(); ++k) {
        const Range& range = outcome.calibration.ranges[k];
        nlohmann::json row{{"name", range.name},
                           {"value", outcome.parameters[static_cast<Eigen::Index>(k)]},
                           {"range", {range.low, range.high}},
                           {"tolerance", range.tolerance},
                           {"interval_95", nullptr},
                           {"determined", nullptr}};
        if (const ParameterInterval* interval = outcome.interval(k)) {
            row["interval_95"] = {interval->low, interval->high};
            row["interval_reaches_range"] = {interval->reaches_low, interval->reaches_high};
            row["determined"] = interval->determined();
        }
        rows.push_back(row);
    }
    return rows;
}

nlohmann::json estimate_json(const ParameterEstimate& estimate) {
    nlohmann::json directions = nlohmann::json::array();
    for (const Direction& direction : estimate.directions)
        directions.push_back(
            {{"along_half_ranges", numbers(direction.along)},
             {"eigenvalue", direction.eigenvalue},
             {"ratio", direction.ratio},
             {"half_width_half_ranges", std::isfinite(direction.half_width) ? nlohmann::json(direction.half_width) : nlohmann::json()},
             {"determined", direction.determined()}});
    return {{"minimum", numbers(estimate.parameters)},
            {"objective", estimate.objective},
            {"least_chi_squared", estimate.least_chi_squared},
            {"contradiction", estimate.contradiction},
            {"directions", directions}};
}

/// "held out: large disc: 20.4 +- 0.3 of 3 runs for 20.8, 0.30 tolerances off".
std::string agreement_text(const Agreement& agreement) {
    std::string text = fmt::format("{}{}: ", agreement.held_out ? "held out: " : "", agreement.name);
    if (agreement.model.empty()) return text + "no run at the answer has a value\n";
    const bool single = agreement.target.size() == 1;
    if (single) text += fmt::format("{:.4g}", agreement.model.front());
    if (agreement.standard_error) text += fmt::format(" +- {:.2g}", *agreement.standard_error);
    if (single) text += fmt::format(" of {} run(s) for {:.4g}, ", agreement.runs, agreement.target.front());
    return text + fmt::format("{:.2f} tolerances off\n", *agreement.in_tolerances);
}

double number_at(const nlohmann::json& value) {
    return value.get<double>();
}

}  // namespace

std::optional<ParameterEstimate> estimate_of(const Calibration& calibration) {
    if (!determine_quadratic(scaled_places(calibration))) return std::nullopt;
    return estimate(Surface(calibration.ranges, calibration.targets.fitted, calibration.evaluations), calibration.ranges,
                    *calibration.objective);
}

Outcome outcome_of(Calibration calibration, bool fitted_minimum) {
    Outcome outcome;
    outcome.estimate = estimate_of(calibration);
    for (const Evaluation& evaluation : calibration.evaluations)
        outcome.objectives.push_back(objective_of(*calibration.objective, calibration.targets.fitted, means_of(evaluation)));
    const auto best =
        static_cast<std::size_t>(std::min_element(outcome.objectives.begin(), outcome.objectives.end()) - outcome.objectives.begin());
    outcome.calibration = std::move(calibration);
    outcome.is_fitted_minimum = fitted_minimum && outcome.estimate.has_value();
    outcome.parameters = outcome.is_fitted_minimum ? outcome.estimate->parameters : outcome.calibration.evaluations[best].parameters;
    outcome.agreements = agreements_of_fit(outcome);
    for (std::size_t k = 0; k < outcome.calibration.ranges.size(); ++k)
        if (const ParameterInterval* interval = outcome.interval(k); interval != nullptr && !interval->determined())
            outcome.undetermined.push_back(outcome.calibration.ranges[k].name);
    return outcome;
}

void judge(Outcome& outcome, Evaluation answer) {
    const Targets& targets = outcome.calibration.targets;
    for (const Target& target : targets.held_out) outcome.agreements.push_back(agreement_of(target, true));
    std::vector<Target> all = targets.fitted;
    all.insert(all.end(), targets.held_out.begin(), targets.held_out.end());
    for (std::size_t t = 0; t < all.size(); ++t) judge_target(outcome.agreements[t], all[t], answer.values[t]);
    outcome.answer = std::move(answer);
}

nlohmann::json to_json(const Outcome& outcome) {
    const Calibration& calibration = outcome.calibration;
    nlohmann::json targets = nlohmann::json::array(), evaluations = nlohmann::json::array(), agreements = nlohmann::json::array();
    for (const Target& target : calibration.targets.fitted) targets.push_back(target_json(target, false));
    for (const Target& target : calibration.targets.held_out) targets.push_back(target_json(target, true));
    for (std::size_t i = 0; i < calibration.evaluations.size(); ++i) {
        const Evaluation& evaluation = calibration.evaluations[i];
        evaluations.push_back(
            {{"parameters", numbers(evaluation.parameters)}, {"objective", outcome.objectives[i]}, {"values", evaluation.values}});
    }
    for (const Agreement& agreement : outcome.agreements)
        agreements.push_back({{"name", agreement.name},
                              {"held_out", agreement.held_out},
                              {"target", agreement.target},
                              {"tolerance", agreement.tolerance},
                              {"fit", agreement.fit},
                              {"fit_standard_error", optional_json(agreement.fit_standard_error)},
                              {"runs", agreement.runs},
                              {"model", agreement.model},
                              {"standard_error", optional_json(agreement.standard_error)},
                              {"relative_error", optional_json(agreement.relative_error)},
                              {"in_tolerances", optional_json(agreement.in_tolerances)}});
    nlohmann::json answer;
    if (outcome.answer) answer = {{"parameters", numbers(outcome.answer->parameters)}, {"values", outcome.answer->values}};
    return {{"schema", k_calibration_schema},
            {"name", calibration.name},
            {"method", calibration.method},
            {"objective_function", calibration.objective->name},
            {"parameters", parameters_json(outcome)},
            {"undetermined", outcome.undetermined},
            {"targets", targets},
            {"agreements", agreements},
            {"estimate", outcome.estimate ? estimate_json(*outcome.estimate) : nlohmann::json()},
            {"evaluations", evaluations},
            {"answer", answer},
            {"cost",
             {{"runs", calibration.cost.runs},
              {"failed_runs", calibration.cost.failed_runs},
              {"core_h", calibration.cost.core_h},
              {"budget_runs", optional_json(calibration.cost.budget_runs)},
              {"budget_core_h", optional_json(calibration.cost.budget_core_h)}}},
            {"ended", calibration.ended}};
}

void certify_objectives(const nlohmann::json& calibration) {
    const ObjectiveFunction* function = find_objective(calibration.at("objective_function").get<std::string>());
    std::vector<Target> fitted;
    for (const nlohmann::json& target : calibration.at("targets"))
        if (!target.at("held_out").get<bool>())
            fitted.push_back({target.at("name"), target.at("values"), number_at(target.at("tolerance")), number_at(target.at("weight"))});
    for (const nlohmann::json& row : calibration.at("evaluations")) {
        Evaluation evaluation;
        evaluation.values = row.at("values").get<std::vector<std::vector<std::vector<double>>>>();
        if (evaluation.values.size() != fitted.size())
            throw CheckFailure({"", fmt::format("a place with values of {} targets", evaluation.values.size()),
                                fmt::format("Before the choice the {} fitted targets are looked at, and no held-out one", fitted.size()),
                                "Report this defect"});
        const double expected = objective_of(*function, fitted, means_of(evaluation)), written = number_at(row.at("objective"));
        if (!(std::abs(written - expected) <= 1e-9 * std::max(std::abs(expected), 1e-12)))
            throw CheckFailure({"", fmt::format("an objective of {} where the fitted targets give {}", written, expected),
                                "The objective is the sum over the fitted targets, without held-out ones", "Report this defect"});
    }
}

std::string interval_text(const ParameterInterval& interval, const Range& range, double value) {
    std::string text = interval.determined() ? fmt::format("{:.4g} to {:.4g}", interval.low, interval.high)
                                             : fmt::format("not determined by the targets in {:.4g} to {:.4g}", range.low, range.high);
    if (interval.determined() && interval.reaches_low) text += ", open at the low end";
    if (interval.determined() && interval.reaches_high) text += ", open at the high end";
    if (std::min(value - range.low, range.high - value) < k_at_end * (range.high - range.low))
        text += ": at the end of its range, which may exclude a better value";
    return text;
}

std::string known_text(const Outcome& outcome, std::size_t parameter) {
    if (!outcome.estimate) return "no interval: too few places";
    const ParameterInterval* interval = outcome.interval(parameter);
    if (interval == nullptr) return "no interval: the scatter is unknown";
    const auto k = static_cast<Eigen::Index>(parameter);
    const Range& range = outcome.calibration.ranges[parameter];
    const double value = outcome.parameters[k], likeliest = outcome.estimate->likeliest[k];
    std::string text = interval_text(*interval, range, value);
    if (outcome.is_fitted_minimum && interval->determined() && (value < interval->low || value > interval->high))
        text += "; the answer lies outside, as its objective weighs the targets otherwise";
    if (outcome.is_fitted_minimum && std::abs(value - likeliest) <= k_same_place * (interval->high - interval->low)) return "95 %: " + text;
    return fmt::format("95 % by the quadratic fit, least at {:.4g}: {}", likeliest, text);
}

std::string outcome_text(const Outcome& outcome) {
    std::string text;
    for (std::size_t k = 0; k < outcome.calibration.ranges.size(); ++k)
        text += fmt::format("{} = {:.4g}  ({})\n", outcome.calibration.ranges[k].name, outcome.parameters[static_cast<Eigen::Index>(k)],
                            known_text(outcome, k));
    for (const Agreement& agreement : outcome.agreements) text += agreement_text(agreement);
    return text + fmt::format("{} runs, {:.3g} core hours; {}\n", outcome.calibration.cost.runs, outcome.calibration.cost.core_h,
                              outcome.calibration.ended);
}

}  // namespace cutterflow::postproc::calibration
