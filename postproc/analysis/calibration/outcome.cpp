#include "postproc/analysis/calibration/outcome.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/error.hpp"

namespace cutterflow::postproc::calibration {

namespace {

using Values = std::vector<std::vector<double>>;  // of each target, each place

std::vector<Eigen::VectorXd> scaled_places(const Calibration& calibration) {
    std::vector<Eigen::VectorXd> places;
    for (const Evaluation& evaluation : calibration.evaluations) places.push_back(scaled(calibration.ranges, evaluation.parameters));
    return places;
}

Agreement agreement_of(const Target& target, bool held_out, const std::vector<double>& model) {
    Agreement found{target.name, held_out, target.values, model, target.tolerance, std::nullopt, std::nullopt, 0.0};
    found.in_tolerances = std::sqrt(find_objective("squared_misfit")->misfit(target, model));
    const bool has_zero = std::any_of(target.values.begin(), target.values.end(), [](double value) { return value == 0.0; });
    if (!has_zero) found.relative_error = find_objective("relative_error")->misfit(target, model);
    return found;
}

/// Of the fitted or the held-out targets, at chosen parameters.
void add_agreements(Outcome& outcome, bool held_out, const Evaluation* chosen) {
    const Calibration& calibration = outcome.calibration;
    const std::vector<Target>& targets = held_out ? calibration.targets.held_out : calibration.targets.fitted;
    const std::size_t first = held_out ? calibration.targets.fitted.size() : 0;
    std::optional<Surface> surface;
    const Eigen::VectorXd at = scaled(calibration.ranges, outcome.parameters);
    if (outcome.estimate) surface.emplace(calibration.ranges, targets, calibration.evaluations, first);
    const Values model = chosen ? means_of(*chosen) : Values{};
    for (std::size_t t = 0; t < targets.size(); ++t) {
        outcome.agreements.push_back(agreement_of(targets[t], held_out, chosen ? model[first + t] : surface->model(at)[t]));
        if (surface && targets[t].values.size() == 1)
            outcome.agreements.back().standard_error = std::sqrt(surface->response(t).variance(at));
    }
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
        if (outcome.estimate) {
            const ParameterInterval& interval = outcome.estimate->intervals[k];
            row["interval_95"] = {interval.low, interval.high};
            row["interval_reaches_range"] = {interval.reaches_low, interval.reaches_high};
            row["determined"] = interval.determined();
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
    const bool takes_fit = fitted_minimum && outcome.estimate.has_value();
    const Evaluation* chosen = takes_fit ? nullptr : &outcome.calibration.evaluations[best];
    outcome.parameters = takes_fit ? outcome.estimate->parameters : chosen->parameters;
    add_agreements(outcome, false, chosen);
    add_agreements(outcome, true, chosen);
    if (outcome.estimate)
        for (std::size_t k = 0; k < outcome.calibration.ranges.size(); ++k)
            if (!outcome.estimate->intervals[k].determined()) outcome.undetermined.push_back(outcome.calibration.ranges[k].name);
    return outcome;
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
                              {"model", agreement.model},
                              {"tolerance", agreement.tolerance},
                              {"standard_error", optional_json(agreement.standard_error)},
                              {"relative_error", optional_json(agreement.relative_error)},
                              {"in_tolerances", agreement.in_tolerances}});
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
    std::vector<std::size_t> places;
    const nlohmann::json& targets = calibration.at("targets");
    for (std::size_t t = 0; t < targets.size(); ++t) {
        if (targets[t].at("held_out").get<bool>()) continue;
        fitted.push_back(
            {targets[t].at("name"), targets[t].at("values"), number_at(targets[t].at("tolerance")), number_at(targets[t].at("weight"))});
        places.push_back(t);
    }
    for (const nlohmann::json& row : calibration.at("evaluations")) {
        Evaluation evaluation;
        for (const std::size_t t : places) evaluation.values.push_back(row.at("values")[t]);
        const double expected = objective_of(*function, fitted, means_of(evaluation)), written = number_at(row.at("objective"));
        if (!(std::abs(written - expected) <= 1e-9 * std::max(std::abs(expected), 1e-12)))
            throw CheckFailure({"", fmt::format("an objective of {} where the fitted targets give {}", written, expected),
                                "The objective is the sum over the fitted targets, without held-out ones", "Report this defect"});
    }
}

std::string outcome_text(const Outcome& outcome) {
    std::string text;
    for (std::size_t k = 0; k < outcome.calibration.ranges.size(); ++k) {
        text += fmt::format("{} = {:.4g}", outcome.calibration.ranges[k].name, outcome.parameters[static_cast<Eigen::Index>(k)]);
        if (outcome.estimate) {
            const ParameterInterval& interval = outcome.estimate->intervals[k];
            text += interval.determined() ? fmt::format("  ({:.4g} to {:.4g})", interval.low, interval.high)
                                          : fmt::format("  (not determined: all of {:.4g} to {:.4g})", interval.low, interval.high);
        }
        text += '\n';
    }
    for (const Agreement& agreement : outcome.agreements) {
        text += fmt::format("{}{}: ", agreement.held_out ? "held out: " : "", agreement.name);
        if (agreement.target.size() == 1) text += fmt::format("{:.4g} for {:.4g}, ", agreement.model.front(), agreement.target.front());
        text += fmt::format("{:.2f} tolerances off\n", agreement.in_tolerances);
    }
    return text + fmt::format("{} runs, {:.3g} core hours; {}\n", outcome.calibration.cost.runs, outcome.calibration.cost.core_h,
                              outcome.calibration.ended);
}

}  // namespace cutterflow::postproc::calibration
