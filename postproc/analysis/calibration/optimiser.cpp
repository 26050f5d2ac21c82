#include "postproc/analysis/calibration/optimiser.hpp"

#include <exception>

#include <nlopt.hpp>

namespace cutterflow::postproc::calibration {

namespace {

constexpr double k_first_step = 0.5;

/// What NLopt calls: the function, and what it threw.
struct Call {
    const Function& function;
    std::exception_ptr thrown;
};

double evaluate(const std::vector<double>& at, std::vector<double>&, void* data) {
    auto& call = *static_cast<Call*>(data);
    try {
        return call.function(Eigen::Map<const Eigen::VectorXd>(at.data(), static_cast<Eigen::Index>(at.size())));
    } catch (...) {
        call.thrown = std::current_exception();
        throw nlopt::forced_stop();
    }
}

struct Minimum {
    Eigen::VectorXd at;      ///< the best place
    bool has_ended = false;  ///< before the evaluations were used up
};

/// Runs an algorithm to its end, whichever it is.
Minimum minimise(nlopt::algorithm algorithm, const Function& function, const Eigen::VectorXd& start, int evaluations,
                 const Eigen::VectorXd& tolerance, double first_step) {
    nlopt::opt optimiser(algorithm, static_cast<unsigned>(start.size()));
    Call call{function, nullptr};
    optimiser.set_lower_bounds(-1.0);
    optimiser.set_upper_bounds(1.0);
    optimiser.set_initial_step(first_step);
    optimiser.set_maxeval(evaluations);
    optimiser.set_xtol_abs(std::vector<double>(tolerance.data(), tolerance.data() + tolerance.size()));
    optimiser.set_min_objective(evaluate, &call);
    std::vector<double> at(start.data(), start.data() + start.size());
    double least = 0.0;
    bool has_ended = true;
    try {
        has_ended = optimiser.optimize(at, least) != nlopt::MAXEVAL_REACHED;
    } catch (const nlopt::forced_stop&) {
    } catch (const nlopt::roundoff_limited&) {
        // `at` is the best place so far
    }
    if (call.thrown) std::rethrow_exception(call.thrown);
    return {Eigen::Map<const Eigen::VectorXd>(at.data(), start.size()), has_ended};
}

}  // namespace

Eigen::VectorXd minimum_near(const Function& function, const Eigen::VectorXd& start) {
    return minimise(nlopt::LN_SBPLX, function, start, 400, Eigen::VectorXd::Constant(start.size(), 1e-5), 0.05).at;
}

bool bobyqa(const Function& function, const Eigen::VectorXd& start, int evaluations, const Eigen::VectorXd& tolerance) {
    return minimise(nlopt::LN_BOBYQA, function, start, evaluations, tolerance, k_first_step).has_ended;
}

}  // namespace cutterflow::postproc::calibration
