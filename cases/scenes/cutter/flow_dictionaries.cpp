#include "cases/scenes/cutter/flow_dictionaries.hpp"

#include <fmt/format.h>

#include <cmath>

#include "geometry/head/head_names.hpp"
#include "meshing/cutter/mesh_dictionaries.hpp"

namespace cutterflow::cases {
namespace {

constexpr double k_length_per_ring_radius = 0.07;

/// Boundary conditions of one field by group of patches.
struct Boundary {
    meshing::FoamDictionary inlet, outlet, cutter, steel, tank;
};

FoamFile head_field(const std::string& name, const std::string& foam_class, const std::array<int, 7>& dimensions,
                    meshing::FoamValue internal, const Boundary& boundary) {
    meshing::FoamDictionary patches;
    patches.add(names::inlet_patch, boundary.inlet).add(names::outlet_patch, boundary.outlet).add(names::cutter_patch, boundary.cutter);
    for (const char* wall : {names::backplate_patch, names::suction_pipe_patch}) patches.add(wall, boundary.steel);
    for (const char* wall : {names::tank_top_patch, names::tank_bottom_patch}) patches.add(wall, boundary.tank);
    for (const char* side : {names::rotor_interface_patch, names::stator_interface_patch}) patches.add(side, typed("cyclicAMI"));

    return field_file(name, foam_class, dimensions, std::move(internal), patches);
}

/// A turbulence quantity: given where water enters, free where it leaves, a wall function on steel and bed.
FoamFile turbulence_field(const std::string& name, const std::array<int, 7>& dimensions, double start, double inlet,
                          const std::string& wall_function) {
    const meshing::FoamDictionary open = typed("inletOutlet").add("inletValue", uniform(inlet)).add("value", uniform(inlet));
    const meshing::FoamDictionary wall = typed(wall_function, start);
    return head_field(name, "volScalarField", dimensions, start, {open, open, wall, wall, wall});
}

meshing::FoamDictionary steady_pressure_solver(double tolerance, double relative) {
    return multigrid("solver").add("tolerance", tolerance).add("relTol", relative);
}

meshing::FoamDictionary monitor(const std::string& type, const std::string& library) {
    meshing::FoamDictionary function = typed(type);
    function.add("libs", meshing::FoamValue::list({library})).add("writeControl", "timeStep").add("writeInterval", 1).add("log", false);
    return function;
}

meshing::FoamDictionary patch_monitor(const char* patch, const std::string& operation, const std::string& field) {
    return monitor("surfaceFieldValue", "fieldFunctionObjects")
        .add("regionType", "patch")
        .add("name", patch)
        .add("operation", operation)
        .add("fields", meshing::FoamValue::list({field}))
        .add("writeFields", false);
}

}  // namespace

Turbulence inlet_turbulence(const CaseInputs& inputs) {
    const double area = 2.0 * k_pi * inputs.tank.radius * (inputs.tank.z_max - inputs.tank.z_min);
    return turbulence_of(inputs.discharge / area + inputs.hauling.norm(), k_length_per_ring_radius * inputs.contour.ring_radius());
}

Turbulence initial_turbulence(const CaseInputs& inputs) {
    return turbulence_of(tip_speed(inputs), k_length_per_ring_radius * inputs.contour.ring_radius());
}

std::vector<FoamFile> field_files(const CaseInputs& inputs) {
    const meshing::FoamValue zero = Vec3(0.0, 0.0, 0.0);
    const Turbulence start = initial_turbulence(inputs);
    const Turbulence inlet = inlet_turbulence(inputs);

    // In the frame of a head that travels the water far from it moves past. All around it has its own pressure, and what comes in has its
    // velocity, also where the mouth draws it in against the stream.
    const bool travels = inputs.hauling != Vec3::Zero();
    const meshing::FoamValue far = inputs.hauling;
    const Boundary velocity = {
        travels ? typed("inletOutlet", far).add("inletValue", uniform(far)) : typed("pressureInletOutletVelocity", zero),
        typed("flowRateOutletVelocity").add("volumetricFlowRate", inputs.discharge).add("value", uniform(zero)),
        typed("movingWallVelocity", zero), typed("noSlip"), travels ? typed("fixedValue", far) : typed("noSlip")};
    // Where the velocity is given: the gradient that balances the forces of rock near the patch; zero without rock.
    const meshing::FoamDictionary given_flux = typed("fixedFluxPressure", 0.0);
    const Boundary pressure = {typed("fixedValue", 0.0), given_flux, given_flux, given_flux, given_flux};
    const meshing::FoamDictionary calculated = typed("calculated", 0.0);
    const meshing::FoamDictionary wall_viscosity = typed("nutkWallFunction", 0.0);

    return {head_field("U", "volVectorField", k_velocity_dimensions, far, velocity),
            head_field("p", "volScalarField", k_pressure_dimensions, 0.0, pressure),
            turbulence_field("k", k_pressure_dimensions, start.k, inlet.k, "kqRWallFunction"),
            turbulence_field("epsilon", k_dissipation_dimensions, start.epsilon, inlet.epsilon, "epsilonWallFunction"),
            head_field("nut", "volScalarField", k_viscosity_dimensions, start.eddy_viscosity(),
                       {calculated, calculated, wall_viscosity, wall_viscosity, wall_viscosity})};
}

std::vector<FoamFile> property_files(const CaseInputs& inputs) {
    return {transport_file(inputs.fluid.density, inputs.fluid.kinematic_viscosity), turbulence_file("realizableKE"),
            gravity_file(inputs.gravity)};
}

FoamFile dynamic_mesh_file(const CaseInputs& inputs) {
    meshing::FoamDictionary rotation;
    rotation.add("origin", inputs.rotor.axis.origin).add("axis", inputs.rotor.axis.direction).add("omega", inputs.rotor.speed);
    meshing::FoamDictionary solver;
    solver.add("cellZone", names::rotor_zone).add("solidBodyMotionFunction", "rotatingMotion").add("rotatingMotionCoeffs", rotation);
    meshing::FoamDictionary mesh;
    mesh.add("dynamicFvMesh", "dynamicMotionSolverFvMesh").add("motionSolver", "solidBody").add("solidBodyCoeffs", solver);
    return property_file("dynamicMeshDict", mesh);
}

FoamFile frozen_rotor_file(const CaseInputs& inputs) {
    meshing::FoamDictionary zone;
    zone.add("cellZone", names::rotor_zone)
        .add("active", true)
        // A cyclicAMI patch does not call itself coupled: unless it is named here, its faces count as turning steel and let nothing
        // through.
        .add("nonRotatingPatches", meshing::FoamValue::list({names::rotor_interface_patch, names::stator_interface_patch}))
        .add("origin", inputs.rotor.axis.origin)
        .add("axis", inputs.rotor.axis.direction)
        .add("omega", inputs.rotor.speed);
    return property_file("MRFProperties", meshing::FoamDictionary().add("rotor", zone));
}

std::vector<FoamFile> run_system_files(const CaseInputs& inputs) {
    const RunTimes& times = inputs.times;
    meshing::FoamDictionary control;
    control.add("application", "cutterFoam")
        .add("startFrom", "latestTime")
        .add("startTime", 0)
        .add("stopAt", "endTime")
        .add("endTime", times.end)
        .add("deltaT", times.first_time_step)
        .add("adjustTimeStep", true)
        .add("maxCo", inputs.numerics.max_courant)
        .add("maxDeltaT", largest_time_step(inputs.rotor.speed))
        .add("developmentEnd", times.development_end)
        .add("developmentStepRatio", k_development_step_ratio)
        .add("writeControl", "adjustableRunTime")
        .add("writeInterval", times.write_interval)
        .add("purgeWrite", 0)
        .add("writeFormat", "binary")  // exact, so that a restart continues the same run
        .add("writeCompression", false)
        .add("timeFormat", "general")
        .add("timePrecision", 8)
        .add("runTimeModifiable", true)
        .add("libs", meshing::FoamValue::list({}));

    std::vector<FoamFile> files = run_numerics_files(inputs.numerics);
    files.push_back(system_file("controlDict", control));
    return files;
}

std::vector<FoamFile> start_system_files(const CaseInputs& inputs, int iterations) {
    meshing::FoamDictionary convection = one_scheme("default", "none");
    for (const char* field : {"U", "k", "epsilon"})
        convection.add(fmt::format("div(phi,{})", field), meshing::FoamValue::raw("bounded Gauss upwind"));
    convection.add("div((nuEff*dev2(T(grad(U)))))", meshing::FoamValue::raw("Gauss linear"));

    meshing::FoamDictionary solvers;
    solvers.add("p", steady_pressure_solver(1e-9, 0.02)).add_pattern("(U|k|epsilon)", transport_solver(1e-9, 0.1));
    meshing::FoamDictionary relaxation;
    relaxation.add("fields", meshing::FoamDictionary().add("p", 0.3));
    relaxation.add("equations", meshing::FoamDictionary().add("U", 0.7).add_pattern("(k|epsilon)", 0.5));
    meshing::FoamDictionary solution;
    solution.add("solvers", solvers)
        .add("SIMPLE", meshing::FoamDictionary().add("nNonOrthogonalCorrectors", 0))
        .add("relaxationFactors", relaxation);

    meshing::FoamDictionary torque = monitor("forces", "forces");
    torque.add("patches", meshing::FoamValue::list({names::cutter_patch}))
        .add("rho", "rhoInf")
        .add("rhoInf", inputs.fluid.density)
        .add("CofR", inputs.rotor.axis.origin);
    meshing::FoamDictionary functions;
    functions.add("torque", torque)
        .add("outletPressure", patch_monitor(names::outlet_patch, "areaAverage", "p"))
        .add("outletFlow", patch_monitor(names::outlet_patch, "sum", "phi"))
        .add("inletFlow", patch_monitor(names::inlet_patch, "sum", "phi"));

    meshing::FoamDictionary control;
    control.add("application", "simpleFoam")
        .add("startFrom", "startTime")
        .add("startTime", 0)
        .add("stopAt", "endTime")
        .add("endTime", iterations)
        .add("deltaT", 1)
        .add("writeControl", "timeStep")
        .add("writeInterval", iterations)
        .add("writeFormat", "binary")
        .add("writeCompression", false)
        .add("timeFormat", "general")
        .add("runTimeModifiable", true)
        .add("functions", functions);

    return {schemes_file("steadyState", convection, 0.5), system_file("fvSolution", solution), system_file("controlDict", control)};
}

FoamFile decompose_file(int ranks) {
    return system_file("decomposeParDict", meshing::decomposition(ranks));
}

}  // namespace cutterflow::cases
