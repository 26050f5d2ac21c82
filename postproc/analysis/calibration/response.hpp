#pragma once
/// \file A quantity of runs as a quadratic function of the parameters, fitted through noisy runs.
///
/// Parameters are scaled: u = -1 at the low end of the range of each, 1 at the high end. The model is
///
///     y(u) = b0 + sum_i b_i u_i + sum_{i<=j} b_ij u_i u_j + delta + epsilon,
///
/// epsilon the scatter of repeats, delta the misfit of the quadratic, of variance tau^2 (DerSimonian and Laird's estimate). The
/// coefficients are those of weighted least squares with the weights 1/(s^2/n + tau^2) of a point with n repeats.
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace cutterflow::postproc::calibration {

/// Repeats at one place.
struct Repeats {
    Eigen::VectorXd at;          ///< scaled parameters
    std::vector<double> values;  ///< one of each repeat
};

/// 1, u_i, u_i u_j with i <= j.
Eigen::VectorXd quadratic_terms(const Eigen::VectorXd& at);

/// How many of them there are. \param parameters  number of parameters
std::size_t quadratic_term_count(std::size_t parameters);

/// Whether the points determine every term: there are enough of them, and each parameter has three values or more.
bool determine_quadratic(const std::vector<Eigen::VectorXd>& places);

class Response {
public:
    /// \pre the places of the points determine every term
    explicit Response(const std::vector<Repeats>& points);

    double value(const Eigen::VectorXd& at) const { return quadratic_terms(at).dot(coefficients_); }
    /// Of the true mean of repeats at a place about value(at): scatter of the fit, and misfit of the quadratic.
    double variance(const Eigen::VectorXd& at) const;
    Eigen::VectorXd gradient(const Eigen::VectorXd& at) const;

    /// Of one repeat, pooled over the points; 0 without repeats or scatter.
    double scatter_variance() const { return scatter_; }
    /// tau^2
    double misfit_variance() const { return misfit_; }
    /// Of variance(at), by Welch and Satterthwaite: nu = (v_s + tau^2)^2/(v_s^2/nu_s + tau^4/nu_m), v_s of the fit with the nu_s of the
    /// pooled scatter, nu_m the spare points. Where nothing scatters, all of it is known from the spare points.
    double degrees_of_freedom(const Eigen::VectorXd& at) const;
    /// Whether repeats or spare points tell it. Without either the quadratic goes through all points, and its variance of 0 means nothing.
    bool scatter_is_known() const { return freedom_ > 0.0 || spare_ > 0; }
    /// Points more than terms: without any the misfit of the quadratic is unknown, and taken as 0.
    std::size_t spare_points() const { return spare_; }

private:
    Eigen::VectorXd coefficients_;
    Eigen::MatrixXd covariance_;
    double scatter_ = 0.0, misfit_ = 0.0, freedom_ = 0.0;
    std::size_t spare_ = 0;
};

}  // namespace cutterflow::postproc::calibration
