#include "cases/scenes/room/room_flow.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace cutterflow::cases {

namespace {

using meshing::FoamDictionary;
using meshing::FoamValue;

constexpr double k_first_step_share = 0.1;  // of the longest step
constexpr double k_length_share = 0.07;     // length of turbulence over the narrowest side or the opening's size
constexpr double k_still_speed = 0.01;      // of which turbulence begins where nothing flows through the room [m/s]
constexpr double k_least_flow = 1e-3;       // of the largest: a flow of 0 is divided by
constexpr double k_roughness_constant = 0.5;
constexpr const char* k_void_fraction = "voidFraction";  // the solver's field

/// Conditions of every field on a patch.
struct PatchConditions {
    FoamDictionary velocity, pressure, k, epsilon, viscosity;
};

/// Where the velocity is given: the gradient that balances the forces of grains near the patch; zero without grains.
FoamDictionary given_flux() {
    return typed("fixedFluxPressure", 0.0);
}

FoamValue still() {
    return Vec3(0.0, 0.0, 0.0);
}

/// Taken along where the medium leaves, `value` where it comes in.
FoamDictionary inlet_outlet(double value) {
    return typed("inletOutlet").add("inletValue", uniform(value)).add("value", uniform(value));
}

/// Discharge [m3/s] by time, never 0.
FoamValue discharge_table(const ThroughFlow& flow) {
    const double least = k_least_flow * flow.largest_speed();
    std::vector<FoamValue> rows;
    for (const auto& [time, speed] : flow.speed) rows.emplace_back(FoamValue::list({time, flow.area * std::max(speed, least)}));
    return FoamValue::sequence({"table", FoamValue::list(rows)});
}

/// What comes in is the medium alone: a mass flow with the void fraction for a density. What goes out is a mixture whose grains move as the
/// medium does, as in the suction pipe of a cutter.
FoamDictionary through_velocity(const ThroughFlow& flow) {
    if (!flow.into_room)
        return typed("flowRateOutletVelocity").add("volumetricFlowRate", discharge_table(flow)).add("value", uniform(still()));
    return typed("flowRateInletVelocity")
        .add("massFlowRate", discharge_table(flow))
        .add("rho", k_void_fraction)
        .add("rhoInlet", 1.0)
        .add("value", uniform(still()));
}

class Conditions {
public:
    explicit Conditions(const Turbulence& start) : start_(start) {}

