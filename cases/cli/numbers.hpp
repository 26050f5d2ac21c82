#pragma once
/// \file Bounds of numbers on the command line. CLI11's own name the largest number there is when one is broken.
#include <cmath>
#include <cstdlib>

#include <CLI/CLI.hpp>

namespace cutterflow::cli {

inline CLI::Validator number_that(bool (*holds)(double), const char* rule) {
    return CLI::Validator(
        [holds, rule](std::string& text) {
            char* end = nullptr;
            const double value = std::strtod(text.c_str(), &end);
            return end != text.c_str() && *end == '\0' && std::isfinite(value) && holds(value) ? std::string() : text + " is not " + rule;
        },
        "NUMBER");
}

/// Of every option: "" is a name that a script left out.
inline const CLI::Validator k_not_empty([](std::string& text) { return text.empty() ? std::string("\"\" is empty") : std::string(); }, "");

inline const CLI::Validator k_positive = number_that([](double value) { return value > 0.0; }, "a number above 0");
inline const CLI::Validator k_not_negative = number_that([](double value) { return value >= 0.0; }, "a number from 0 on");

/// Coordinates of an STL are single precision, and solids are machines.
inline const CLI::Validator k_length = number_that([](double value) { return value <= 1e6; }, "a length of at most 1e6 m");

inline const CLI::Validator k_angle_deg = number_that([](double value) { return std::abs(value) <= 360.0; }, "a number from -360 to 360");

}  // namespace cutterflow::cli
