#pragma once
/// \file Whether runs at several speeds of rotor and swing tell which one delivers most.
#include <optional>
#include <string>
#include <vector>

#include "postproc/analysis/comparison.hpp"

namespace cutterflow::postproc {

/// Settings that differ in nothing but the rotor's speed, by increasing speed.
struct SpeedSeries {
    std::vector<std::size_t> settings;
    std::string what;                    ///< where there are several series: what this one has in common, as "swing 6 m/min"
    std::optional<double> same_speed{};  ///< at which more than one setting turns [rpm]: they differ in what does not tell series apart
};

/// Series of two speeds and more.
std::vector<SpeedSeries> speed_series(const Comparison& comparison);

/// The setting whose production (delivered / fed) is highest, when all are steady, it lies between two others of the series and its 95 %
/// interval is apart from both neighbours'; none otherwise.
std::optional<std::size_t> best_speed(const Comparison& comparison, const SpeedSeries& series);

/// A sentence for every series of three speeds and more: the best speed, or that no optimum was found within the error, and why. Empty for
/// runs that are not fed all the time.
std::vector<std::string> best_speed_text(const Comparison& comparison);

/// The setting that delivers most soil in situ per hour, when all of them are steady and have an interval and its own is apart from those
/// of all others; none otherwise.
std::optional<std::size_t> best_point(const Comparison& comparison, const std::vector<std::size_t>& settings);

/// A sentence on settings at several speeds of rotor and swing: the best of them and whether it lies at the edge of what was run, or that
/// none is best within the error, and why.
std::string best_point_text(const Comparison& comparison, const std::vector<std::size_t>& settings);

}  // namespace cutterflow::postproc
