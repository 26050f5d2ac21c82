#include "postproc/analysis/calibration/estimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include <Eigen/Eigenvalues>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>

#include "postproc/analysis/calibration/optimiser.hpp"

namespace cutterflow::postproc::calibration {

namespace {

constexpr double k_confidence = 0.95;
constexpr double k_normal_quantile = 1.959964;  // of 0.975
constexpr double k_many = 1e6;                  // degrees of freedom: F is chi squared to a millionth, and its quantile fails far above

/// Values along each parameter of the net that is searched: 1 to 4 parameters.
constexpr std::array<Eigen::Index, 4> k_net{401, 81, 31, 15};

/// What chi^2 may rise in the region of `count` parameters: without degrees of freedom by any amount.
double rise(std::size_t count, double freedom) {
    if (freedom == 0.0) return std::numeric_limits<double>::infinity();
    const auto p = static_cast<double>(count);
    if (freedom > k_many) return quantile(boost::math::chi_squared(p), k_confidence);
    return p * quantile(boost::math::fisher_f(p, freedom), k_confidence);
}

/// From the minimum, 1 on the edge. Of a parabola it grows linearly, so that it is interpolated without error.
double distance(double chi_squared, double least, double limit) {
    return std::sqrt(std::max(0.0, chi_squared - least) / limit);
}

/// A regular net over all scaled parameters with the values on it.
struct Net {
    Eigen::Index parameters = 0, side = 0;
    std::vector<double> objective, chi_squared;

    std::size_t size() const { return objective.size(); }
    double coordinate(Eigen::Index index) const { return -1.0 + 2.0 * static_cast<double>(index) / static_cast<double>(side - 1); }
    Eigen::Index nearest(double coordinate) const { return std::lround(0.5 * (coordinate + 1.0) * static_cast<double>(side - 1)); }
    /// Of its values along a parameter and one more, in order.
    std::vector<double> coordinates_with(double one) const {
        std::vector<double> all{one};
        for (Eigen::Index i = 0; i < side; ++i)
            if (coordinate(i) != one) all.push_back(coordinate(i));
        std::sort(all.begin(), all.end());
        return all;
    }
    Eigen::Index index(std::size_t node, Eigen::Index parameter) const {
        auto rest = static_cast<Eigen::Index>(node);
        for (Eigen::Index k = 0; k < parameter; ++k) rest /= side;
        return rest % side;
    }
    Eigen::VectorXd place(std::size_t node) const {
        Eigen::VectorXd at(parameters);
        for (Eigen::Index k = 0; k < parameters; ++k) at[k] = coordinate(index(node, k));
        return at;
    }
};

class Search {
public:
    Search(const Surface& surface, const std::vector<Range>& ranges, const ObjectiveFunction& function)
        : surface_(surface), ranges_(ranges), function_(function) {
        net_.parameters = static_cast<Eigen::Index>(ranges.size());
        net_.side = k_net[ranges.size() - 1];
        std::size_t nodes = 1;
        for (std::size_t k = 0; k < ranges.size(); ++k) nodes *= static_cast<std::size_t>(net_.side);
        net_.objective.resize(nodes);
        net_.chi_squared.resize(nodes);
        for (std::size_t node = 0; node < nodes; ++node) {
            const Eigen::VectorXd at = net_.place(node);
            net_.objective[node] = objective(at);
            net_.chi_squared[node] = surface_.chi_squared(at);
        }
    }

    ParameterEstimate result() const {
        ParameterEstimate found;
        const Eigen::VectorXd best = best_place(net_.objective, [this](const Eigen::VectorXd& at) { return objective(at); });
        found.parameters = unscaled(ranges_, best);
        found.objective = objective(best);
        found.model = surface_.model(best);
        const auto chi = [this](const Eigen::VectorXd& at) { return surface_.chi_squared(at); };
        const Eigen::VectorXd likeliest = best_place(net_.chi_squared, chi);
        found.likeliest = unscaled(ranges_, likeliest);
        found.least_chi_squared = chi(likeliest);
        const double spare = static_cast<double>(surface_.targets().size()) - static_cast<double>(ranges_.size());
        if (spare > 0.0 && found.least_chi_squared > quantile(boost::math::chi_squared(spare), k_confidence))
            found.contradiction = found.least_chi_squared / spare;
        const double freedom = surface_.degrees_of_freedom(likeliest);
        const double limit = rise(1, freedom) * found.contradiction, region = rise(ranges_.size(), freedom) * found.contradiction;
        for (Eigen::Index k = 0; k < net_.parameters; ++k) {
            found.profiles.push_back(profile(k, found.least_chi_squared, limit));
            if (freedom > 0.0) found.intervals.push_back(interval(k, found.profiles.back(), likeliest));
        }
        for (Eigen::Index k = 0; k < net_.parameters; ++k)
            for (Eigen::Index l = k + 1; l < net_.parameters; ++l)
                found.maps.push_back(map(k, l, likeliest, found.least_chi_squared, region));
        found.directions = directions(likeliest, limit);
        return found;
    }

private:
    double objective(const Eigen::VectorXd& at) const { return objective_of(function_, surface_.targets(), surface_.model(at)); }

