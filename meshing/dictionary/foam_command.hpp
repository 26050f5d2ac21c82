#pragma once
/// \file How OpenFOAM programs (and cutterFoam) are started.
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/base/process/child_process.hpp"

namespace cutterflow::meshing {

/// Command that runs an OpenFOAM program in `case_directory`, its output in `log.<program>` there. More than one rank: under mpirun, with
/// `-parallel` added. The environment gets the variables that Debian's OpenFOAM and Open MPI need; variables already set are kept.
/// \param program  name or path; \pre ranks >= 1
ChildCommand foam_command(const std::filesystem::path& case_directory, const std::string& program,
                          const std::vector<std::string>& arguments = {}, int ranks = 1);

}  // namespace cutterflow::meshing
