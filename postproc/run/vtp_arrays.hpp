#pragma once
/// \file Data arrays of the solver's .vtp files.
#include <optional>
#include <string>
#include <vector>

namespace cutterflow::postproc {

/// Numbers of an ascii data array. \param text  of the file \return nothing when it has no array of that name
std::optional<std::vector<double>> vtp_array(const std::string& text, const std::string& name);

}  // namespace cutterflow::postproc
