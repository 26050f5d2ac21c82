#pragma once
/// \file A clump's file: TOML with one table [[sphere]] for each (docs/user/clumps.md).
#include <filesystem>

#include "geometry/base/parameters/parameter.hpp"
#include "geometry/clump/clump.hpp"

namespace cutterflow::geometry {

const ParameterTable& clump_file_table();

/// \throws UserError  with every mistake of the file and of the clump
Clump read_clump(const std::filesystem::path& file);

/// Writes 17 digits: reading gives the same balls. `remark` (lines) goes on top as comments. \throws UserError  when it cannot be written
void write_clump(const Clump& clump, const std::string& remark, const std::filesystem::path& file);

}  // namespace cutterflow::geometry
