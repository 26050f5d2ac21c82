#pragma once
/// \file Values of a study as inputs of a stage, by names that a message can show.
#include <functional>
#include <map>
#include <string>

#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::cases {

/// The given values as TOML writes them; of a file the SHA-256 of its content. Keys of arrays of tables have the table's name, its pair or
/// its number: `solid.tube.velocity_m_s`. \pre files are named by absolute paths \param counts  whether a key is an input
std::map<std::string, std::string> table_inputs(const ParameterTable& table, const ParameterValues& values,
                                                const std::function<bool(const Parameter&)>& counts);

}  // namespace cutterflow::cases
