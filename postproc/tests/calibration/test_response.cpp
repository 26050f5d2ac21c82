#include "postproc/analysis/calibration/response.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

using namespace cutterflow::postproc::calibration;

namespace {

Eigen::VectorXd place(double a, double b) {
    return Eigen::Vector2d(a, b);
}

/// A net of 4 x 4 places with `repeats` values each.
template <class Value>
std::vector<Repeats> net(int repeats, Value value) {
    std::vector<Repeats> points;
    for (const double a : {-1.0, -0.3, 0.4, 1.0})
        for (const double b : {-1.0, -0.4, 0.3, 1.0}) {
            points.push_back({place(a, b), {}});
            for (int n = 0; n < repeats; ++n) points.back().values.push_back(value(a, b));
        }
    return points;
}

double quadratic(double a, double b) {
    return 20.0 + 5.0 * a - 2.0 * b + 1.5 * a * a + 0.7 * a * b - 0.4 * b * b;
}

struct Coverage {
    double share = 0.0, mean_misfit_variance = 0.0;
};

/// Share of 400 fits whose 95 % interval at a place off the net holds the truth.
template <class Truth, class Scatter>
Coverage coverage(Truth truth, Scatter scatter, double a, double b) {
    std::mt19937_64 random(11);
    std::normal_distribution<double> normal;
    Coverage found;
    for (int trial = 0; trial < 400; ++trial) {
        const Response response(net(3, [&](double x, double y) { return truth(x, y) + scatter(x) * normal(random); }));
        const double error = response.value(place(a, b)) - truth(a, b);
        if (std::abs(error) <= 1.96 * std::sqrt(response.variance(place(a, b)))) found.share += 1.0 / 400.0;
        found.mean_misfit_variance += response.misfit_variance() / 400.0;
    }
    return found;
}

}  // namespace

TEST(Response, is_the_quadratic_that_the_runs_lie_on) {
    const Response response(net(1, quadratic));
    EXPECT_NEAR(response.value(place(0.17, -0.62)), quadratic(0.17, -0.62), 1e-12);
    EXPECT_NEAR(response.gradient(place(0.17, -0.62))[0], 5.0 + 3.0 * 0.17 + 0.7 * -0.62, 1e-11);
    EXPECT_NEAR(response.gradient(place(0.17, -0.62))[1], -2.0 + 0.7 * 0.17 + 0.8 * 0.62, 1e-11);
    EXPECT_LT(response.variance(place(0.0, 0.0)), 1e-20);
    EXPECT_EQ(response.spare_points(), 10u);
    EXPECT_EQ(response.degrees_of_freedom(place(0.0, 0.0)), 10.0)
        << "16 points less 6 terms: what little misfit there is, is known from them";
}

TEST(Response, knows_how_well_it_is_known) {
    const Coverage found = coverage(
        quadratic, [](double) { return 0.6; }, 0.2, -0.5);
    EXPECT_GE(found.share, 0.92);
    EXPECT_LE(found.share, 0.99);
}

TEST(Response, pools_the_scatter_of_repeats) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal(0.0, 0.6);
    const Response response(net(40, [&](double a, double b) { return quadratic(a, b) + normal(random); }));
    EXPECT_NEAR(std::sqrt(response.scatter_variance()), 0.6, 0.05);  // 624 degrees of freedom: 2.8 % standard error
    if (response.misfit_variance() == 0.0) EXPECT_EQ(response.degrees_of_freedom(place(0.0, 0.0)), 16.0 * 39.0);
    EXPECT_GE(response.degrees_of_freedom(place(0.0, 0.0)), 10.0);
    EXPECT_LE(response.degrees_of_freedom(place(0.0, 0.0)), 16.0 * 39.0 + 10.0);
}

TEST(Response, weighs_points_by_their_scatter) {
    // Ten times the scatter at one end: at the quiet end an unweighted fit would be three times as uncertain.
    const auto scatter = [](double a) { return a > 0.9 ? 2.0 : 0.2; };
    EXPECT_GE(coverage(quadratic, scatter, -0.7, 0.1).share, 0.92);
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    const Response response(net(20, [&](double a, double b) { return quadratic(a, b) + scatter(a) * normal(random); }));
    EXPECT_LT(std::sqrt(response.variance(place(-0.7, 0.1))), 0.5 * std::sqrt(response.variance(place(0.95, 0.1))));
}

TEST(Response, adds_the_misfit_of_the_quadratic) {
    const auto wave = [](double a, double b) { return quadratic(a, b) + 0.5 * std::sin(4.0 * a); };
    const Coverage found = coverage(
        wave, [](double) { return 0.1; }, 0.1, -0.5);
    EXPECT_GT(found.mean_misfit_variance, 0.01);
    EXPECT_GE(found.share, 0.9);
}

TEST(Response, needs_three_values_of_each_parameter) {
    std::vector<Eigen::VectorXd> places;
    for (const double a : {-1.0, 0.0, 1.0})
        for (const double b : {-1.0, 1.0}) places.push_back(place(a, b));
    EXPECT_FALSE(determine_quadratic(places));
    places.push_back(place(0.5, 0.0));
    EXPECT_TRUE(determine_quadratic(places));
    EXPECT_FALSE(determine_quadratic({}));
}
