#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "postproc/draw/head/isoline.hpp"
#include "postproc/pages/calibration_page.hpp"

using namespace cutterflow;
using namespace cutterflow::postproc;
using namespace cutterflow::postproc::calibration;
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

namespace {

/// One target that grows with a and not with b, one held out.
Outcome outcome() {
    Calibration calibration;
    calibration.name = "glass & <sand>";
    calibration.method = "surface";
    calibration.objective = find_objective("squared_misfit");
    calibration.ranges = {{"a", 0.0, 2.0, 0.1}, {"b", 1.0, 5.0, 0.4}};
    calibration.targets.fitted = {{"angle", {21.0}, 0.5, 1.0}};
    calibration.targets.held_out = {{"rate", {7.0}, 0.2, 1.0}};
    for (const double a : {0.0, 1.0, 2.0})
        for (const double b : {1.0, 3.0, 5.0})
            calibration.evaluations.push_back({Eigen::Vector2d(a, b), {{{18.0 + 2.0 * a}, {18.4 + 2.0 * a}}}});
    calibration.cost = {18, 1, 0.25, 40.0, 2.0};
    calibration.ended = "the grid is done";
    Outcome found = outcome_of(calibration, true);
    judge(found, {found.parameters, {{{20.8}, {21.0}, {21.2}}, {{7.6}, {7.8}, {7.7}}}});
    return found;
}

}  // namespace

TEST(Isoline, of_a_bowl_is_a_circle) {
    std::vector<double> x, value;
    for (int i = 0; i <= 40; ++i) x.push_back(-1.0 + 0.05 * i);
    for (const double b : x)
        for (const double a : x) value.push_back(a * a + b * b);
    const Isoline line = isoline(x, x, value, 0.49);
    ASSERT_GT(line.x.size(), 100u);
    double length = 0.0;
    for (std::size_t i = 0; i + 2 < line.x.size(); i += 3) {
        EXPECT_NEAR(std::hypot(line.x[i], line.y[i]), 0.7, 1e-3);
        EXPECT_TRUE(std::isnan(line.x[i + 2]));
        length += std::hypot(line.x[i + 1] - line.x[i], line.y[i + 1] - line.y[i]);
    }
    EXPECT_NEAR(length, 2.0 * 3.14159265 * 0.7, 0.01);
    EXPECT_TRUE(isoline(x, x, value, 3.0).x.empty());
}

TEST(CalibrationPage, shows_objective_runs_and_targets) {
    const Outcome found = outcome();
    const std::vector<Figure> figures = calibration_figures(found);
    ASSERT_EQ(figures.size(), 1u + 2u + 2u);  // a map, the objective along both, the fitted target along both
    const Plot& map = figures[0].plot;
    ASSERT_TRUE(map.field);
    ASSERT_EQ(map.field->x.size(), map.field->value.size()) << "a place for each value";
    const auto least = std::min_element(map.field->value.begin(), map.field->value.end()) - map.field->value.begin();
    EXPECT_NEAR(map.field->x[static_cast<std::size_t>(least)], 1.4, 0.05) << "18.2 + 2 a = 21";
    const auto series = [&](const Plot& plot, const std::string& name) {
        for (const Series& one : plot.series)
            if (one.name == name) return one;
        ADD_FAILURE() << name;
        return Series();
    };
    EXPECT_EQ(series(map, "runs").x.size(), 9u);
    EXPECT_NEAR(series(map, "chosen").x[0], 1.4, 1e-3);
    for (const double a : series(map, "edge of the 95 % region").x)
        EXPECT_TRUE(std::isnan(a) || std::abs(a - 1.4) > 0.1) << "two lines, one on either side";
    const Plot& target = figures[3].plot;
    EXPECT_EQ(target.areas.at(0).low[0], 20.5);
    EXPECT_EQ(target.areas.at(0).high[0], 21.5);
    const Series runs = series(target, "runs, with the scatter of repeats");
    EXPECT_NEAR(runs.y[0], 18.2, 1e-12);
    EXPECT_NEAR(runs.y_high[0] - runs.y[0], 0.4 / std::sqrt(2.0), 1e-12);
    const Series answer = series(target, "runs at the chosen parameters");
    EXPECT_NEAR(answer.x[0], 1.4, 1e-3);
    EXPECT_NEAR(answer.y[0], 21.0, 1e-12);
    EXPECT_NEAR(answer.y_high[0] - answer.y[0], 0.2, 1e-12);
}

