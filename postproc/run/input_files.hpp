#pragma once
/// \file The files that a run was made from, by their content.
#include <map>
#include <string>

#include <nlohmann/json.hpp>

namespace cutterflow::postproc {

/// SHA-256 of the files among the inputs of all stages, by the input's name, as "cutter.file" or "overrides/system/fvSchemes".
/// \param manifest  of the run, an object; empty: no files are known
std::map<std::string, std::string> input_files(const nlohmann::json& manifest);

}  // namespace cutterflow::postproc
