#include "cases/flow_dictionaries.hpp"

#include <fmt/format.h>

#include <cmath>

#include "geometry/base/run_names.hpp"
#include "meshing/mesh_dictionaries.hpp"

namespace cutterflow::cases {
namespace {

constexpr double k_intensity = 0.05;
constexpr double k_length_per_ring_radius = 0.07;
constexpr double k_c_mu = 0.09;
constexpr double k_pressure_tolerance = 2e-8;  // keeps the flow balance well within 1e-6 of the discharge, also in the first step

constexpr std::array<int, 7> k_velocity = {0, 1, -1, 0, 0, 0, 0};
constexpr std::array<int, 7> k_pressure = {0, 2, -2, 0, 0, 0, 0};
constexpr std::array<int, 7> k_dissipation = {0, 2, -3, 0, 0, 0, 0};
constexpr std::array<int, 7> k_viscosity = {0, 2, -1, 0, 0, 0, 0};
constexpr std::array<int, 7> k_acceleration = {0, 1, -2, 0, 0, 0, 0};

FoamValue uniform(FoamValue value) {
    return FoamValue::sequence({"uniform", std::move(value)});
}

FoamDictionary typed(const std::string& type) {
    return FoamDictionary().add("type", type);
}

FoamDictionary typed(const std::string& type, FoamValue value) {
    return typed(type).add("value", uniform(std::move(value)));
}

/// What stands on each group of patches of one field.
struct Boundary {
    FoamDictionary inlet, outlet, cutter, wall;
};

FoamFile field_file(const std::string& name, const std::string& foam_class, const std::array<int, 7>& dimensions, FoamValue internal,
                    const Boundary& boundary) {
    FoamDictionary patches;
    patches.add(names::inlet_patch, boundary.inlet).add(names::outlet_patch, boundary.outlet).add(names::cutter_patch, boundary.cutter);
    for (const char* wall : {names::backplate_patch, names::suction_pipe_patch, names::tank_top_patch, names::tank_bottom_patch})
        patches.add(wall, boundary.wall);
    for (const char* side : {names::rotor_interface_patch, names::stator_interface_patch}) patches.add(side, typed("cyclicAMI"));

    FoamDictionary field;
    field.add("dimensions", FoamValue::dimensions(dimensions))
        .add("internalField", uniform(std::move(internal)))
        .add("boundaryField", patches);
    return {"0/" + name, foam_class, field};
}

/// A turbulence quantity: given where water enters, free where it leaves, a wall function on steel and bed.
FoamFile turbulence_field(const std::string& name, const std::array<int, 7>& dimensions, double start, double inlet,
                          const std::string& wall_function) {
    const FoamDictionary open = typed("inletOutlet").add("inletValue", uniform(inlet)).add("value", uniform(inlet));
    const FoamDictionary wall = typed(wall_function, start);
    return field_file(name, "volScalarField", dimensions, start, {open, open, wall, wall});
}

FoamFile property_file(const std::string& name, FoamDictionary contents) {
    return {"constant/" + name, "dictionary", std::move(contents)};
}
FoamFile system_file(const std::string& name, FoamDictionary contents) {
    return {"system/" + name, "dictionary", std::move(contents)};
}

const char* convection_scheme(const CaseInputs& inputs) {
    const ConvectionScheme scheme =
        inputs.numerics.convection.value_or(inputs.rock ? ConvectionScheme::upwind : ConvectionScheme::limited_linear);
    return scheme == ConvectionScheme::upwind ? "Gauss upwind" : "Gauss limitedLinearV 1";
}

FoamDictionary one(const std::string& key, const std::string& scheme) {
    return FoamDictionary().add(key, FoamValue::raw(scheme));
}

/// Schemes that start and run share. `limit` is the share of the non-orthogonal correction that is kept (0 to 1).
FoamFile schemes_file(const std::string& time_scheme, const FoamDictionary& convection, double limit) {
    const std::string limited = fmt::format("limited corrected {}", limit);
    FoamDictionary gradients = one("default", "Gauss linear");
    gradients.add("grad(U)", FoamValue::raw("cellLimited Gauss linear 1"));
    FoamDictionary schemes;
    schemes.add("ddtSchemes", one("default", time_scheme))
        .add("gradSchemes", gradients)
        .add("divSchemes", convection)
        .add("laplacianSchemes", one("default", "Gauss linear " + limited))
        .add("interpolationSchemes", one("default", "linear"))
        .add("snGradSchemes", one("default", limited))
        .add("wallDist", one("method", "meshWave"));
    return system_file("fvSchemes", schemes);
}

FoamDictionary pressure_solver(double tolerance, double relative) {
    return FoamDictionary()
        .add("solver", "GAMG")
        .add("smoother", "DICGaussSeidel")
        .add("cacheAgglomeration", true)  // both solutions of a step share it; mesh motion discards it
        .add("tolerance", tolerance)
        .add("relTol", relative);
}

FoamDictionary transport_solver(double tolerance, double relative) {
    return FoamDictionary()
        .add("solver", "smoothSolver")
        .add("smoother", "symGaussSeidel")
        .add("tolerance", tolerance)
        .add("relTol", relative);
}

FoamDictionary monitor(const std::string& type, const std::string& library) {
    FoamDictionary function = typed(type);
    function.add("libs", FoamValue::list({library})).add("writeControl", "timeStep").add("writeInterval", 1).add("log", false);
    return function;
}

FoamDictionary patch_monitor(const char* patch, const std::string& operation, const std::string& field) {
    return monitor("surfaceFieldValue", "fieldFunctionObjects")
        .add("regionType", "patch")
        .add("name", patch)
        .add("operation", operation)
        .add("fields", FoamValue::list({field}))
        .add("writeFields", false);
}

}  // namespace

double Turbulence::eddy_viscosity() const {
    return k_c_mu * k * k / epsilon;
}

Turbulence turbulence_of(double speed, double length) {
    const double k = 1.5 * std::pow(k_intensity * speed, 2);
    return {k, std::pow(k_c_mu, 0.75) * std::pow(k, 1.5) / length};
}

Turbulence inlet_turbulence(const CaseInputs& inputs) {
    const double area = 2.0 * k_pi * inputs.tank.radius * (inputs.tank.z_max - inputs.tank.z_min);
    return turbulence_of(inputs.discharge / area, k_length_per_ring_radius * inputs.contour.ring_radius());
}

Turbulence initial_turbulence(const CaseInputs& inputs) {
    return turbulence_of(tip_speed(inputs), k_length_per_ring_radius * inputs.contour.ring_radius());
}

std::vector<FoamFile> field_files(const CaseInputs& inputs) {
    const FoamValue zero = Vec3(0.0, 0.0, 0.0);
    const Turbulence start = initial_turbulence(inputs);
    const Turbulence inlet = inlet_turbulence(inputs);

    const Boundary velocity = {typed("pressureInletOutletVelocity", zero),
                               typed("flowRateOutletVelocity").add("volumetricFlowRate", inputs.discharge).add("value", uniform(zero)),
                               typed("movingWallVelocity", zero), typed("noSlip")};
    // Where the velocity is given: the gradient that the forces of rock on the near fluid ask for; zero without rock.
    const FoamDictionary given_flux = typed("fixedFluxPressure", 0.0);
    const Boundary pressure = {typed("fixedValue", 0.0), given_flux, given_flux, given_flux};
    const FoamDictionary calculated = typed("calculated", 0.0);
    const FoamDictionary wall_viscosity = typed("nutkWallFunction", 0.0);

    return {
        field_file("U", "volVectorField", k_velocity, zero, velocity), field_file("p", "volScalarField", k_pressure, 0.0, pressure),
        turbulence_field("k", k_pressure, start.k, inlet.k, "kqRWallFunction"),
        turbulence_field("epsilon", k_dissipation, start.epsilon, inlet.epsilon, "epsilonWallFunction"),
        field_file("nut", "volScalarField", k_viscosity, start.eddy_viscosity(), {calculated, calculated, wall_viscosity, wall_viscosity})};
}

std::vector<FoamFile> property_files(const CaseInputs& inputs) {
    FoamDictionary transport;
    transport.add("transportModel", "Newtonian").add("nu", inputs.fluid.kinematic_viscosity).add("rho", inputs.fluid.density);

    FoamDictionary model;
    model.add("RASModel", "realizableKE").add("turbulence", true).add("printCoeffs", false);
    FoamDictionary turbulence;
    turbulence.add("simulationType", "RAS").add("RAS", model);

    FoamDictionary gravity;
    gravity.add("dimensions", FoamValue::dimensions(k_acceleration)).add("value", inputs.gravity);
    return {property_file("transportProperties", transport),
            property_file("turbulenceProperties", turbulence),
            {"constant/g", "uniformDimensionedVectorField", gravity}};
}

FoamFile dynamic_mesh_file(const CaseInputs& inputs) {
    FoamDictionary rotation;
    rotation.add("origin", inputs.rotor.axis.origin).add("axis", inputs.rotor.axis.direction).add("omega", inputs.rotor.speed);
    FoamDictionary solver;
    solver.add("cellZone", names::rotor_zone).add("solidBodyMotionFunction", "rotatingMotion").add("rotatingMotionCoeffs", rotation);
    FoamDictionary mesh;
    mesh.add("dynamicFvMesh", "dynamicMotionSolverFvMesh").add("motionSolver", "solidBody").add("solidBodyCoeffs", solver);
    return property_file("dynamicMeshDict", mesh);
}

FoamFile frozen_rotor_file(const CaseInputs& inputs) {
    FoamDictionary zone;
    zone.add("cellZone", names::rotor_zone)
        .add("active", true)
        // A cyclicAMI patch does not call itself coupled: unless it is named here, its faces count as turning steel and let nothing
        // through.
        .add("nonRotatingPatches", FoamValue::list({names::rotor_interface_patch, names::stator_interface_patch}))
        .add("origin", inputs.rotor.axis.origin)
        .add("axis", inputs.rotor.axis.direction)
        .add("omega", inputs.rotor.speed);
    return property_file("MRFProperties", FoamDictionary().add("rotor", zone));
}

std::vector<FoamFile> run_system_files(const CaseInputs& inputs) {
    FoamDictionary convection = one("default", "none");
    convection.add("div(phi,U)", FoamValue::raw(convection_scheme(inputs)))
        .add("div(phi,k)", FoamValue::raw("Gauss upwind"))
        .add("div(phi,epsilon)", FoamValue::raw("Gauss upwind"))
        .add("div((nuEff*dev2(T(grad(U)))))", FoamValue::raw("Gauss linear"));

    FoamDictionary solvers;
    solvers.add("p", pressure_solver(k_pressure_tolerance, 0.02)).add("pFinal", pressure_solver(k_pressure_tolerance, 0.0));
    solvers.add("pcorr", pressure_solver(1e-3, 0.0)).add("pcorrFinal", pressure_solver(1e-3, 0.0));
    solvers.add_pattern("(U|k|epsilon)", transport_solver(1e-7, 0.1)).add_pattern("(U|k|epsilon)Final", transport_solver(1e-7, 0.0));
    FoamDictionary pimple;
    pimple.add("momentumPredictor", true)
        .add("nOuterCorrectors", inputs.numerics.outer_correctors)
        .add("nCorrectors", inputs.numerics.pressure_correctors)
        .add("nNonOrthogonalCorrectors", 0)
        .add("correctPhi", false)
        .add("checkMeshCourantNo", false)
        .add("turbOnFinalIterOnly", true);
    FoamDictionary relaxation;
    relaxation.add("equations", FoamDictionary().add_pattern(".*", 1.0));
    FoamDictionary solution;
    solution.add("solvers", solvers).add("PIMPLE", pimple).add("relaxationFactors", relaxation);

    const RunTimes& times = inputs.times;
    FoamDictionary control;
    control.add("application", "cutterFoam")
        .add("startFrom", "latestTime")
        .add("startTime", 0)
        .add("stopAt", "endTime")
        .add("endTime", times.end)
        .add("deltaT", times.first_time_step)
        .add("adjustTimeStep", true)
        .add("maxCo", inputs.numerics.max_courant)
        .add("maxDeltaT", largest_time_step(inputs.rotor.speed))
        .add("writeControl", "adjustableRunTime")
        .add("writeInterval", times.write_interval)
        .add("purgeWrite", 0)
        .add("writeFormat", "binary")  // exact, so that a restart continues the same run
        .add("writeCompression", false)
        .add("timeFormat", "general")
        .add("timePrecision", 8)
        .add("runTimeModifiable", true)
        .add("libs", FoamValue::list({}));

    return {schemes_file("Euler", convection, 0.5), system_file("fvSolution", solution), system_file("controlDict", control)};
}

std::vector<FoamFile> start_system_files(const CaseInputs& inputs, int iterations) {
    FoamDictionary convection = one("default", "none");
    for (const char* field : {"U", "k", "epsilon"})
        convection.add(fmt::format("div(phi,{})", field), FoamValue::raw("bounded Gauss upwind"));
    convection.add("div((nuEff*dev2(T(grad(U)))))", FoamValue::raw("Gauss linear"));

    FoamDictionary solvers;
    solvers.add("p", pressure_solver(1e-9, 0.02)).add_pattern("(U|k|epsilon)", transport_solver(1e-9, 0.1));
    FoamDictionary relaxation;
    relaxation.add("fields", FoamDictionary().add("p", 0.3));
    relaxation.add("equations", FoamDictionary().add("U", 0.7).add_pattern("(k|epsilon)", 0.5));
    FoamDictionary solution;
    solution.add("solvers", solvers)
        .add("SIMPLE", FoamDictionary().add("nNonOrthogonalCorrectors", 0))
        .add("relaxationFactors", relaxation);

    FoamDictionary torque = monitor("forces", "forces");
    torque.add("patches", FoamValue::list({names::cutter_patch}))
        .add("rho", "rhoInf")
        .add("rhoInf", inputs.fluid.density)
        .add("CofR", inputs.rotor.axis.origin);
    FoamDictionary functions;
    functions.add("torque", torque)
        .add("outletPressure", patch_monitor(names::outlet_patch, "areaAverage", "p"))
        .add("outletFlow", patch_monitor(names::outlet_patch, "sum", "phi"))
        .add("inletFlow", patch_monitor(names::inlet_patch, "sum", "phi"));

    FoamDictionary control;
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
    return system_file("decomposeParDict", decomposition(ranks));
}

}  // namespace cutterflow::cases
