#pragma once
/// \file What the log of cutterFoam tells of continuity.
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "validation/harness/largest.hpp"

namespace cutterflow::validation {

struct Continuity {
    double cumulative = 0.0;     ///< sum over time of the room's surplus, over its volume [-]
    double largest_local = 0.0;  ///< of all steps: sum over cells of |surplus| that the last corrector leaves, over the room's volume [-]
};

/// \throws std::runtime_error  when the log tells nothing of continuity
inline Continuity read_continuity(const std::filesystem::path& log) {
    std::ifstream stream(log);
    const std::string step = "Time = ", local = "sum local = ", cumulative = "cumulative = ";
    Continuity continuity;
    int lines = 0;
    double of_step = 0.0;  // what its last corrector so far left; the next one mends it
    for (std::string line; std::getline(stream, line);) {
        if (line.rfind(step, 0) == 0) continuity.largest_local = larger(continuity.largest_local, of_step);
        const std::size_t at = line.find(local), end = line.find(cumulative);
        if (at == std::string::npos || end == std::string::npos) continue;
        of_step = std::stod(line.substr(at + local.size()));
        continuity.cumulative = std::stod(line.substr(end + cumulative.size()));
        ++lines;
    }
    continuity.largest_local = larger(continuity.largest_local, of_step);
    if (lines == 0) throw std::runtime_error(log.string() + " tells nothing of continuity");
    return continuity;
}

}  // namespace cutterflow::validation
