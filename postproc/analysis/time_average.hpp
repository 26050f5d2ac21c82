#pragma once
/// \file Averages over a window of time of what a run writes once per (unequal) time step.
#include <optional>
#include <vector>

namespace cutterflow::postproc {

struct TimeAverage {
    double mean = 0.0;
    std::optional<double> standard_error;  ///< by batch means; none when the window holds too few batches or steps
    std::optional<double> half_interval;   ///< half the 95 % interval, by Student's t of the batches; with standard_error
    double start = 0.0, end = 0.0;         ///< the part of the window that the values cover [s]
};

inline constexpr int k_batches = 10;         ///< aimed at; at least this many of one period each, fewer when the window is short
inline constexpr int k_fewest_batches = 4;   ///< fewer do not determine an error
inline constexpr int k_steps_per_batch = 5;  ///< fewer do not determine an error

/// Mean over [start, end] of a value that holds from the time before it to its own time (a value of a time step is given at the step's
/// end). The first value holds as long as the second.
///
/// The standard error of the mean comes from batch means: s / sqrt(n), s the standard deviation of n means over equal stretches. A stretch
/// is a whole number of `period`s, so that what repeats in each period (the passing of a blade) is not taken for scatter; the stretches end
/// with the window. Half the 95 % interval is t(0.975, n - 1) standard errors.
/// \param times   increasing [s]
/// \param values  as long as times
/// \param period  [s] > 0
/// \return nothing when the window holds no value
std::optional<TimeAverage> time_average(const std::vector<double>& times, const std::vector<double>& values, double start, double end,
                                        double period);

}  // namespace cutterflow::postproc