    Eigen::VectorXd best_place(const std::vector<double>& values, const Function& function) const {
        const auto node = static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin());
        const Eigen::VectorXd start = net_.place(node), polished = minimum_near(function, start);
        return function(polished) < values[node] ? polished : start;
    }

    /// Least value of chi^2 with some parameters held where they are in `start`, the others from there on.
    double least_from(const Eigen::VectorXd& start, const std::vector<Eigen::Index>& held) const {
        std::vector<Eigen::Index> others;
        for (Eigen::Index k = 0; k < net_.parameters; ++k)
            if (std::find(held.begin(), held.end(), k) == held.end()) others.push_back(k);
        const double there = surface_.chi_squared(start);
        if (others.empty()) return there;
        const Function function = [&](const Eigen::VectorXd& values) {
            Eigen::VectorXd at = start;
            at(others) = values;
            return surface_.chi_squared(at);
        };
        return std::min(there, function(minimum_near(function, start(others))));
    }

    ObjectiveProfile profile(Eigen::Index parameter, double least, double limit) const {
        const auto side = static_cast<std::size_t>(net_.side);
        std::vector<std::size_t> best(side, net_.size());
        ObjectiveProfile found;
        found.objective.assign(side, std::numeric_limits<double>::infinity());
        for (std::size_t node = 0; node < net_.size(); ++node) {
            const auto i = static_cast<std::size_t>(net_.index(node, parameter));
            found.objective[i] = std::min(found.objective[i], net_.objective[node]);
            if (best[i] == net_.size() || net_.chi_squared[node] < net_.chi_squared[best[i]]) best[i] = node;
        }
        for (std::size_t i = 0; i < side; ++i) {
            const Eigen::VectorXd at = net_.place(best[i]);
            found.x.push_back(unscaled(ranges_, at)[parameter]);
            found.distance.push_back(distance(least_from(at, {parameter}), least, limit));
        }
        return found;
    }

    /// From the first to the last value where the distance is at most 1. The minimum is one of the values: the interval holds it, also
    /// where it is narrower than the net.
    ParameterInterval interval(Eigen::Index parameter, const ObjectiveProfile& profile, const Eigen::VectorXd& likeliest) const {
        struct Point {
            double x, distance;
        };
        std::vector<Point> points;
        for (std::size_t i = 0; i < profile.x.size(); ++i) points.push_back({profile.x[i], profile.distance[i]});
        const Point minimum{unscaled(ranges_, likeliest)[parameter], 0.0};
        points.insert(std::upper_bound(points.begin(), points.end(), minimum, [](const Point& a, const Point& b) { return a.x < b.x; }),
                      minimum);
        const auto inside = [](const Point& point) { return point.distance <= 1.0; };
        const auto crossing = [](const Point& in, const Point& out) {
            return in.x + (1.0 - in.distance) / (out.distance - in.distance) * (out.x - in.x);
        };
        const auto first = std::find_if(points.begin(), points.end(), inside);
        const auto last = std::prev(std::find_if(points.rbegin(), points.rend(), inside).base());
        ParameterInterval found;
        found.reaches_low = first == points.begin();
        found.reaches_high = std::next(last) == points.end();
        found.low = found.reaches_low ? first->x : crossing(*first, *std::prev(first));
        found.high = found.reaches_high ? last->x : crossing(*last, *std::next(last));
        return found;
    }

