#pragma once
/// \file A run is compared with others, not with itself.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace cutterflow::postproc {

/// Refuses a run that is named twice, by whatever path it comes, and a copy of one. \param is_copy  whether the runs of two numbers are
/// copies; none: it is not known \param differ_by  what tells repeats apart, for the message \throws UserError  that names each of them
void require_distinct(const std::vector<std::filesystem::path>& runs, const std::function<bool(std::size_t, std::size_t)>& is_copy,
                      const std::string& differ_by);

}  // namespace cutterflow::postproc
