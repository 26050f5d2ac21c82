/// \file The same bed in stock DPMFoam and in cutterFoam: pressure drop against the bed's weight, and time against time.
#include <array>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "meshing/dictionary/foam_command.hpp"
#include "postproc/analysis/time_average.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
namespace fs = std::filesystem;

fs::path tutorial() {
    return installation().data / "tutorials/lagrangian/DPMFoam/Goldschmidt";
}

// The bed, as the tutorial has it, halved in width and height.
constexpr double k_diameter = 0.0025, k_density = 2526.0, k_air_density = 1.2, k_gravity = 9.81;
constexpr double k_half_depth = 0.0075, k_half_width = 0.0375, k_height = 0.225;
constexpr std::array<int, 3> k_columns = {6, 28, 36};
constexpr double k_spacing = 0.0026;

constexpr double k_stock_modulus = 1e8, k_soft_modulus = 1e6;  // [Pa]
constexpr double k_short = 0.004, k_end = 1.0;                 // [s]
constexpr double k_average_from = 0.3, k_batch = 0.1;          // [s], when the lattice has broken up; of each mean that shows the scatter

constexpr const char* k_bed_probe =
    "{ bed { type surfaceFieldValue; libs (\"libfieldFunctionObjects.so\"); writeFields no; log no; regionType patch; name bottom; "
    "operation "
    "areaAverage; fields (p); } }";

struct Bed {
    std::vector<Vec3> particles;
    double modulus = 0.0;
    double end_time = 0.0;
};

struct Result {
    double core_s = 0.0;
    double pressure_drop = 0.0;   ///< mean from k_average_from on [Pa]; 0 when the run ended before
    double standard_error = 0.0;  ///< of the mean [Pa]
};

/// A cubic lattice near the void fraction at which Ergun's law carries it, on the floor.
std::vector<Vec3> lattice() {
    std::vector<Vec3> particles;
    for (int k = 0; k < k_columns[2]; ++k)
        for (int j = 0; j < k_columns[1]; ++j)
            for (int i = 0; i < k_columns[0]; ++i)
                particles.emplace_back(k_spacing * Vec3(i - 0.5 * (k_columns[0] - 1), j - 0.5 * (k_columns[1] - 1), k + 0.5));
    return particles;
}

double weight_over_area(const Bed& bed) {
    const double volume = k_pi / 6.0 * std::pow(k_diameter, 3) * static_cast<double>(bed.particles.size());
    return (k_density - k_air_density) * k_gravity * volume / (4.0 * k_half_depth * k_half_width);
}

void make_mesh(const fs::path& folder) {
    const auto corners = [](double z) {
        return fmt::format("({0} {2} {4}) ({1} {2} {4}) ({1} {3} {4}) ({0} {3} {4})", -k_half_depth, k_half_depth, -k_half_width,
                           k_half_width, z);
    };
    write_foam_dictionary(
        folder, "system/blockMeshDict", "dictionary",
        fmt::format("scale 1;\nvertices ( {} {} );\nblocks ( hex (0 1 2 3 4 5 6 7) (2 15 45) simpleGrading (1 1 1) );\nedges ();\n"
                    "boundary\n(\n    top {{ type wall; faces ((4 5 6 7)); }}\n    bottom {{ type wall; faces ((0 1 2 3)); }}\n"
                    "    walls {{ type wall; faces ((0 1 5 4) (2 3 7 6)); }}\n"
                    "    frontAndBack {{ type symmetry; faces ((1 2 6 5) (3 0 4 7)); }}\n);",
                    corners(0.0), corners(k_height)));
    run_in_case(folder, {"blockMesh"});
}

/// What the probe of the bottom wrote from `from` on, averaged over time.
postproc::TimeAverage average_at_bottom(const fs::path& folder, double from, double to) {
    std::istringstream text(read_file(folder / "postProcessing/bed/0/surfaceFieldValue.dat"));
    std::vector<double> times, values;
    for (std::string line; std::getline(text, line);) {
        double time = 0.0, value = 0.0;
        if (std::sscanf(line.c_str(), "%lf %lf", &time, &value) != 2) continue;
        times.push_back(time);
        values.push_back(value);
    }
    return postproc::time_average(times, values, from, to, k_batch).value();
}

/// \param offset  of the program's p [m2/s2]
Result result_of(const fs::path& folder, const Bed& bed, double core_s, double offset) {
    if (bed.end_time <= k_average_from) return {core_s, 0.0, 0.0};
    const postproc::TimeAverage average = average_at_bottom(folder, k_average_from, bed.end_time);
    return {core_s, k_air_density * (average.mean - offset), k_air_density * average.standard_error.value()};
}

