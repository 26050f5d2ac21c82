#pragma once
/// \file Versions of Cutterflow and of what this build was made with.
#include <string>
#include <utility>
#include <vector>

namespace cutterflow {

/// Name and version, Cutterflow first. OpenFOAM, LIGGGHTS and Open MPI are "none" in a build without the solver.
std::vector<std::pair<std::string, std::string>> build_versions();

/// One line per program: "OpenFOAM    1912".
std::string build_versions_text();

}  // namespace cutterflow
