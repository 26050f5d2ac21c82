#include "cases/scenes/flow/flow_files.hpp"

#include <cmath>

#include <fmt/format.h>

namespace cutterflow::cases {
namespace {

constexpr double k_intensity = 0.05;
constexpr double k_c_mu = 0.09;
constexpr double k_pressure_tolerance = 2e-8;  // keeps the flow balance well within 1e-6 of the discharge, also in the first step

constexpr std::array<int, 7> k_acceleration = {0, 1, -2, 0, 0, 0, 0};

const char* scheme_text(ConvectionScheme scheme) {
    return scheme == ConvectionScheme::upwind ? "Gauss upwind" : "Gauss linearUpwindV grad(U)";
}

/// Conjugate gradients, by cutterFoam's own multigrid or with two of OpenFOAM's V-cycles an iteration for other programs;
/// docs/design/007-flow-settings.md has the cost of the alternatives.
meshing::FoamDictionary pressure_solver(double tolerance, double relative) {
    return meshing::FoamDictionary()
        .add("solver", "PCG")
        .add("preconditioner", multigrid("preconditioner"))
        .add("cutterFoamPreconditioner", "aggregationMultigrid")
        .add("tolerance", tolerance)
        .add("relTol", relative);
}

}  // namespace

FoamFile property_file(const std::string& name, meshing::FoamDictionary contents) {
    return {"constant/" + name, "dictionary", std::move(contents)};
}
FoamFile system_file(const std::string& name, meshing::FoamDictionary contents) {
    return {"system/" + name, "dictionary", std::move(contents)};
}

meshing::FoamDictionary one_scheme(const std::string& key, const std::string& scheme) {
    return meshing::FoamDictionary().add(key, meshing::FoamValue::raw(scheme));
}

meshing::FoamValue uniform(meshing::FoamValue value) {
    return meshing::FoamValue::sequence({"uniform", std::move(value)});
}

meshing::FoamDictionary typed(const std::string& type) {
    return meshing::FoamDictionary().add("type", type);
}

meshing::FoamDictionary typed(const std::string& type, meshing::FoamValue value) {
    return typed(type).add("value", uniform(std::move(value)));
}

FoamFile field_file(const std::string& name, const std::string& foam_class, const std::array<int, 7>& dimensions,
                    meshing::FoamValue internal, const meshing::FoamDictionary& patches) {
    meshing::FoamDictionary field;
    field.add("dimensions", meshing::FoamValue::dimensions(dimensions))
        .add("internalField", uniform(std::move(internal)))
        .add("boundaryField", patches);
    return {"0/" + name, foam_class, field};
}

double Turbulence::eddy_viscosity() const {
    return k_c_mu * k * k / epsilon;
}

Turbulence turbulence_of(double speed, double length) {
    const double k = 1.5 * std::pow(k_intensity * speed, 2);
    return {k, std::pow(k_c_mu, 0.75) * std::pow(k, 1.5) / length};
}

FoamFile transport_file(double density, double viscosity) {
    meshing::FoamDictionary transport;
    transport.add("transportModel", "Newtonian").add("nu", viscosity).add("rho", density);
    return property_file("transportProperties", transport);
}

FoamFile turbulence_file(const std::string& model) {
    meshing::FoamDictionary turbulence;
    if (model == k_laminar) return property_file("turbulenceProperties", turbulence.add("simulationType", k_laminar));
    meshing::FoamDictionary ras;
    ras.add("RASModel", model).add("turbulence", true).add("printCoeffs", false);
    return property_file("turbulenceProperties", turbulence.add("simulationType", "RAS").add("RAS", ras));
}

FoamFile gravity_file(const Vec3& gravity) {
    meshing::FoamDictionary contents;
    contents.add("dimensions", meshing::FoamValue::dimensions(k_acceleration)).add("value", gravity);
    return {"constant/g", "uniformDimensionedVectorField", contents};
}

FoamFile schemes_file(const std::string& time_scheme, const meshing::FoamDictionary& convection, double limit) {
    const std::string limited = fmt::format("limited corrected {}", limit);
    meshing::FoamDictionary gradients = one_scheme("default", "Gauss linear");
    gradients.add("grad(U)", meshing::FoamValue::raw("cellLimited Gauss linear 1"));
    meshing::FoamDictionary schemes;
    schemes.add("ddtSchemes", one_scheme("default", time_scheme))
        .add("gradSchemes", gradients)
        .add("divSchemes", convection)
        .add("laplacianSchemes", one_scheme("default", "Gauss linear " + limited))
        .add("interpolationSchemes", one_scheme("default", "linear"))
        .add("snGradSchemes", one_scheme("default", limited))
        .add("wallDist", one_scheme("method", "meshWave"));
    return system_file("fvSchemes", schemes);
}

meshing::FoamDictionary multigrid(const char* role) {
    return meshing::FoamDictionary()
        .add(role, "GAMG")
        .add("smoother", "DICGaussSeidel")
        .add("cacheAgglomeration", true);  // both solutions of a step share it, and it turns with the mesh
}

meshing::FoamDictionary transport_solver(double tolerance, double relative) {
    return meshing::FoamDictionary()
        .add("solver", "smoothSolver")
        .add("smoother", "symGaussSeidel")
        .add("tolerance", tolerance)
        .add("relTol", relative);
}

std::vector<FoamFile> run_numerics_files(const FlowNumerics& numerics) {
    meshing::FoamDictionary convection = one_scheme("default", "none");
    convection.add("div(phi,U)", meshing::FoamValue::raw(scheme_text(numerics.convection)))
        .add("div(phi,k)", meshing::FoamValue::raw("Gauss upwind"))
        .add("div(phi,epsilon)", meshing::FoamValue::raw("Gauss upwind"))
        .add("div((nuEff*dev2(T(grad(U)))))", meshing::FoamValue::raw("Gauss linear"));

    meshing::FoamDictionary solvers;
    solvers.add("p", pressure_solver(k_pressure_tolerance, 0.02)).add("pFinal", pressure_solver(k_pressure_tolerance, 0.0));
    solvers.add("pcorr", pressure_solver(1e-3, 0.0)).add("pcorrFinal", pressure_solver(1e-3, 0.0));
    solvers.add_pattern("(U|k|epsilon)", transport_solver(1e-7, 0.1)).add_pattern("(U|k|epsilon)Final", transport_solver(1e-7, 0.0));
    meshing::FoamDictionary pimple;
    pimple.add("momentumPredictor", true)
        .add("nOuterCorrectors", numerics.outer_correctors)
        .add("nCorrectors", numerics.pressure_correctors)
        .add("nNonOrthogonalCorrectors", 0)
        .add("correctPhi", false)
        .add("checkMeshCourantNo", false)
        .add("turbOnFinalIterOnly", true)
        .add("pRefCell", 0)  // counts where no boundary gives the pressure
        .add("pRefValue", 0);
    meshing::FoamDictionary solution;
    solution.add("cache", one_scheme("grad(U)", "on")).add("solvers", solvers).add("PIMPLE", pimple);
    return {schemes_file("Euler", convection, 0.5), system_file("fvSolution", solution)};
}

}  // namespace cutterflow::cases
