#pragma once
/// \file Numerics of a study in a case that is written by hand.
#include <filesystem>

namespace cutterflow::validation {

/// Replaces system/fvSchemes and fvSolution with those that a study with rock writes; p* is 0 in cell 0 where no patch fixes it.
void use_study_numerics(const std::filesystem::path& case_folder);

/// Turbulence model of a study in a domain of periodic patches alone, from the level that enters with `speed` [m/s] and `length` [m].
void use_study_turbulence(const std::filesystem::path& case_folder, double speed, double length);

}  // namespace cutterflow::validation
