#include "meshing/cutter/mesh_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "geometry/base/axis_frame.hpp"
#include "geometry/head/head_names.hpp"
#include "meshing/cutter/background_mesh.hpp"

namespace cutterflow::meshing {
namespace {

using nlohmann::json;

double relative_error(double value, double exact) {
    return std::abs(value / exact - 1.0);
}

const PatchFigures* find_patch(const ProbeFigures& figures, const std::string& name) {
    const auto found = std::find_if(figures.patches.begin(), figures.patches.end(), [&](const PatchFigures& p) { return p.name == name; });
    return found == figures.patches.end() ? nullptr : &*found;
}

double area_error(const ProbeFigures& figures, const std::string& patch, double exact) {
    const PatchFigures* found = find_patch(figures, patch);
    return found ? relative_error(found->area, exact) : 1.0;
}

int missing_patches(const ProbeFigures& figures) {
    constexpr std::array<const char*, 9> wanted = {names::cutter_patch,      names::backplate_patch,       names::suction_pipe_patch,
                                                   names::outlet_patch,      names::inlet_patch,           names::tank_top_patch,
                                                   names::tank_bottom_patch, names::rotor_interface_patch, names::stator_interface_patch};
    return static_cast<int>(std::count_if(wanted.begin(), wanted.end(), [&](const char* name) { return !find_patch(figures, name); }));
}

double split_faces(const InterfaceSide& side, std::size_t planned) {
    return side.restored ? std::abs(static_cast<double>(side.faces) - static_cast<double>(planned)) : static_cast<double>(side.faces);
}

InterfaceSide side_of(const json& restore, const char* patch) {
    const json& side = restore.at(patch);
    return {side.at("faces").get<std::size_t>(), side.at("restored").get<bool>(), side.at("drift_max_m").get<double>()};
}

}  // namespace

ProbeFigures parse_probe(const json& probe, const json& restore) {
    ProbeFigures figures;
    figures.cells = probe.at("cells").get<std::size_t>();
    figures.volume_min = probe.at("volume_min_m3").get<double>();
    figures.volume_max = probe.at("volume_max_m3").get<double>();
    if (const auto rotor = probe.at("zones").find(names::rotor_zone); rotor != probe.at("zones").end()) {
        figures.rotor_cells = rotor->at("cells").get<std::size_t>();
        figures.rotor_volume = rotor->at("volume_m3").get<double>();
    }
    for (const auto& [name, patch] : probe.at("patches").items())
        figures.patches.push_back({name, patch.at("area_m2").get<double>(), patch.at("cell_size_mean_m").get<double>()});
    figures.weight_min = std::numeric_limits<double>::infinity();
    for (const json& position : probe.at("interface")) {
        for (const char* side : {"rotor", "stator"}) {
            figures.weight_min = std::min(figures.weight_min, position.at(side).at("min").get<double>());
            figures.weight_max = std::max(figures.weight_max, position.at(side).at("max").get<double>());
        }
    }
    figures.rotor_side = side_of(restore, k_rotor_side_patch);
    figures.stator_side = side_of(restore, k_stator_side_patch);
    return figures;
}

const MeshGate* MeshReport::first_failed_gate() const {
    const auto failed = std::find_if(gates.begin(), gates.end(), [](const MeshGate& gate) { return !gate.passed(); });
    return failed == gates.end() ? nullptr : &*failed;
}

double MeshReport::cell_size_min() const {
    return std::cbrt(figures.volume_min);
}

double MeshReport::cell_size_max() const {
    return std::cbrt(figures.volume_max);
}

double MeshReport::cell_size_at_cutter() const {
    const PatchFigures* cutter = find_patch(figures, names::cutter_patch);
    return cutter ? cutter->cell_size : 0.0;
}

std::vector<MeshGate> check_mesh_gates(const MeshPlan& plan, const CheckMeshFigures& quality, const ProbeFigures& figures) {
    const MeshInput& in = plan.input;
    const double height = in.tank.z_max - in.tank.z_min;
    const double inlet = 2.0 * plan.rotor.facets * in.tank.radius * std::sin(k_pi / plan.rotor.facets) * height;
    const double outlet = k_pi * in.steel.mouth.radius * in.steel.mouth.radius;
    const double split = split_faces(figures.rotor_side, plan.interface_faces()) + split_faces(figures.stator_side, plan.interface_faces());
    const std::string finer = "Use a finer mesh.preset";
    const std::string look_at_log = "Open the sets that checkMesh wrote and repair the cutter's surface there, or use a finer mesh.preset";
    return {
        {"failed checks of checkMesh", static_cast<double>(quality.failed_checks), 0.0, false, look_at_log},
        {"non-orthogonality, deg", quality.non_orthogonality_max, 75.0, false, finer},
        {"skewness", quality.skewness_max, 4.0, false, finer},
        {"smallest cell volume over the background's", figures.volume_min / std::pow(plan.cell_size, 3), 1e-4, true, look_at_log},
        {"missing patches", static_cast<double>(missing_patches(figures)), 0.0, false,
         "Check that mouth and pipe are open from the head to the tank's top"},
        {"interface faces that refinement split", split, 0.0, false, finer},
        {"relative error of the steel's volume in the rotor zone",
         relative_error(plan.rotor.volume() - figures.rotor_volume, in.cutter.volume), 0.1, false,
         "Check that the cutter's surface is closed and outward oriented (cutterflow inspect), or use a finer mesh.preset"},
        {"relative error of the inlet's area", area_error(figures, names::inlet_patch, inlet), 0.01, false, finer},
        {"relative error of the outlet's area", area_error(figures, names::outlet_patch, outlet), 0.1, false, finer},
        {"smallest interface weight", figures.weight_min, 0.98, true, finer},
        {"largest interface weight", figures.weight_max, 1.02, false, finer},
    };
}

json to_json(const MeshReport& report) {
    json retries = json::array();
    for (const MeshRetry& retry : report.retries) retries.push_back({{"failed_gate", retry.failed_gate}, {"change", retry.change}});
    json programs = json::object();
    for (const auto& [program, core_s] : report.program_core_s) programs[program] = core_s;
    return {{"preset", report.preset},
            {"cells", report.figures.cells},
            {"rotor_cells", report.figures.rotor_cells},
            {"stator_cells", report.stator_cells()},
            {"cell_size_min_m", report.cell_size_min()},
            {"cell_size_max_m", report.cell_size_max()},
            {"cell_size_at_cutter_m", report.cell_size_at_cutter()},
            {"non_orthogonality_max_deg", report.quality.non_orthogonality_max},
            {"non_orthogonality_mean_deg", report.quality.non_orthogonality_mean},
            {"skewness_max", report.quality.skewness_max},
            {"aspect_ratio_max", report.quality.aspect_ratio_max},
            {"interface_weight_min", report.figures.weight_min},
            {"interface_weight_max", report.figures.weight_max},
            {"interface_faces", report.figures.rotor_side.faces},
            {"interface_drift_m", std::max(report.figures.rotor_side.drift, report.figures.stator_side.drift)},
            {"time_step_s", report.prediction.time_step},
            {"predicted_cells", std::round(report.prediction.cells)},
            {"predicted_core_hours_per_revolution", report.prediction.core_hours_per_revolution},
            {"predicted_memory_bytes", std::round(report.prediction.mesh_memory)},
            {"memory_bytes", report.memory},
            {"gates", gates_json(report.gates)},
            {"retries", retries},
            {"program_core_s", programs},
            {"wall_s", report.wall_s},
            {"core_s", report.core_s}};
}

void require_mesh_gates(const MeshReport& report) {
    require_gates(report.gates);
}

}  // namespace cutterflow::meshing
