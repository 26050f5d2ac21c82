/// Rates and spectra of made-up signals whose answers are known.
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "postproc/analysis/measures/rates.hpp"
#include "postproc/analysis/measures/spectrum.hpp"

namespace cutterflow::postproc {
namespace {

constexpr double k_grains_per_s = 40.0, k_grain = 0.0238, k_duration = 20.0;

/// Grains that pass at random times, of masses within 30 % of the mean.
PassedMass random_grains(std::mt19937& random) {
    std::exponential_distribution<double> pause(k_grains_per_s);
    std::uniform_real_distribution<double> mass(0.7 * k_grain, 1.3 * k_grain);
    PassedMass passed;
    passed.end = k_duration;
    for (double time = pause(random); time < k_duration; time += pause(random)) {
        passed.mass.push_back(passed.total() + mass(random));
        passed.time.push_back(time);
    }
    return passed;
}

TEST(Rate, interval_covers_the_true_one_in_95_of_100_series) {
    std::mt19937 random(1);
    constexpr int trials = 400;
    int covered = 0, covered_naively = 0;
    double mean = 0.0;
    for (int n = 0; n < trials; ++n) {
        const PassedMass passed = random_grains(random);
        const Rate rate = rate_in(passed, 1.0, 19.0);
        ASSERT_TRUE(rate.standard_error);
        covered += std::abs(rate.slope - k_grains_per_s * k_grain) < rate.half_interval;
        mean += rate.slope / trials;
        // What least squares would state for 1000 independent deviations: sigma sqrt(12/N) / T.
        double squares = 0.0;
        for (int i = 0; i < 1000; ++i) {
            const double time = 1.0 + 18.0 * (i + 0.5) / 1000.0, off = passed.at(time) - rate.intercept - rate.slope * time;
            squares += off * off / 998.0;
        }
        covered_naively += std::abs(rate.slope - k_grains_per_s * k_grain) < 1.96 * std::sqrt(12.0 * squares / 1000.0) / 18.0;
    }
    RecordProperty("covered", covered);
    RecordProperty("covered_naively", covered_naively);
    EXPECT_NEAR(mean, k_grains_per_s * k_grain, 0.01 * k_grains_per_s * k_grain);
    EXPECT_GE(covered, 0.92 * trials);
    EXPECT_LE(covered, 0.98 * trials);
    EXPECT_LT(covered_naively, 0.6 * trials) << "deviations of a sum would be independent";
}

TEST(Rate, of_pictures_with_noise_is_covered_too) {
    std::mt19937 random(2);
    std::normal_distribution<double> noise(0.0, 0.05);
    constexpr int trials = 200;
    int covered = 0;
    for (int n = 0; n < trials; ++n) {
        PassedMass passed;
        passed.steps = false;
        passed.end = 10.0;
        for (int i = 0; i <= 200; ++i) {
            passed.time.push_back(0.05 * i);
            passed.mass.push_back(0.9 * passed.time.back() + noise(random));
        }
        const Rate rate = rate_in(passed, 1.0, 9.0);
        covered += std::abs(rate.slope - 0.9) < rate.half_interval;
        EXPECT_NEAR(rate.slope, 0.9, 0.02);
    }
    EXPECT_GE(covered, 0.95 * trials);
}

TEST(Rate, has_no_error_where_too_little_passes) {
    PassedMass passed{{1.0, 2.0}, {0.1, 0.2}, true, 0.0, 3.0};
    EXPECT_FALSE(rate_in(passed, 0.0, 3.0).standard_error);
    EXPECT_FALSE(middle_half({{}, {}, true, 0.0, 3.0}));
}

TEST(Rate, middle_half_lies_between_the_quarters) {
    PassedMass passed{{1.0, 2.0, 3.0, 4.0}, {1.0, 2.0, 3.0, 4.0}, true, 0.0, 5.0};
    const auto half = middle_half(passed);
    ASSERT_TRUE(half);
    EXPECT_EQ(half->first, 1.0);
    EXPECT_EQ(half->second, 3.0);
}

TEST(TimeOf, is_a_crossing_or_lies_between_pictures) {
    PassedMass passed{{1.0, 2.0, 4.0}, {0.0, 1.0, 3.0}, true, 0.0, 5.0};
    EXPECT_EQ(time_when(passed, 2.0), 4.0);
    passed.steps = false;
    EXPECT_EQ(time_when(passed, 2.0), 3.0);
    EXPECT_FALSE(time_when(passed, 3.5));
}

TEST(Spectrum, finds_a_sine_in_noise_of_its_own_power) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, std::sqrt(0.5));
    std::uniform_real_distribution<double> step(0.015, 0.025);
    for (const double frequency : {0.83, 1.7, 6.1}) {
        std::vector<double> times, values;
        for (double time = 0.0; time < 60.0; time += step(random)) {
            times.push_back(time);
            values.push_back(5.0 + std::sin(2.0 * k_pi * frequency * time) + noise(random));
        }
        const Spectrum spectrum = spectrum_of(times, values, 7);
        ASSERT_TRUE(spectrum.peak_frequency);
        EXPECT_NEAR(*spectrum.peak_frequency, frequency, 0.01 * frequency);
        EXPECT_NEAR(spectrum.amplitude, 1.0, 0.15) << frequency;
        EXPECT_TRUE(spectrum.stands_out());
        ASSERT_TRUE(spectrum.standard_error);
        EXPECT_LT(*spectrum.standard_error, 0.01 * frequency);
        RecordProperty(fmt::format("sine_{}_hz", frequency), fmt::format("{:.4f}", *spectrum.peak_frequency));
    }
}