    PatchConditions operator()(const NoSlip&) const { return wall(typed("nutkWallFunction", 0.0)); }
    PatchConditions operator()(const RoughWall& rough) const {
        return wall(typed("nutkRoughWallFunction", 0.0).add("Ks", uniform(rough.height)).add("Cs", uniform(k_roughness_constant)));
    }
    PatchConditions operator()(const Slip&) const {
        return {typed("slip"), given_flux(), typed("zeroGradient"), typed("zeroGradient"), typed("calculated", 0.0)};
    }
    PatchConditions operator()(const FixedPressure&) const {
        return {typed("pressureInletOutletVelocity", still()), typed("fixedValue", 0.0), inlet_outlet(start_.k),
                inlet_outlet(start_.epsilon), typed("calculated", 0.0)};
    }
    PatchConditions operator()(const ThroughFlow& flow) const {
        const Turbulence inlet = turbulence_of(flow.largest_speed(), k_length_share * std::sqrt(flow.area));
        return {through_velocity(flow), given_flux(), inlet_outlet(inlet.k), inlet_outlet(inlet.epsilon), typed("calculated", 0.0)};
    }

private:
    PatchConditions wall(FoamDictionary viscosity) const {
        return {typed("noSlip"), given_flux(), typed("kqRWallFunction", start_.k), typed("epsilonWallFunction", start_.epsilon),
                std::move(viscosity)};
    }
    Turbulence start_;
};

/// Patches by name, each once.
std::vector<std::pair<std::string, PatchConditions>> conditions_of(const RoomScene& scene, const meshing::RoomMeshPlan& plan,
                                                                   const Turbulence& start) {
    const Conditions conditions(start);
    std::vector<std::pair<std::string, PatchConditions>> all;
    for (const char* side : meshing::k_room_sides) all.emplace_back(side, conditions(NoSlip{}));
    for (const meshing::RoomMeshSolid& solid : plan.input.solids) all.emplace_back(solid.name, conditions(NoSlip{}));
    for (const RoomBoundary& boundary : scene.boundaries) all.emplace_back(boundary.name, std::visit(conditions, boundary.flow));
    return all;
}

Turbulence start_turbulence(const RoomScene& scene) {
    return turbulence_of(std::max(fastest_flow(scene), k_still_speed), k_length_share * scene.size.minCoeff());
}

std::vector<FoamFile> field_files(const RoomScene& scene, const meshing::RoomMeshPlan& plan) {
    const Turbulence start = start_turbulence(scene);
    FoamDictionary velocity, pressure, k, epsilon, viscosity;
    for (const auto& [name, patch] : conditions_of(scene, plan, start)) {
        velocity.add(name, patch.velocity);
        pressure.add(name, patch.pressure);
        k.add(name, patch.k);
        epsilon.add(name, patch.epsilon);
        viscosity.add(name, patch.viscosity);
    }
    std::vector<FoamFile> files{field_file("U", "volVectorField", k_velocity_dimensions, still(), velocity),
                                field_file("p", "volScalarField", k_pressure_dimensions, 0.0, pressure)};
    if (scene.medium.turbulence == k_laminar) return files;
    files.push_back(field_file("k", "volScalarField", k_pressure_dimensions, start.k, k));
    files.push_back(field_file("epsilon", "volScalarField", k_dissipation_dimensions, start.epsilon, epsilon));
    files.push_back(field_file("nut", "volScalarField", k_viscosity_dimensions, start.eddy_viscosity(), viscosity));
    return files;
}

Vec3 place_of(const nlohmann::json& numbers) {
    return {numbers.at(0).get<double>(), numbers.at(1).get<double>(), numbers.at(2).get<double>()};
}

/// The pressure at the two places of each measure of a pressure drop, in every step.
FoamDictionary probes(const RoomScene& scene) {
    FoamDictionary functions;
    for (const nlohmann::json& measure : scene.measures) {
        if (measure.at("what") != "pressure_drop") continue;
        functions.add(
            measure.at("name").get<std::string>(),
            typed("probes")
                .add("libs", FoamValue::list({"sampling"}))
                .add("writeControl", "timeStep")
                .add("writeInterval", 1)
                .add("log", false)
                .add("fields", FoamValue::list({"p"}))
                .add("probeLocations", FoamValue::list({place_of(measure.at("upstream_m")), place_of(measure.at("downstream_m"))})));
    }
    return functions;
}

FoamFile control_file(const RoomScene& scene) {
    FoamDictionary control;
    control.add("application", "cutterFoam")
        .add("startFrom", "latestTime")
        .add("startTime", 0)
        .add("stopAt", "endTime")
        .add("endTime", scene.run.end)
        .add("deltaT", k_first_step_share * scene.run.longest_step)
        .add("adjustTimeStep", true)
        .add("maxCo", scene.run.max_courant)
        .add("maxDeltaT", scene.run.longest_step)
        .add("writeControl", "adjustableRunTime")
        .add("writeInterval", scene.run.write_interval)
        .add("purgeWrite", 0)
        .add("writeFormat", "binary")  // exact, so that a restart continues the same run
        .add("writeCompression", false)
        .add("timeFormat", "general")
        .add("timePrecision", 8)
        .add("runTimeModifiable", false)
        .add("functions", probes(scene));
    return system_file("controlDict", control);
}

}  // namespace

std::vector<FoamFile> room_flow_files(const RoomScene& scene, const meshing::RoomMeshPlan& plan) {
    std::vector<FoamFile> files = field_files(scene, plan);
    files.push_back(transport_file(scene.medium.density, scene.medium.kinematic_viscosity));
    files.push_back(turbulence_file(scene.medium.turbulence));
    files.push_back(property_file("dynamicMeshDict", FoamDictionary().add("dynamicFvMesh", "staticFvMesh")));
    files.push_back(gravity_file(scene.gravity()));
    files.push_back(control_file(scene));
    for (const FoamFile& file : run_numerics_files(FlowNumerics())) files.push_back(file);
    return files;
}

std::string outlet_patch(const RoomScene& scene) {
    std::string at_pressure;
    for (const RoomBoundary& boundary : scene.boundaries) {
        const auto* flow = std::get_if<ThroughFlow>(&boundary.flow);
        if (flow != nullptr && !flow->into_room) return boundary.name;
        if (std::holds_alternative<FixedPressure>(boundary.flow) && at_pressure.empty()) at_pressure = boundary.name;
    }
    return at_pressure;
}

double fastest_flow(const RoomScene& scene) {
    double fastest = 0.0;
    for (const RoomBoundary& boundary : scene.boundaries)
        if (const auto* flow = std::get_if<ThroughFlow>(&boundary.flow)) fastest = std::max(fastest, flow->largest_speed());
    return fastest;
}

}  // namespace cutterflow::cases
