#include "postproc/analysis/calibration/response.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "geometry/base/statistics/sample.hpp"

namespace cutterflow::postproc::calibration {

namespace {

/// Degrees of freedom that the pooled scatter counts for beside that of a point's own repeats, which are few.
constexpr double k_pooled_freedom = 4.0;

struct Means {
    Eigen::VectorXd mean, variance;  ///< of each point; the variance is that of its mean
    double scatter = 0.0, freedom = 0.0;
};

Means means_of(const std::vector<Repeats>& points) {
    const auto count = static_cast<Eigen::Index>(points.size());
    Means means{Eigen::VectorXd(count), Eigen::VectorXd(count), 0.0, 0.0};
    std::vector<Sample> samples;
    double squares = 0.0;
    for (const Repeats& point : points) {
        samples.push_back(sample_of(point.values));
        if (samples.back().count < 2) continue;
        const auto freedom = static_cast<double>(samples.back().count - 1);
        squares += freedom * samples.back().variance;
        means.freedom += freedom;
    }
    if (means.freedom > 0.0) means.scatter = squares / means.freedom;
    for (Eigen::Index i = 0; i < count; ++i) {
        const Sample& sample = samples[static_cast<std::size_t>(i)];
        const double own_freedom = sample.count > 1 ? static_cast<double>(sample.count - 1) : 0.0;
        const double own = own_freedom > 0.0 ? sample.variance : 0.0;
        means.mean[i] = sample.mean;
        means.variance[i] =
            (k_pooled_freedom * means.scatter + own_freedom * own) / (k_pooled_freedom + own_freedom) / static_cast<double>(sample.count);
    }
    return means;
}

Eigen::MatrixXd terms_of(const std::vector<Eigen::VectorXd>& places) {
    Eigen::MatrixXd terms(static_cast<Eigen::Index>(places.size()), quadratic_terms(places.front()).size());
    for (std::size_t i = 0; i < places.size(); ++i) terms.row(static_cast<Eigen::Index>(i)) = quadratic_terms(places[i]).transpose();
    return terms;
}

std::vector<Eigen::VectorXd> places_of(const std::vector<Repeats>& points) {
    std::vector<Eigen::VectorXd> places;
    for (const Repeats& point : points) places.push_back(point.at);
    return places;
}

struct Fit {
    Eigen::VectorXd coefficients;
    Eigen::MatrixXd inverse;  ///< of X^T W X
    double squares = 0.0;     ///< weighted, of the residuals
};

Fit fit_of(const Eigen::MatrixXd& terms, const Eigen::VectorXd& values, const Eigen::VectorXd& weights) {
    const Eigen::VectorXd roots = weights.cwiseSqrt();
    const Eigen::MatrixXd weighted = roots.asDiagonal() * terms;
    const Eigen::VectorXd scaled_values = roots.cwiseProduct(values);
    const auto normal = (weighted.transpose() * weighted).ldlt();
    Fit fit{weighted.colPivHouseholderQr().solve(scaled_values), normal.solve(Eigen::MatrixXd::Identity(terms.cols(), terms.cols())), 0.0};
    fit.squares = (scaled_values - weighted * fit.coefficients).squaredNorm();
    return fit;
}

/// DerSimonian and Laird's estimate for a regression.
double misfit_of(const Eigen::MatrixXd& terms, const Fit& fit, const Eigen::VectorXd& weights, double freedom) {
    const double taken = (fit.inverse * (terms.transpose() * weights.cwiseAbs2().asDiagonal() * terms)).trace();
    return std::max(0.0, (fit.squares - freedom) / (weights.sum() - taken));
}

}  // namespace

Eigen::VectorXd quadratic_terms(const Eigen::VectorXd& at) {
    const Eigen::Index n = at.size();
    Eigen::VectorXd terms(static_cast<Eigen::Index>(quadratic_term_count(static_cast<std::size_t>(n))));
    Eigen::Index next = 0;
    terms[next++] = 1.0;
    for (Eigen::Index i = 0; i < n; ++i) terms[next++] = at[i];
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = i; j < n; ++j) terms[next++] = at[i] * at[j];
    return terms;
}

std::size_t quadratic_term_count(std::size_t parameters) {
    return (parameters + 1) * (parameters + 2) / 2;
}

bool determine_quadratic(const std::vector<Eigen::VectorXd>& places) {
    if (places.empty()) return false;
    const Eigen::MatrixXd terms = terms_of(places);
    return terms.colPivHouseholderQr().rank() == terms.cols();
}

Response::Response(const std::vector<Repeats>& points) {
    const Means means = means_of(points);
    const Eigen::MatrixXd terms = terms_of(places_of(points));
    scatter_ = means.scatter;
    freedom_ = means.freedom;
    spare_ = points.size() - static_cast<std::size_t>(terms.cols());
    const auto spare = static_cast<double>(spare_);
    Eigen::VectorXd variance = means.variance;
    const bool scatters = scatter_ > 0.0;
    Eigen::VectorXd weights = scatters ? variance.cwiseInverse().eval() : Eigen::VectorXd::Ones(variance.size()).eval();
    Fit fit = fit_of(terms, means.mean, weights);
    if (spare_ > 0) misfit_ = scatters ? misfit_of(terms, fit, weights, spare) : fit.squares / spare;
    if (misfit_ > 0.0) {
        weights = (variance.array() + misfit_).inverse();
        fit = fit_of(terms, means.mean, weights);
    }
    coefficients_ = fit.coefficients;
    covariance_ = scatters || misfit_ > 0.0 ? fit.inverse : Eigen::MatrixXd::Zero(terms.cols(), terms.cols()).eval();
}

double Response::variance(const Eigen::VectorXd& at) const {
    const Eigen::VectorXd terms = quadratic_terms(at);
    return terms.dot(covariance_ * terms) + misfit_;
}

double Response::degrees_of_freedom(const Eigen::VectorXd& at) const {
    const auto spare = static_cast<double>(spare_);
    if (scatter_ == 0.0 || misfit_ == 0.0) return scatter_ == 0.0 ? spare : freedom_;
    const double all = variance(at), of_fit = all - misfit_;
    return all * all / (of_fit * of_fit / freedom_ + misfit_ * misfit_ / spare);
}

Eigen::VectorXd Response::gradient(const Eigen::VectorXd& at) const {
    const Eigen::Index n = at.size();
    Eigen::VectorXd slope = coefficients_.segment(1, n);
    Eigen::Index next = n + 1;
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = i; j < n; ++j, ++next) {
            slope[i] += coefficients_[next] * at[j];
            slope[j] += coefficients_[next] * at[i];
        }
    return slope;
}

}  // namespace cutterflow::postproc::calibration
