#include "meshing/quality/check_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <regex>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/error.hpp"

namespace cutterflow::meshing {
namespace {

using nlohmann::json;

constexpr const char* k_number = "([-+0-9a-zA-Z.]*[0-9a-zA-Z])";

/// The number after the first `before` in the log.
double number_after(const std::string& log, const std::string& before, const std::string& name) {
    std::smatch found;
    if (!std::regex_search(log, found, std::regex(before + k_number)))
        throw ToolError({"", fmt::format("{} does not contain '{}'", name, before),
                         "checkMesh of OpenFOAM 1912 ends with the mesh's quality", "Read the error in the log"});
    const std::string text = found[1];
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (*end != '\0' || !std::isfinite(number))
        throw ToolError({"", fmt::format("{} has '{}' after '{}'", name, text, before), "A number stands there in a sound mesh",
                         "Read the log from its beginning"});
    return number;
}

/// Rows "name faces points ..." of the table of patches, which ends with an empty line.
std::vector<std::string> patches_with_faces(const std::string& log) {
    std::vector<std::string> patches;
    const std::size_t table = log.find("Checking patch topology");
    if (table == std::string::npos) return patches;
    std::istringstream lines(log.substr(table));
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line) && line.find_first_not_of(' ') != std::string::npos) {
        std::istringstream words(line);
        std::string patch;
        std::size_t faces = 0;
        if (words >> patch >> faces && faces > 0) patches.push_back(patch);
    }
    return patches;
}

}  // namespace

CheckMeshFigures parse_check_mesh(const std::string& log, const std::string& name) {
    CheckMeshFigures figures;
    figures.non_orthogonality_max = number_after(log, "Mesh non-orthogonality Max: ", name);
    figures.non_orthogonality_mean = number_after(log, "Mesh non-orthogonality Max: [^ ]+ average: ", name);
    figures.skewness_max = number_after(log, "Max skewness = ", name);
    figures.aspect_ratio_max = number_after(log, "[Mm]ax aspect ratio[ :=]+", name);
    if (log.find("\nMesh OK.") == std::string::npos) figures.failed_checks = static_cast<int>(number_after(log, "\nFailed ", name));
    return figures;
}

bool CheckMeshSize::has_patch(const std::string& name) const {
    return std::find(patches.begin(), patches.end(), name) != patches.end();
}

CheckMeshSize parse_check_mesh_size(const std::string& log, const std::string& name) {
    CheckMeshSize size;
    size.cells = static_cast<std::size_t>(number_after(log, "\n +cells: +", name));
    size.volume = number_after(log, "Total volume = ", name);
    size.volume_min = number_after(log, "Min volume = ", name);
    size.regions = static_cast<std::size_t>(number_after(log, "Number of regions: ", name));
    size.patches = patches_with_faces(log);
    return size;
}

json gates_json(const std::vector<MeshGate>& gates) {
    json list = json::array();
    for (const MeshGate& gate : gates)
        list.push_back({{"name", gate.name}, {"value", gate.value}, {"limit", gate.limit}, {"passed", gate.passed()}});
    return list;
}

void require_gates(const std::vector<MeshGate>& gates) {
    std::vector<const MeshGate*> failed;
    for (const MeshGate& gate : gates)
        if (!gate.passed()) failed.push_back(&gate);
    if (failed.empty()) return;
    std::string others;
    for (std::size_t i = 1; i < failed.size(); ++i) others += (i == 1 ? "; failed too: " : ", ") + failed[i]->name;
    const MeshGate& first = *failed.front();
    throw CheckFailure({"", fmt::format("The mesh's {} is {:.4g}{}", first.name, first.value, others),
                        fmt::format("It must be {} {:.4g}", first.at_least ? "at least" : "at most", first.limit), first.remedy});
}

}  // namespace cutterflow::meshing
