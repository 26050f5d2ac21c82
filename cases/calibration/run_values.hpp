#pragma once
/// \file What a finished run gives for a target, and what it cost.
#include <filesystem>
#include <string>
#include <vector>

#include "cases/calibration/calibration_file.hpp"

namespace cutterflow::cases {

/// Values of a run for one target: one number, or heights at its places.
/// \return empty when the run could not measure it (its value is null), such as the angle of a heap with two bumps
/// \throws UserError  when the run has no such measure
std::vector<double> run_values(const std::filesystem::path& run, const Measured& measured);

/// Why a run has no value for a target, in the words of its measure; empty when it does not say.
std::string missing_reason(const std::filesystem::path& run, const Measured& measured);

}  // namespace cutterflow::cases