    Map map(Eigen::Index first, Eigen::Index second, const Eigen::VectorXd& likeliest, double least, double region) const {
        Map found;
        found.first = static_cast<std::size_t>(first);
        found.second = static_cast<std::size_t>(second);
        const auto side = static_cast<std::size_t>(net_.side);
        std::vector<std::size_t> best(side * side, net_.size());
        found.objective.assign(side * side, std::numeric_limits<double>::infinity());
        for (std::size_t node = 0; node < net_.size(); ++node) {
            const auto at = static_cast<std::size_t>(net_.index(node, first) + net_.side * net_.index(node, second));
            found.objective[at] = std::min(found.objective[at], net_.objective[node]);
            if (best[at] == net_.size() || net_.chi_squared[node] < net_.chi_squared[best[at]]) best[at] = node;
        }
        for (Eigen::Index i = 0; i < net_.side; ++i) {
            const Eigen::VectorXd at = unscaled(ranges_, Eigen::VectorXd::Constant(net_.parameters, net_.coordinate(i)));
            found.x.push_back(at[first]);
            found.y.push_back(at[second]);
        }
        add_region(found, best, likeliest, least, region);
        return found;
    }

    /// \param best  node of the net with the least chi^2 at each place of the map
    void add_region(Map& map, const std::vector<std::size_t>& best, const Eigen::VectorXd& likeliest, double least, double region) const {
        const auto first = static_cast<Eigen::Index>(map.first), second = static_cast<Eigen::Index>(map.second);
        const std::vector<double> x = net_.coordinates_with(likeliest[first]), y = net_.coordinates_with(likeliest[second]);
        for (const double b : y)
            for (const double a : x) {
                const bool beside = a == likeliest[first] || b == likeliest[second];
                Eigen::VectorXd at =
                    beside ? likeliest : net_.place(best[static_cast<std::size_t>(net_.nearest(a) + net_.side * net_.nearest(b))]);
                at[first] = a;
                at[second] = b;
                map.distance.push_back(distance(least_from(at, {first, second}), least, region));
            }
        Eigen::VectorXd at = likeliest;
        for (const double a : x) {
            at[first] = a;
            map.region_x.push_back(unscaled(ranges_, at)[first]);
        }
        for (const double b : y) {
            at[second] = b;
            map.region_y.push_back(unscaled(ranges_, at)[second]);
        }
    }

    std::vector<Direction> directions(const Eigen::VectorXd& at, double limit) const {
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(surface_.information(at));
        std::vector<Direction> found;
        const double largest = solver.eigenvalues()[net_.parameters - 1];
        for (Eigen::Index k = net_.parameters - 1; k >= 0; --k) {
            const double value = std::max(0.0, solver.eigenvalues()[k]);
            found.push_back({solver.eigenvectors().col(k), value, largest > 0.0 ? value / largest : 0.0, std::sqrt(limit / value)});
        }
        return found;
    }

    const Surface& surface_;
    const std::vector<Range>& ranges_;
    const ObjectiveFunction& function_;
    Net net_;
};

/// Neighbours of the estimate are this far off along a direction, in half ranges, at least and at most.
constexpr double k_least_step = 0.1, k_greatest_step = 0.5;

/// Parameters of new places are round to this part of their range.
constexpr double k_rounding = 1e-3;

Eigen::VectorXd rounded_within(const std::vector<Range>& ranges, const Eigen::VectorXd& at) {
    Eigen::VectorXd inside = at.cwiseMax(-1.0).cwiseMin(1.0);
    inside = (inside / (2.0 * k_rounding)).array().round() * 2.0 * k_rounding;
    return unscaled(ranges, inside);
}

}  // namespace

Eigen::VectorXd scaled(const std::vector<Range>& ranges, const Eigen::VectorXd& parameters) {
    Eigen::VectorXd at(parameters.size());
    for (Eigen::Index k = 0; k < at.size(); ++k) {
        const Range& range = ranges[static_cast<std::size_t>(k)];
        at[k] = 2.0 * (parameters[k] - range.low) / (range.high - range.low) - 1.0;
    }
    return at;
}

Eigen::VectorXd unscaled(const std::vector<Range>& ranges, const Eigen::VectorXd& at) {
    Eigen::VectorXd parameters(at.size());
    for (Eigen::Index k = 0; k < at.size(); ++k) {
        const Range& range = ranges[static_cast<std::size_t>(k)];
        parameters[k] = range.low + 0.5 * (at[k] + 1.0) * (range.high - range.low);
    }
    return parameters;
}

std::vector<double> mean_of(const std::vector<std::vector<double>>& repeats) {
    std::vector<double> mean(repeats.front().size(), 0.0);
    for (const std::vector<double>& values : repeats)
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += values[i] / static_cast<double>(repeats.size());
    return mean;
}

std::vector<std::vector<double>> means_of(const Evaluation& evaluation) {
    std::vector<std::vector<double>> means;
    for (const auto& repeats : evaluation.values) means.push_back(mean_of(repeats));
    return means;
}

