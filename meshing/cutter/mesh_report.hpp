#pragma once
/// \file Properties of a mesh, and its gates.
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "meshing/cutter/mesh_plan.hpp"
#include "meshing/quality/check_mesh.hpp"

namespace cutterflow::meshing {

/// Figures of cutterInterfaceRestore for one side.
struct InterfaceSide {
    std::size_t faces = 0;
    bool restored = false;
    double drift = 0.0;  ///< largest distance by which snappyHexMesh had moved one of its points [m]
};

struct PatchFigures {
    std::string name;
    double area = 0.0;       ///< [m2]
    double cell_size = 0.0;  ///< mean cube root of the volumes behind the faces [m]
};

/// Figures of cutterInterfaceRestore and cutterMeshProbe.
struct ProbeFigures {
    std::size_t cells = 0;
    double volume_min = 0.0, volume_max = 0.0;  ///< of a cell [m3]
    std::size_t rotor_cells = 0;                ///< 0: there is no zone `rotor`
    double rotor_volume = 0.0;                  ///< [m3]
    std::vector<PatchFigures> patches;          ///< those with faces
    double weight_min = 0.0, weight_max = 0.0;  ///< of both sides, at all angles
    InterfaceSide rotor_side, stator_side;
};

/// Reads the reports of the two programs.
ProbeFigures parse_probe(const nlohmann::json& probe, const nlohmann::json& restore);

/// Change of the next attempt after a failed gate.
struct MeshRetry {
    std::string failed_gate;
    std::string change;
};

struct MeshReport {
    std::string preset;
    CheckMeshFigures quality;
    ProbeFigures figures;
    MeshPrediction prediction;
    std::vector<MeshGate> gates;
    std::vector<MeshRetry> retries;
    std::vector<std::pair<std::string, double>> program_core_s;  ///< programs in the order in which they ran [s]
    double wall_s = 0.0, core_s = 0.0;
    double memory = 0.0;  ///< largest resident set of a program [bytes]

    const MeshGate* first_failed_gate() const;  ///< null when all passed
    std::size_t stator_cells() const { return figures.cells - figures.rotor_cells; }
    double cell_size_min() const;        ///< cube root of the smallest volume [m]
    double cell_size_max() const;        ///< [m]
    double cell_size_at_cutter() const;  ///< [m]
};

/// The gates of a mesh. Relative errors are against the plan's exact figures:
///   failed checks of checkMesh             0
///   non-orthogonality [deg]                75
///   skewness                               4
///   smallest cell volume over cell_size³   1e-4
///   missing patches                        0
///   interface faces that refinement split  0 (a side that could not be restored counts all its faces)
///   steel in the rotor zone, |(prism - zone) / steel - 1|   0.1 (an inverted or a wrong zone, a lost blade)
///   inlet area, outlet area                0.01, 0.1
///   smallest and largest interface weight  0.98, 1.02
std::vector<MeshGate> check_mesh_gates(const MeshPlan& plan, const CheckMeshFigures& quality, const ProbeFigures& figures);

/// mesh.json (docs/design/001-contracts.md).
nlohmann::json to_json(const MeshReport& report);

/// \throws CheckFailure  as require_gates
void require_mesh_gates(const MeshReport& report);

}  // namespace cutterflow::meshing
