#include "postproc/analysis/calibration/objective.hpp"

#include <algorithm>
#include <cmath>

namespace cutterflow::postproc::calibration {

namespace {

double relative_error(const Target& target, const std::vector<double>& model) {
    double sum = 0.0;
    for (std::size_t i = 0; i < target.values.size(); ++i) sum += std::abs(model[i] - target.values[i]) / std::abs(target.values[i]);
    return sum / static_cast<double>(target.values.size());
}

double squared_misfit(const Target& target, const std::vector<double>& model) {
    double sum = 0.0;
    for (std::size_t i = 0; i < target.values.size(); ++i) {
        const double misfit = (model[i] - target.values[i]) / target.tolerance;
        sum += misfit * misfit;
    }
    return sum / static_cast<double>(target.values.size());
}

}  // namespace

const std::vector<ObjectiveFunction>& objective_functions() {
    static const std::vector<ObjectiveFunction> rows{
        {"squared_misfit", "sum of w ((model - target)/tolerance)^2", squared_misfit, false,
         "A target that is met within its tolerance adds less than its weight; a profile adds the mean over its places.", ""},
        {"relative_error", "sum of w |model - target|/|target|", relative_error, true,
         "A profile adds the mean over its places of |h - h_target|/h_target.", "WasserfallCoetzeeMeyer2024"}};
    return rows;
}

const ObjectiveFunction* find_objective(const std::string& name) {
    const auto& rows = objective_functions();
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const ObjectiveFunction& row) { return row.name == name; });
    return found == rows.end() ? nullptr : &*found;
}

double objective_of(const ObjectiveFunction& function, const std::vector<Target>& targets, const std::vector<std::vector<double>>& model) {
    double sum = 0.0;
    for (std::size_t i = 0; i < targets.size(); ++i) sum += targets[i].weight * function.misfit(targets[i], model[i]);
    return sum;
}

}  // namespace cutterflow::postproc::calibration
