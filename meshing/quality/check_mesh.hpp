#pragma once
/// \file What checkMesh says of a mesh, and demands on a mesh.
#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace cutterflow::meshing {

/// Figures of checkMesh.
struct CheckMeshFigures {
    double non_orthogonality_max = 0.0;   ///< [deg]
    double non_orthogonality_mean = 0.0;  ///< [deg]
    double skewness_max = 0.0;
    double aspect_ratio_max = 0.0;
    int failed_checks = 0;
};

/// Reads the log of `checkMesh`.
/// \throws ToolError  when the log is incomplete; `name` is the log's name in the message
CheckMeshFigures parse_check_mesh(const std::string& log, const std::string& name);

/// Size of the mesh, as checkMesh has it.
struct CheckMeshSize {
    std::size_t cells = 0;
    double volume = 0.0;               ///< [m3]
    double volume_min = 0.0;           ///< of a cell [m3]
    std::size_t regions = 0;           ///< parts of the mesh that no face connects
    std::vector<std::string> patches;  ///< those with faces
    bool has_patch(const std::string& name) const;
};

/// \throws ToolError  as parse_check_mesh
CheckMeshSize parse_check_mesh_size(const std::string& log, const std::string& name);

/// One demand on the mesh. `at_least`: passed when value >= limit, otherwise when value <= limit.
struct MeshGate {
    std::string name;
    double value = 0.0;
    double limit = 0.0;
    bool at_least = false;
    std::string remedy;
    bool passed() const { return at_least ? value >= limit : value <= limit; }
};

/// name, value, limit, passed of each.
nlohmann::json gates_json(const std::vector<MeshGate>& gates);

/// \throws CheckFailure  when gates failed: the first with value, limit and remedy, the others by name
void require_gates(const std::vector<MeshGate>& gates);

}  // namespace cutterflow::meshing
