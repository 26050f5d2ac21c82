#pragma once
/// \file Minimisation within bounds by NLopt.
#include <functional>
#include <vector>

#include <Eigen/Core>

namespace cutterflow::postproc::calibration {

using Function = std::function<double(const Eigen::VectorXd&)>;

/// Least value of a cheap function between -1 and 1 from a start, by the subplex method, which takes kinks. \return where
Eigen::VectorXd minimum_near(const Function& function, const Eigen::VectorXd& start);

/// BOBYQA [Powell2009] between -1 and 1: a quadratic model through few evaluations, each of which may take hours. Two calls with the same
/// values go the same way, so that a resumed minimisation repeats its evaluations. What `function` throws is passed on.
/// \param evaluations  at most so many \param tolerance  smallest step of each parameter
/// \return whether it came to its end before the evaluations were used up
/// \pre two parameters or more
bool bobyqa(const Function& function, const Eigen::VectorXd& start, int evaluations, const Eigen::VectorXd& tolerance);

}  // namespace cutterflow::postproc::calibration
