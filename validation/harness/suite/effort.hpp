#pragma once
/// \file How much of a verification case is run.
#include <string>

namespace cutterflow::validation {

/// Each contains the one before.
enum class Effort { fast, standard, longest };

std::string effort_text(Effort effort);  ///< "fast", "standard", "long"

}  // namespace cutterflow::validation
