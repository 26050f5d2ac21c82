#pragma once
/// \file What the processes that a program started have used so far.
#include <string>
#include <vector>

namespace cutterflow::validation {

/// A process that this one, or one of its children, started and that still runs.
struct Descendant {
    std::string program;        ///< the first 15 characters of its name
    double core_seconds = 0.0;  ///< user and system [s]
    double peak_memory = 0.0;   ///< largest resident set so far [bytes]
};

/// From Linux' /proc.
std::vector<Descendant> descendants();

/// Of all of them [s].
double core_seconds(const std::vector<Descendant>& processes);

}  // namespace cutterflow::validation
