#include "geometry/base/versions.hpp"

#include <fmt/format.h>

namespace cutterflow {

std::vector<std::pair<std::string, std::string>> build_versions() {
    return {
        {"cutterflow", CUTTERFLOW_VERSION}, {"OpenFOAM", CUTTERFLOW_OPENFOAM_VERSION}, {"LIGGGHTS", CUTTERFLOW_LIGGGHTS_VERSION},
        {"CGAL", CUTTERFLOW_CGAL_VERSION},  {"assimp", CUTTERFLOW_ASSIMP_VERSION},     {"Open MPI", CUTTERFLOW_MPI_VERSION},
        {"compiler", CUTTERFLOW_COMPILER},
    };
}

std::string build_versions_text() {
    std::string text;
    for (const auto& [name, version] : build_versions()) text += fmt::format("{:12}{}\n", name, version);
    return text;
}

}  // namespace cutterflow
