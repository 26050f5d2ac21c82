#pragma once
/// \file Production of a head that is fed all the time: when it is steady, how much it delivers, and how sure that is.
#include <optional>
#include <vector>

namespace cutterflow {

/// What a run did up to each time, by mass [kg]. Held-up rock may fall, spilled rock too: what is within reach of the head may come back.
struct ProductionSeries {
    std::vector<double> time;  ///< [s], increasing
    std::vector<double> fed, delivered, spilled;
    std::vector<double> held;  ///< neither delivered nor spilled: owed or in the head
};

/// Share of a series' beginning that MSER-5 drops: of means over 5 values each, the d first, where
///   sum_{i>=d} (x_i - mean_d)^2 / (n - d)^2
/// is least over the first half. \return number of values to drop [WhiteCobbSpratt2000]
std::size_t mser5_truncation(const std::vector<double>& values);

/// A mean by batches of equal length.
struct BatchMeans {
    double mean = 0.0;
    double half_interval = 0.0;  ///< of 95 %, by Student's t
    std::size_t batches = 0;
    std::size_t values_per_batch = 0;
    double lag1_correlation = 0.0;  ///< of the batches
};

/// Doubles the batch until successive means correlate less than 0.3. \param shortest  values in the shortest batch
/// \return nothing when fewer than 8 batches are left before they do
std::optional<BatchMeans> batch_means(const std::vector<double>& values, std::size_t shortest);

/// What a growing series gained over [from, to], linear between its times.
double gain_over(const std::vector<double>& times, const std::vector<double>& values, double from, double to);

/// Mean of a series over [from, to], linear between its times.
double mean_over(const std::vector<double>& times, const std::vector<double>& values, double from, double to);

/// Longest stretch of time [s] over which a series stays above a limit.
double longest_time_above(const std::vector<double>& time, const std::vector<double>& values, double limit);

/// What the series says of steady production.
struct Production {
    std::optional<double> start;                       ///< of the steady part [s]; none: hold-up never settled
    double from = 0.0, to = 0.0;                       ///< window of whole revolutions [s]
    double fed = 0.0, delivered = 0.0, spilled = 0.0;  ///< in the window [kg]
    double held_change = 0.0;                          ///< of hold-up over the window [kg]
    double held = 0.0;                                 ///< mean over the window [kg]
    std::optional<BatchMeans> share;                   ///< delivered over fed, P
    bool is_steady = false;                            ///< hold-up changed by less than 5 % of what was fed
    double undelivered = 0.0;                          ///< 1 - delivered/fed: the spillage when is_steady
    double spillage_min = 0.0, spillage_max = 0.0;     ///< spilled/fed and undelivered, the less one first; not strict
};

/// Start-up ends once the means of hold-up over two successive windows of max(1 revolution, 1.5 s) differ by less than 10 %, but not before
/// max(2 revolutions, 3 s) after the first rock, nor before MSER-5 of the delivered rate says so. The window is all whole revolutions from
/// there to the end, or to the end of the feed where that is earlier: a head that empties produces nothing steady. Batches are max(1
/// revolution, 1 s) long. \param revolution  [s] \return nothing when nothing was fed or no whole revolution is left
std::optional<Production> production_of(const ProductionSeries& series, double revolution);

/// Time [s] that a head must be fed before the share that it delivers has an interval: the shortest start-up and the fewest batches of
/// production_of. \param revolution  [s]
double shortest_fed_time(double revolution);

}  // namespace cutterflow
