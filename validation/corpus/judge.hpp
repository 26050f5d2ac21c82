#pragma once
#include <filesystem>
#include <string>

#include "validation/corpus/corpus.hpp"

namespace cutterflow::validation {

/// What became of a file.
struct Verdict {
    std::string name;
    bool passed = false;
    bool repaired = false;      ///< exit code 0
    bool refused = false;       ///< exit code 2
    bool crashed = false;       ///< any other exit code
    bool hung = false;          ///< more processor time than the limit
    double volume_error = 0.0;  ///< |V / V_sound - 1| of a repaired file
    double core_s = 0.0;
    std::string note;  ///< what is wrong, or the refusal's first line
};

inline constexpr double k_largest_volume_error = 0.005;
inline constexpr int k_core_limit_s = 60;

/// Writes the file, has it repaired by the program and holds the result against what is known of the file: a repaired surface, read back,
/// is sound and has the volume of the solid within k_largest_volume_error; a refusal contains the expected words and leaves no output; the
/// input is as it was.
/// \param folder  for the files, emptied of those of this name
Verdict judge(const DamagedFile& file, const std::filesystem::path& cutterflow, const std::filesystem::path& folder);

}  // namespace cutterflow::validation
