#pragma once
/// \file Numbers and words as the pages show them: markup.
#include <optional>
#include <string>

#include "postproc/analysis/time_average.hpp"

namespace cutterflow::postproc::text {

inline constexpr const char* k_dash = "–";

/// Share as "12.3 %"; "undefined" when there is none.
std::string percent(double share);
std::string percent(const std::optional<double>& share);

/// Number with `digits` significant digits: plain where people read it so, else with a power of ten.
std::string digits_of(double value, int digits);

/// The same with its unit; a dash when there is none.
std::string number(const std::optional<double>& value, const char* unit = "", int digits = 3);

/// Mean and standard error to the same decimal.
std::string number(const std::optional<TimeAverage>& average, const char* unit);

std::optional<double> mean_of(const std::optional<TimeAverage>& average);

/// Seconds as s, min or h.
std::string duration(double seconds);

/// "0-30mm" as "0–30 mm".
std::string bin_text(const std::string& name);

}  // namespace cutterflow::postproc::text