TEST(CalibrationPage, has_the_edge_of_a_region_that_is_smaller_than_the_net) {
    // a = 1.415, b = 2.52, both between values of the net; the region's half-widths are 0.3 % of the ranges.
    Calibration calibration;
    calibration.objective = find_objective("squared_misfit");
    calibration.ranges = {{"a", 0.0, 2.0, 0.1}, {"b", 1.0, 5.0, 0.4}};
    calibration.targets.fitted = {{"angle", {2.0 * 1.415}, 0.01, 1.0}, {"rate", {2.52 - 0.5 * 1.415}, 0.01, 1.0}};
    for (const double a : {0.0, 1.0, 2.0})
        for (const double b : {1.0, 3.0, 5.0}) calibration.evaluations.push_back({Eigen::Vector2d(a, b), {{{2.0 * a}}, {{b - 0.5 * a}}}});
    const Outcome found = outcome_of(calibration, true);
    const std::vector<Figure> figures = calibration_figures(found);
    const std::vector<Series>& series = figures[0].plot.series;
    const auto edge = std::find_if(series.begin(), series.end(), [](const Series& one) { return one.name == "edge of the 95 % region"; });
    ASSERT_NE(edge, series.end());
    EXPECT_GE(edge->x.size(), 3u * 6u);
    for (std::size_t i = 0; i < edge->x.size(); ++i) {
        if (std::isnan(edge->x[i])) continue;
        const double angle = 2.0 * (edge->x[i] - 1.415), rate = edge->y[i] - 2.52 - 0.5 * (edge->x[i] - 1.415);
        const double chi_squared = (angle * angle + rate * rate) / std::pow(0.01 / 1.959964, 2);
        EXPECT_NEAR(chi_squared / 5.9915, 1.0, 0.05) << edge->x[i] << " " << edge->y[i];
    }
}

TEST(CalibrationPage, has_intervals_what_is_not_determined_held_out_errors_and_cost) {
    std::string folder = (fs::temp_directory_path() / "cutterflow_calibration_page_XXXXXX").string();
    ASSERT_NE(::mkdtemp(folder.data()), nullptr);
    const fs::path page = write_calibration(outcome(), folder);
    const std::string text = read_file(page);
    EXPECT_THAT(text, HasSubstr("glass &amp; &lt;sand&gt;"));
    EXPECT_THAT(text, HasSubstr("not determined by the targets"));
    EXPECT_THAT(text, HasSubstr("They were run at the chosen parameters alone"));
    EXPECT_THAT(text, HasSubstr("0.25 of 2"));
    const auto document = nlohmann::json::parse(read_file(fs::path(folder) / "calibration.json"));
    EXPECT_EQ(document.at("schema"), k_calibration_schema);
    EXPECT_THAT(document.at("undetermined"), ::testing::ElementsAre("b"));
    EXPECT_NEAR(document.at("parameters")[0].at("value").get<double>(), 1.4, 1e-3);
    EXPECT_NEAR(document.at("agreements")[0].at("fit")[0].get<double>(), 21.0, 1e-3);
    EXPECT_NEAR(document.at("agreements")[1].at("model")[0].get<double>(), 7.7, 1e-12);
    EXPECT_NEAR(document.at("agreements")[1].at("standard_error").get<double>(), 0.1 / std::sqrt(3.0), 1e-12);
    Outcome fitted_alone = outcome();
    fitted_alone.agreements.erase(fitted_alone.agreements.begin() + 1);
    EXPECT_THAT(read_file(write_calibration(fitted_alone, folder)), HasSubstr("No target was held out"));
    Calibration once = outcome().calibration;
    once.evaluations.resize(6);  // as many as terms
    once.evaluations[3].parameters = Eigen::Vector2d(2.0, 2.0);
    for (Evaluation& evaluation : once.evaluations) evaluation.values[0].resize(1);
    EXPECT_THAT(read_file(write_calibration(outcome_of(once, true), folder)),
                AllOf(HasSubstr("no interval: the scatter is unknown"), HasSubstr("it goes through all of them")));
    EXPECT_THAT(text, HasSubstr("95 %: "));
    EXPECT_THAT(read_file(write_calibration(outcome_of(outcome().calibration, false), folder)),
                HasSubstr("95 % by the quadratic fit, least at 1.4: "));
    Outcome lie = outcome();
    lie.objectives[4] += 0.5;
    EXPECT_THROW(write_calibration(lie, folder), CheckFailure);
    fs::remove_all(folder);
}
