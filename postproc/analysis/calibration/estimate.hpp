#pragma once
/// \file Parameters at which runs agree best with the targets, how well the targets determine them, and where to run next.
///
/// chi^2(u) = sum over the fitted targets of (y(u) - t)^2/(sigma_t^2 + sigma_y^2(u)), with sigma_t = tolerance/1.96 and sigma_y^2 the
/// variance of the response (response.hpp); of a profile the mean over its places. The 95 % region of p parameters is where chi^2 exceeds
/// its minimum by at most p F(0.95; p, nu), the interval of one by at most F(0.95; 1, nu), the others chosen at their best; nu is the
/// least over the targets of nu_y ((sigma_t^2 + sigma_y^2)/sigma_y^2)^2 (Welch and Satterthwaite), nu_y that of the response: tolerances
/// are known, variances are estimated. Where no response has a variance the quantiles are those of chi squared. Targets contradict each
/// other when the least chi^2 is above its 95 % quantile for targets less parameters; both limits then grow by the ratio of the two.
#include <string>
#include <vector>

#include <Eigen/Core>

#include "postproc/analysis/calibration/objective.hpp"
#include "postproc/analysis/calibration/response.hpp"

namespace cutterflow::postproc::calibration {

struct Range {
    std::string name;
    double low = 0.0, high = 1.0;
    double tolerance = 0.0;  ///< half of an interval that is narrow enough
};

Eigen::VectorXd scaled(const std::vector<Range>& ranges, const Eigen::VectorXd& parameters);
Eigen::VectorXd unscaled(const std::vector<Range>& ranges, const Eigen::VectorXd& at);

/// Runs at one set of parameters.
struct Evaluation {
    Eigen::VectorXd parameters;
    /// Of each target, each repeat, each place of a profile. Of the places that are searched the fitted targets; at the answer the
    /// held-out ones too, after the fitted.
    std::vector<std::vector<std::vector<double>>> values;
};

/// Mean over the repeats of one target, of each place of a profile.
std::vector<double> mean_of(const std::vector<std::vector<double>>& repeats);

/// Means over the repeats: of each target, each place of a profile.
std::vector<std::vector<double>> means_of(const Evaluation& evaluation);

/// Quadratic responses of targets.
class Surface {
public:
    /// \pre the evaluations determine every term
    Surface(const std::vector<Range>& ranges, const std::vector<Target>& targets, const std::vector<Evaluation>& evaluations);

    /// Of each target at scaled parameters.
    std::vector<std::vector<double>> model(const Eigen::VectorXd& at) const;
    double chi_squared(const Eigen::VectorXd& at) const;
    /// Half the matrix of second derivatives of chi^2 without those of the responses: sum of g g^T/sigma^2.
    Eigen::MatrixXd information(const Eigen::VectorXd& at) const;

    /// nu above; infinite where no response has a variance, 0 where the scatter of one is unknown.
    double degrees_of_freedom(const Eigen::VectorXd& at) const;
    /// Of a target: the response at its first place.
    const Response& response(std::size_t target) const { return responses_[target].front(); }
    const std::vector<Target>& targets() const { return targets_; }

private:
    std::vector<Target> targets_;
    std::vector<std::vector<Response>> responses_;  // of each target, each place
};

/// The 95 % interval of a parameter, in its own unit.
struct ParameterInterval {
    double low = 0.0, high = 0.0;
    bool reaches_low = false, reaches_high = false;  ///< the end of the range: the targets do not bound it there
    bool determined() const { return !(reaches_low && reaches_high); }
};

/// A direction of the parameters, scaled, and what the targets say along it.
struct Direction {
    Eigen::VectorXd along;    ///< of length 1
    double eigenvalue = 0.0;  ///< of the information
    double ratio = 1.0;       ///< to the largest eigenvalue
    double half_width = 0.0;  ///< of the 95 % interval along it, in half ranges
    bool determined() const { return half_width < 1.0; }
};

/// Values over two parameters; what is least over the others.
struct Map {
    std::size_t first = 0, second = 0;       ///< indices of the parameters
    std::vector<double> x, y;                ///< in their own units
    std::vector<double> objective;           ///< at x[i], y[j]: value i + j*x.size()
    std::vector<double> region_x, region_y;  ///< x and y, and the place where chi^2 is least
    std::vector<double> distance;            ///< there: root of (chi^2 above its minimum, over the limit of the region), 1 on its edge
};

/// Values along one parameter; what is least over the others.
struct ObjectiveProfile {
    std::vector<double> x, objective;
    std::vector<double> distance;  ///< at x: as in Map, with the limit of the interval
};

struct ParameterEstimate {
    Eigen::VectorXd parameters;  ///< where the objective is least
    double objective = 0.0;
    std::vector<std::vector<double>> model;    ///< of the fitted targets there
    std::vector<ParameterInterval> intervals;  ///< none where the scatter of a response is unknown
    std::vector<Direction> directions;         ///< best determined first
    Eigen::VectorXd likeliest;                 ///< where chi-squared is least, about which the intervals lie; weights do not count there
    double least_chi_squared = 0.0;
    double contradiction = 1.0;              ///< factor of the intervals' squares for targets that contradict each other
    std::vector<ObjectiveProfile> profiles;  ///< of each parameter
    std::vector<Map> maps;                   ///< of each pair of parameters
};

/// \pre one to four parameters
ParameterEstimate estimate(const Surface& surface, const std::vector<Range>& ranges, const ObjectiveFunction& function);

/// Whether every interval is known and as narrow as its tolerance asks.
bool narrow_enough(const ParameterEstimate& estimate, const std::vector<Range>& ranges);

/// Up to three places in the region to run next: the estimate, and two on either side of it along the direction that is determined worst.
/// Places that were run are left out.
std::vector<Eigen::VectorXd> next_places(const ParameterEstimate& estimate, const std::vector<Range>& ranges,
                                         const std::vector<Evaluation>& evaluations);

}  // namespace cutterflow::postproc::calibration
