#include "postproc/analysis/time_average.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::postproc {
namespace {

TEST(TimeAverage, weighs_values_by_their_step) {
    // Steps of 1 s and 3 s: (2 * 1 + 10 * 3) / 4.
    const auto average = time_average({1.0, 4.0}, {2.0, 10.0}, 0.0, 4.0, 1.0);
    ASSERT_TRUE(average);
    EXPECT_DOUBLE_EQ(average->start, 0.0);  // the first value holds as long as the second, at most from the window's start on
    EXPECT_DOUBLE_EQ(average->mean, 8.0);
    EXPECT_FALSE(average->standard_error);
}

TEST(TimeAverage, cuts_steps_at_the_ends_of_the_window) {
    const auto average = time_average({1.0, 2.0, 3.0}, {0.0, 4.0, 8.0}, 1.5, 2.25, 1.0);
    ASSERT_TRUE(average);
    EXPECT_DOUBLE_EQ(average->mean, (4.0 * 0.5 + 8.0 * 0.25) / 0.75);
}

TEST(TimeAverage, window_without_values_has_no_mean) {
    EXPECT_FALSE(time_average({1.0, 2.0}, {1.0, 1.0}, 5.0, 6.0, 1.0));
    EXPECT_FALSE(time_average({}, {}, 0.0, 1.0, 1.0));
}

TEST(TimeAverage, over_more_periods_than_can_be_counted_has_no_error) {
    const auto average = time_average({1.0, 2.0}, {1.0, 3.0}, 0.0, 2.0, 1e-300);
    ASSERT_TRUE(average);
    EXPECT_FALSE(average->standard_error);
    EXPECT_FALSE(time_average({1e300, 1.5e300}, {1.0, 3.0}, 0.0, 2e300, 1e-300)->standard_error);
}

TEST(TimeAverage, batch_means_give_the_standard_error_of_the_mean) {
    // Ten batches of means 0, 1, 0, 1 ...: standard deviation sqrt(10 / 36), error of the mean that over sqrt(10).
    std::vector<double> times, values;
    for (int i = 0; i < 100; ++i) {
        times.push_back(0.1 * (i + 1));
        values.push_back((i / 10) % 2);
    }
    const auto average = time_average(times, values, 0.0, 10.0, 1.0);
    ASSERT_TRUE(average && average->standard_error);
    EXPECT_NEAR(average->mean, 0.5, 1e-12);
    EXPECT_NEAR(*average->standard_error, std::sqrt(1.0 / 36.0), 1e-9);
    EXPECT_NEAR(*average->half_interval / *average->standard_error, 2.262157, 1e-6) << "Student's t of nine degrees of freedom";
}

TEST(TimeAverage, what_repeats_every_period_is_no_scatter) {
    std::vector<double> times, values;
    for (int i = 1; i <= 600; ++i) {
        times.push_back(0.01 * i);
        values.push_back(3.0 + std::sin(2.0 * k_pi * 0.01 * i));
    }
    const auto average = time_average(times, values, 0.0, 6.0, 1.0);
    ASSERT_TRUE(average && average->standard_error);
    EXPECT_NEAR(average->mean, 3.0, 1e-12);
    EXPECT_NEAR(*average->standard_error, 0.0, 1e-12);
    EXPECT_FALSE(time_average(times, values, 0.0, 6.0, 2.0)->standard_error);  // three periods are too few
}

TEST(TimeAverage, long_windows_are_cut_into_about_ten_batches_of_whole_periods) {
    // 24 periods of 1 s, two to a batch: 12 batches whose means are 0, 1, 0, 1 ...
    std::vector<double> times, values;
    for (int i = 0; i < 240; ++i) {
        times.push_back(0.1 * (i + 1));
        values.push_back((i / 20) % 2);
    }
    const auto average = time_average(times, values, 0.0, 24.0, 1.0);
    ASSERT_TRUE(average && average->standard_error);
    EXPECT_NEAR(*average->standard_error, std::sqrt(12.0 * 0.25 / 11.0 / 12.0), 1e-9);
}

}  // namespace
}  // namespace cutterflow::postproc