Result run_dpm_foam(const fs::path& folder, const Bed& bed) {
    fs::create_directories(folder.parent_path());
    fs::copy(tutorial(), folder, fs::copy_options::recursive);
    make_mesh(folder);
    std::string positions = "(\n";
    for (const Vec3& p : bed.particles) positions += fmt::format("({} {} {})\n", p.x(), p.y(), p.z());
    write_foam_dictionary(folder, "constant/kinematicCloudPositions", "vectorField", positions + ")");
    for (const char* key :
         {"constantProperties/youngsModulus", "subModels/pairCollisionCoeffs/wallSpringSliderDashpotCoeffs/youngsModulus"})
        run_in_case(folder, {"foamDictionary", "-entry", key, "-set", fmt::format("{}", bed.modulus), "constant/kinematicCloudProperties"});
    write_foam_dictionary(
        folder, "system/controlDict", "dictionary",
        fmt::format(
            "application DPMFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {0}; deltaT 2e-5; writeControl runTime; "
            "writeInterval {0}; writeFormat binary; writePrecision 6; timePrecision 6; runTimeModifiable no; functions {1}",
            bed.end_time, k_bed_probe));
    const double air_column = k_gravity * k_height;  // over the density, as the program's p
    return result_of(folder, bed, require_child(meshing::foam_command(folder, "DPMFoam")).core_s, air_column);
}

void write_dem_walls(const fs::path& file) {
    const double x = k_half_depth + 0.5 * k_diameter, y = k_half_width;
    const std::array<std::pair<double, double>, 4> corner = {{{-x, -y}, {x, -y}, {x, y}, {-x, y}}};
    std::string text = "solid sides\n";
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& [ax, ay] = corner[i];
        const auto& [bx, by] = corner[(i + 1) % 4];
        const auto vertex = [](double px, double py, double pz) { return fmt::format("vertex {} {} {}\n", px, py, pz); };
        text += "facet normal 0 0 0\nouter loop\n" + vertex(ax, ay, 0) + vertex(ax, ay, k_height) + vertex(bx, by, k_height) +
                "endloop\nendfacet\n";
        text +=
            "facet normal 0 0 0\nouter loop\n" + vertex(ax, ay, 0) + vertex(bx, by, k_height) + vertex(bx, by, 0) + "endloop\nendfacet\n";
    }
    write_file(file, text + "endsolid sides\n");
}

void write_cutter_case(const fs::path& folder, const Bed& bed) {
    write_foam_dictionary(folder, "constant/g", "uniformDimensionedVectorField", "dimensions [0 1 -2 0 0 0 0]; value (0 0 -9.81);");
    write_foam_dictionary(folder, "constant/transportProperties", "dictionary", "transportModel Newtonian; nu 1e-5; rho 1.2;");
    write_foam_dictionary(folder, "constant/turbulenceProperties", "dictionary", "simulationType laminar;");
    write_foam_dictionary(folder, "constant/dynamicMeshDict", "dictionary", "dynamicFvMesh staticFvMesh;");
    write_foam_dictionary(folder, "constant/couplingProperties", "dictionary",
                          fmt::format("rock\n{{\n    feed \"constant/rockFeed.csv\";\n"
                                      "    contact {{ youngsModulus {}; poissonRock 0.35; poissonSteel 0.23; wetRestitution false; "
                                      "timeStepFraction 0.1; maxSpeed 1.5;\n"
                                      "        pairs {{ rock_rock {{ friction 0.10; restitution 0.97; rollingFriction 0; }}\n"
                                      "                rock_steel {{ friction 0.10; restitution 0.97; rollingFriction 0; }} }} }}\n"
                                      "    walls ( {{ name sides; file \"constant/sides.stl\"; rotating false; }} );\n"
                                      "    domain {{ type cylinder; radius {}; zMin 0; zMax {}; walls (zMin zMax); }}\n}}\n"
                                      "closures {{ drag brown_lawler; hindrance di_felice; addedMass 0.5; }}\n",
                                      bed.modulus, 1.05 * std::hypot(k_half_depth, k_half_width), k_height));
    write_dem_walls(folder / "constant/sides.stl");
    std::string feed = "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3,vx_m_s,vy_m_s,vz_m_s\n";
    for (std::size_t i = 0; i < bed.particles.size(); ++i) {
        const Vec3& p = bed.particles[i];
        feed += fmt::format("{},0,{},{},{},{},{},0,0,0\n", i + 1, p.x(), p.y(), p.z(), k_diameter, k_density);
    }
    write_file(folder / "constant/rockFeed.csv", feed);
    write_foam_dictionary(
        folder, "system/controlDict", "dictionary",
        fmt::format(
            "application cutterFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {0}; deltaT 1e-4; adjustTimeStep yes; maxCo "
            "0.9; maxDeltaT 1e-3; writeControl adjustable; writeInterval {0}; writeFormat binary; writePrecision 9; timePrecision 9; "
            "runTimeModifiable no; functions {1}",
            bed.end_time, k_bed_probe));
    write_foam_dictionary(folder, "system/fvSchemes", "dictionary",
                          "ddtSchemes { default Euler; } gradSchemes { default Gauss linear; } divSchemes { default none; div(phi,U) Gauss "
                          "linearUpwindV unlimited; "
                          "div((nuEff*dev2(T(grad(U))))) Gauss linear; } laplacianSchemes { default Gauss linear corrected; } "
                          "interpolationSchemes { default linear; } "
                          "snGradSchemes { default corrected; }");
    write_foam_dictionary(folder, "system/fvSolution", "dictionary",
                          "solvers { p { solver GAMG; smoother GaussSeidel; tolerance 1e-6; relTol 0.01; } pFinal { $p; relTol 0; } "
                          "\"U.*\" { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-5; relTol 0; } } "
                          "PIMPLE { nOuterCorrectors 1; nCorrectors 2; nNonOrthogonalCorrectors 0; pRefCell 0; pRefValue 0; }");
    write_foam_dictionary(folder, "0/p", "volScalarField",
                          "dimensions [0 2 -2 0 0 0 0]; internalField uniform 0; boundaryField { \"(walls|bottom)\" { type "
                          "fixedFluxPressure; value uniform 0; } top { "
                          "type fixedValue; value uniform 0; } frontAndBack { type symmetry; } }");
    write_foam_dictionary(folder, "0/U", "volVectorField",
                          "dimensions [0 1 -1 0 0 0 0]; internalField uniform (0 0 0); boundaryField { walls { type noSlip; } top { type "
                          "pressureInletOutletVelocity; "
                          "value uniform (0 0 0); } bottom { type interstitialInletVelocity; inletVelocity uniform (0 0 1.875); value "
                          "uniform (0 0 1.875); phi phi; "
                          "alpha voidFraction; } frontAndBack { type symmetry; } }");
    make_mesh(folder);
}