TEST(Spectrum, of_noise_has_no_line_that_stands_out) {
    std::mt19937 random(4);
    std::normal_distribution<double> noise;
    int false_alarms = 0;
    for (int n = 0; n < 200; ++n) {
        std::vector<double> times, values;
        for (int i = 0; i < 600; ++i) {
            times.push_back(0.01 * i);
            values.push_back(noise(random));
        }
        false_alarms += spectrum_of(times, values, 7).stands_out();
    }
    RecordProperty("false_alarms_of_200", false_alarms);
    EXPECT_LE(false_alarms, 6) << "at most 1 of 100 is stated: 2 of 200 are expected";
}

/// Power falls from low frequencies, and nothing oscillates.
TEST(Spectrum, of_a_signal_that_fades_has_no_peak) {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.0, 0.01);
    std::vector<double> times, values;
    for (int i = 0; i < 400; ++i) {
        times.push_back(0.01 * i);
        values.push_back(std::exp(-times.back() / 1.5) + noise(random));
    }
    for (const int segments : {1, 2, 7}) {
        const Spectrum spectrum = spectrum_of(times, values, segments);
        EXPECT_FALSE(spectrum.peak_frequency) << segments << " segments: " << spectrum.peak_frequency.value_or(0.0);
        EXPECT_FALSE(spectrum.stands_out()) << segments;
        EXPECT_FALSE(spectrum.standard_error) << segments;
    }
}

/// A tone that rises and grows: six of seven segments have their highest line below the lobe of the mean one's peak. They count with its
/// edge, 9 lines of 1/40.96 Hz below the seventh.
TEST(Spectrum, peaks_of_segments_lie_within_the_lobe) {
    std::vector<double> times, values;
    for (int i = 0; i < 4000; ++i) {
        const double time = 0.01 * i;
        times.push_back(time);
        values.push_back((20.0 + time) * std::sin(2.0 * k_pi * (2.0 + 0.02 * time) * time));
    }
    const Spectrum spectrum = spectrum_of(times, values, 7);
    ASSERT_TRUE(spectrum.peak_frequency && spectrum.standard_error);
    const double deviation = 9.0 / 40.96 / std::sqrt(7.0);
    EXPECT_NEAR(*spectrum.standard_error, deviation / 2.0, 0.05 * deviation);
}

TEST(Spectrum, needs_enough_values) {
    const std::vector<double> few{0.0, 1.0, 2.0, 3.0};
    EXPECT_THROW(spectrum_of(few, few, 7), UserError);
}

}  // namespace
}  // namespace cutterflow::postproc
