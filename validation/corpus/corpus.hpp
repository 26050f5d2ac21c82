#pragma once
/// \file The damaged files, each with the solid it came from and what `cutterflow repair` has to make of it.
#include <functional>
#include <string>
#include <vector>

namespace cutterflow::validation {

struct DamagedFile {
    std::string name;                      ///< file name; its extension is the format
    std::function<std::string()> content;  ///< bytes
    double sound_volume = 0.0;             ///< [m3] of the solid before it was damaged
    std::string refusal;                   ///< words of the refusal; empty: the file must be repaired
    std::vector<std::string> options;      ///< of the command
};

/// Every file, in a fixed order.
std::vector<DamagedFile> damaged_files();

}  // namespace cutterflow::validation