Result run_cutter_foam_bed(const fs::path& folder, const Bed& bed) {
    write_cutter_case(folder, bed);
    return result_of(folder, bed, require_child(meshing::foam_command(folder, cutter_foam())).core_s, 0.0);
}

void run(Verification& verification) {
    if (!verification.wants(Effort::longest)) return;
    if (!fs::exists(tutorial()))
        throw UserError(fmt::format("{} is not there", tutorial().string()), "The bed is the one of OpenFOAM's tutorial",
                        "Run ./bootstrap, which fetches OpenFOAM's source");
    Bed bed{lattice(), k_stock_modulus, k_short};
    {
        const Result ours = run_cutter_foam_bed(verification.folder("cutterFoam_stock"), bed);
        const Result stock = run_dpm_foam(verification.folder("DPMFoam_stock"), bed);
        verification.report("core seconds per simulated second with 100 MPa, DPMFoam", "-", stock.core_s / k_short, {},
                            {"exact", "first 4 ms", {}});
        verification.report("core seconds per simulated second with 100 MPa, cutterFoam", "-", ours.core_s / k_short, {},
                            {"exact", "first 4 ms", {}});
        verification.report("times faster than DPMFoam with 100 MPa", "-", stock.core_s / ours.core_s, {}, {"exact", "first 4 ms", {}});
    }
    bed.modulus = k_soft_modulus;
    bed.end_time = k_end;
    const Result ours = run_cutter_foam_bed(verification.folder("cutterFoam"), bed);
    const double weight = weight_over_area(bed);
    const auto about = [&](const Result& result) -> About {
        return {
            "exact",
            fmt::format(
                "mean of {} to {} s, its standard error {:.2g} %; the reference is the bed's weight less buoyancy over its cross section",
                k_average_from, k_end, 100.0 * result.standard_error / weight),
            {}};
    };
    verification.relative("bed pressure drop, cutterFoam", "Pa", ours.pressure_drop, weight, 0.03, about(ours));
    const Result stock = run_dpm_foam(verification.folder("DPMFoam"), bed);
    verification.relative("bed pressure drop, DPMFoam", "Pa", stock.pressure_drop, weight, 0.03, about(stock));
    verification.report("core seconds per simulated second, DPMFoam", "-", stock.core_s / k_end, {}, {"exact", "1 MPa", {}});
    verification.report("core seconds per simulated second, cutterFoam", "-", ours.core_s / k_end, {}, {"exact", "1 MPa", {}});
    verification.at_least("times faster than DPMFoam", "-", stock.core_s / ours.core_s, 10.0,
                          {"exact", "1 MPa in both; one core each, in turn", {}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
