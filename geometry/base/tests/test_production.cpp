// Production from series whose answer is known.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "geometry/base/statistics/production.hpp"

namespace cutterflow {
namespace {

std::vector<double> noise(std::size_t count, std::uint64_t seed) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> draw(0.0, 1.0);
    std::vector<double> values(count);
    for (double& value : values) value = draw(generator);
    return values;
}

/// x_i = phi x_{i-1} + e_i.
std::vector<double> autoregressive(std::size_t count, double phi, std::uint64_t seed) {
    std::vector<double> values = noise(count, seed);
    for (std::size_t i = 1; i < count; ++i) values[i] += phi * values[i - 1];
    return values;
}

TEST(Mser5, drops_a_start_up_and_nothing_of_what_is_steady) {
    std::vector<double> values = noise(1000, 1);
    EXPECT_LE(mser5_truncation(values), 100u);
    for (std::size_t i = 0; i < 200; ++i) values[i] += 8.0 * (1.0 - static_cast<double>(i) / 200.0);
    const std::size_t dropped = mser5_truncation(values);
    EXPECT_GE(dropped, 150u);
    EXPECT_LE(dropped, 260u);
    EXPECT_EQ(dropped % 5, 0u);
    EXPECT_EQ(mser5_truncation(std::vector<double>(100, 3.0)), 0u);
}

TEST(BatchMeans, of_independent_values_keep_their_shortest_batch) {
    const auto means = batch_means(noise(1000, 2), 10);
    ASSERT_TRUE(means);
    EXPECT_EQ(means->values_per_batch, 10u);
    EXPECT_EQ(means->batches, 100u);
    // 1.96 to 1.98 standard errors of 1/sqrt(1000).
    EXPECT_NEAR(means->half_interval, 1.98 / std::sqrt(1000.0), 0.15 * 1.98 / std::sqrt(1000.0));
    EXPECT_LE(std::abs(means->mean), 3.0 / std::sqrt(1000.0));
}

TEST(BatchMeans, of_correlated_values_grow_until_they_are_independent) {
    constexpr double phi = 0.95;
    const auto means = batch_means(autoregressive(20000, phi, 3), 5);
    ASSERT_TRUE(means);
    EXPECT_GE(means->values_per_batch, 40u);
    EXPECT_LT(means->lag1_correlation, 0.3);
    // The mean of x scatters by 1/(1 - phi)/sqrt(n).
    const double exact = 1.96 / (1.0 - phi) / std::sqrt(20000.0);
    EXPECT_NEAR(means->half_interval, exact, 0.35 * exact);
}

TEST(BatchMeans, cover_the_mean_as_often_as_they_say) {
    int covered = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        const auto means = batch_means(autoregressive(2000, 0.6, 100 + seed), 20);
        ASSERT_TRUE(means) << seed;
        if (std::abs(means->mean) <= means->half_interval) ++covered;
    }
    // 95 % of 400 is 380, standard deviation 4.4; batches that are not quite independent cost some.
    EXPECT_GE(covered, 360);
    EXPECT_LE(covered, 396);
}

TEST(BatchMeans, are_refused_below_eight_batches) {
    EXPECT_FALSE(batch_means(noise(79, 4), 10));
    EXPECT_TRUE(batch_means(noise(80, 4), 10));
    std::vector<double> drift(200);
    for (std::size_t i = 0; i < drift.size(); ++i) drift[i] = static_cast<double>(i);
    EXPECT_FALSE(batch_means(drift, 10)) << "a drift correlates however long the batch";
}

/// Rock of 20 g is fed at 10 kg/s from 1 s on, up to `feed_end` [s]. Each rock in the head leaves it with the chance dt/residence in a
/// step, 6 of 10 to the mouth; of what is fed, the share `stuck` stays for good. Hold-up is 10 residence on average.
ProductionSeries reservoir(double residence, double end, double stuck = 0.0, double feed_end = 1e9) {
    constexpr double mass = 0.02, step = 0.01;
    std::mt19937_64 generator(11);
    const auto leaving = [&](double mean) { return mass * static_cast<double>(std::poisson_distribution<int>(mean / mass)(generator)); };
    ProductionSeries series;
    double fed = 0.0, delivered = 0.0, spilled = 0.0;
    for (double time = 0.0; time <= end + 1e-9; time += step) {
        if (time > 1.0 && time <= feed_end) fed += 10.0 * step;
        const double out = std::max(0.0, (1.0 - stuck) * fed - delivered - spilled) * step / residence;
        delivered += leaving(0.6 * out);
        spilled += leaving(0.4 * out);
        series.time.push_back(time);
        series.fed.push_back(fed);
        series.held.push_back(fed - delivered - spilled);
        series.delivered.push_back(delivered);
        series.spilled.push_back(spilled);
    }
    return series;
}

