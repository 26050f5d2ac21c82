#pragma once
/// \file Heights over a line, as of a heap: measured, or given by a file.
#include <filesystem>
#include <vector>

namespace cutterflow {

/// Heights over a line, from a level on.
struct Profile {
    std::vector<double> place, height;  ///< [m]
};

/// A given profile: a CSV file with the columns x_m,height_m and two or more places, which increase.
/// \throws UserError  with every mistake and its line
Profile read_profile(const std::filesystem::path& file);

}  // namespace cutterflow