Surface::Surface(const std::vector<Range>& ranges, const std::vector<Target>& targets, const std::vector<Evaluation>& evaluations)
    : targets_(targets) {
    for (std::size_t t = 0; t < targets.size(); ++t) {
        std::vector<Response> places;
        for (std::size_t i = 0; i < targets[t].values.size(); ++i) {
            std::vector<Repeats> points;
            for (const Evaluation& evaluation : evaluations) {
                points.push_back({scaled(ranges, evaluation.parameters), {}});
                for (const std::vector<double>& values : evaluation.values[t]) points.back().values.push_back(values[i]);
            }
            places.emplace_back(points);
        }
        responses_.push_back(std::move(places));
    }
}

std::vector<std::vector<double>> Surface::model(const Eigen::VectorXd& at) const {
    std::vector<std::vector<double>> values;
    for (const std::vector<Response>& places : responses_) {
        values.emplace_back();
        for (const Response& place : places) values.back().push_back(place.value(at));
    }
    return values;
}

double Surface::chi_squared(const Eigen::VectorXd& at) const {
    double sum = 0.0;
    for (std::size_t t = 0; t < targets_.size(); ++t) {
        const double own = std::pow(targets_[t].tolerance / k_normal_quantile, 2);
        const auto places = static_cast<double>(responses_[t].size());
        for (std::size_t i = 0; i < responses_[t].size(); ++i) {
            const double misfit = responses_[t][i].value(at) - targets_[t].values[i];
            sum += misfit * misfit / (own + responses_[t][i].variance(at)) / places;
        }
    }
    return sum;
}

Eigen::MatrixXd Surface::information(const Eigen::VectorXd& at) const {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(at.size(), at.size());
    for (std::size_t t = 0; t < targets_.size(); ++t) {
        const double own = std::pow(targets_[t].tolerance / k_normal_quantile, 2);
        for (const Response& place : responses_[t]) {
            const Eigen::VectorXd slope = place.gradient(at);
            sum += slope * slope.transpose() / (own + place.variance(at)) / static_cast<double>(responses_[t].size());
        }
    }
    return sum;
}

double Surface::degrees_of_freedom(const Eigen::VectorXd& at) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < targets_.size(); ++t) {
        const double own = std::pow(targets_[t].tolerance / k_normal_quantile, 2);
        for (const Response& place : responses_[t]) {
            if (!place.scatter_is_known()) return 0.0;
            const double variance = place.variance(at);
            if (variance > 0.0) least = std::min(least, place.degrees_of_freedom(at) * std::pow((own + variance) / variance, 2));
        }
    }
    return least;
}

ParameterEstimate estimate(const Surface& surface, const std::vector<Range>& ranges, const ObjectiveFunction& function) {
    return Search(surface, ranges, function).result();
}

bool narrow_enough(const ParameterEstimate& estimate, const std::vector<Range>& ranges) {
    if (estimate.intervals.empty()) return false;
    for (std::size_t k = 0; k < ranges.size(); ++k)
        if (0.5 * (estimate.intervals[k].high - estimate.intervals[k].low) > ranges[k].tolerance) return false;
    return true;
}

std::vector<Eigen::VectorXd> next_places(const ParameterEstimate& estimate, const std::vector<Range>& ranges,
                                         const std::vector<Evaluation>& evaluations) {
    const Eigen::VectorXd best = scaled(ranges, estimate.parameters);
    const Direction& worst = estimate.directions.back();
    const Eigen::VectorXd step = std::clamp(0.5 * worst.half_width, k_least_step, k_greatest_step) * worst.along;
    std::vector<Eigen::VectorXd> places;
    const auto is_known = [&](const Eigen::VectorXd& parameters) {
        const Eigen::VectorXd at = scaled(ranges, parameters);
        const auto is_near = [&](const Eigen::VectorXd& other) { return (scaled(ranges, other) - at).cwiseAbs().maxCoeff() < k_rounding; };
        return std::any_of(places.begin(), places.end(), is_near) ||
               std::any_of(evaluations.begin(), evaluations.end(), [&](const Evaluation& run) { return is_near(run.parameters); });
    };
    for (const Eigen::VectorXd& at : {best, Eigen::VectorXd(best + step), Eigen::VectorXd(best - step)}) {
        const Eigen::VectorXd parameters = rounded_within(ranges, at);
        if (!is_known(parameters)) places.push_back(parameters);
    }
    return places;
}

}  // namespace cutterflow::postproc::calibration