TEST(Production, of_a_reservoir_is_its_share_once_it_is_full) {
    const auto production = production_of(reservoir(0.5, 21.0), 1.0);
    ASSERT_TRUE(production);
    ASSERT_TRUE(production->start);
    EXPECT_GE(*production->start, 1.0 + 3.0);
    EXPECT_LE(*production->start, 6.0);
    EXPECT_TRUE(production->is_steady);
    EXPECT_NEAR(std::remainder(production->to - production->from, 1.0), 0.0, 1e-9) << "whole revolutions";
    // 5 000 rocks are delivered: 0.6 to 0.009, one standard deviation.
    const double share = production->delivered / production->fed;
    EXPECT_NEAR(share, 0.6, 0.027);
    EXPECT_NEAR(production->held, 5.0, 0.2);
    ASSERT_TRUE(production->share);
    EXPECT_NEAR(production->share->mean, share, 0.01);
    EXPECT_LE(std::abs(share - 0.6), 2.0 * production->share->half_interval);
    EXPECT_LE(production->share->half_interval, 0.04);
    EXPECT_NEAR(production->spillage_min, 0.4, 0.03);
    EXPECT_NEAR(production->undelivered, 1.0 - share, 1e-12);
}

TEST(Production, of_a_head_that_empties_is_that_of_its_feed) {
    const auto whole = production_of(reservoir(0.5, 21.0), 1.0), emptied = production_of(reservoir(0.5, 30.0, 0.0, 21.0), 1.0);
    ASSERT_TRUE(whole && emptied);
    EXPECT_NEAR(emptied->to, 21.0, 0.011);
    EXPECT_NEAR(emptied->fed / (emptied->to - emptied->from), 10.0, 0.01);
    EXPECT_NEAR(emptied->delivered / emptied->fed, whole->delivered / whole->fed, 1e-3);
    EXPECT_TRUE(emptied->is_steady);
    ASSERT_TRUE(emptied->share);
}

TEST(Production, without_a_steady_hold_up_has_bounds) {
    // A fifth of what comes in stays in the head for good.
    const auto production = production_of(reservoir(0.5, 21.0, 0.2), 1.0);
    ASSERT_TRUE(production);
    EXPECT_FALSE(production->is_steady);
    EXPECT_NEAR(production->spillage_min, 0.4 * 0.8, 0.03);
    EXPECT_NEAR(production->spillage_max, 1.0 - 0.6 * 0.8, 0.03);
    EXPECT_NEAR(production->held_change / production->fed, 0.2, 0.02);
}

TEST(Production, has_bounds_in_order_where_hold_up_falls) {
    ProductionSeries series;  // 1 kg/s comes in; 10 kg that are there at the start leave it too, 0.5 kg/s to either side
    for (int k = 0; k <= 2000; ++k) {
        const double t = 0.01 * k;
        series.time.push_back(t);
        series.fed.push_back(10.0 + t);
        series.delivered.push_back(0.75 * t);
        series.spilled.push_back(0.75 * t);
        series.held.push_back(10.0 - 0.5 * t);
    }
    const auto production = production_of(series, 1.0);
    ASSERT_TRUE(production);
    EXPECT_NEAR(production->undelivered, 0.25, 1e-9);
    EXPECT_NEAR(production->spillage_min, 0.25, 1e-9);
    EXPECT_NEAR(production->spillage_max, 0.75, 1e-9);
}

TEST(Production, knows_how_long_more_is_owed_than_a_limit) {
    const std::vector<double> time{0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}, owed{0.0, 2.0, 2.0, 0.5, 2.0, 3.0, 2.0};
    EXPECT_EQ(longest_time_above(time, owed, 1.0), 2.0);
    EXPECT_EQ(longest_time_above(time, owed, 5.0), 0.0);
}

TEST(Production, needs_rock_and_a_whole_revolution) {
    EXPECT_FALSE(production_of(reservoir(0.5, 0.9), 1.0)) << "nothing was fed";
    EXPECT_FALSE(production_of(reservoir(0.5, 4.5), 3.0)) << "start-up takes all of it";
}

TEST(Production, starts_later_where_hold_up_grows_slowly) {
    const auto quick = production_of(reservoir(0.5, 61.0), 1.0), slow = production_of(reservoir(4.0, 61.0), 1.0);
    ASSERT_TRUE(quick && slow && quick->start && slow->start);
    EXPECT_GT(*slow->start, *quick->start + 2.0);
    EXPECT_NEAR(slow->delivered / slow->fed, 0.6, 0.03);
}

}  // namespace
}  // namespace cutterflow
