/// \file The same bed in stock DPMFoam and in cutterFoam: pressure drop against the bed's weight, and time against time.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
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
constexpr double k_diameter = 0.0025, k_density = 2526.0, k_air_density = 1.2, k_viscosity = 1e-5, k_gravity = 9.81;
constexpr double k_half_depth = 0.0075, k_half_width = 0.0375, k_height = 0.225;
constexpr std::array<int, 3> k_columns = {5, 28, 43};

constexpr double k_stock_modulus = 1e8, k_soft_modulus = 1e6;  // [Pa]
constexpr double k_packing_modulus = 5e7;                      // [Pa]
constexpr double k_settling = 0.2;                             // [s], in which the spheres come to rest
constexpr double k_swollen = 1.01;                   // diameter of the spheres that settle over theirs: at rest none overlaps another
constexpr double k_end = 0.3, k_average_from = 0.1;  // [s], of the fluidised bed
constexpr double k_batch = 0.02;                     // [s], of each mean that shows the scatter
constexpr double k_expansion = 1.05;                 // of the packing's height, so that its spheres float apart

constexpr const char* k_bed_probe =
    "{ bed { type surfaceFieldValue; libs (\"libfieldFunctionObjects.so\"); writeFields no; log no; regionType patch; name bottom; "
    "operation "
    "areaAverage; fields (p); } }";

struct Bed {
    std::vector<Vec3> particles;
    double air_speed = 0.0;  ///< of the empty box [m/s]
    double modulus = 0.0;    ///< Young's [Pa]
};

struct Result {
    double core_s = 0.0;
    double pressure_drop = 0.0;   ///< mean from k_average_from on [Pa]
    double standard_error = 0.0;  ///< of the mean [Pa]
};

/// A cubic lattice whose places are shifted by up to 0.02 of a diameter, so that it falls into a random packing.
std::vector<Vec3> loose_lattice() {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> shift(-0.02 * k_diameter, 0.02 * k_diameter);
    constexpr double spacing = 1.06 * k_diameter;
    std::vector<Vec3> particles;
    for (int k = 0; k < k_columns[2]; ++k)
        for (int j = 0; j < k_columns[1]; ++j)
            for (int i = 0; i < k_columns[0]; ++i)
                particles.emplace_back(spacing * Vec3(i - 0.5 * (k_columns[0] - 1), j - 0.5 * (k_columns[1] - 1), k + 0.5) +
                                       Vec3(shift(random), shift(random), shift(random)));
    return particles;
}

std::string feed_of(const std::vector<Vec3>& particles, double diameter) {
    std::string feed = "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3,vx_m_s,vy_m_s,vz_m_s\n";
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const Vec3& p = particles[i];
        feed += fmt::format("{},0,{},{},{},{},{},0,0,0\n", i + 1, p.x(), p.y(), p.z(), diameter, k_density);
    }
    return feed;
}

std::string dem_domain() {
    return fmt::format("domain {{ type box; lower ({} {} 0); upper ({} {} {}); walls (xMin xMax yMin yMax zMin zMax); }}", -k_half_depth,
                       -k_half_width, k_half_depth, k_half_width, k_height);
}

std::string contact(double modulus, double restitution) {
    return fmt::format(
        "contact {{ youngsModulus {0}; poissonRock 0.35; poissonSteel 0.23; wetRestitution false; timeStepFraction 0.1; maxSpeed 1.5; "
        "pairs {{ rock_rock {{ friction 0.10; restitution {1}; rollingFriction 0; }} "
        "rock_steel {{ friction 0.10; restitution {1}; rollingFriction 0; }} }} }}",
        modulus, restitution);
}

/// A random packing that is stretched along z. The spheres were dropped without air, with a restitution that calms them.
std::vector<Vec3> expanded_packing(const fs::path& folder) {
    write_foam_dictionary(folder, "constant/g", "uniformDimensionedVectorField", "dimensions [0 1 -2 0 0 0 0]; value (0 0 -9.81);");
    write_foam_dictionary(
        folder, "constant/couplingProperties", "dictionary",
        fmt::format("medium none;\nrock {{ feed \"constant/rockFeed.csv\"; {} {} }}\n", contact(k_packing_modulus, 0.2), dem_domain()));
    write_file(folder / "constant/rockFeed.csv", feed_of(loose_lattice(), k_swollen * k_diameter));
    write_foam_dictionary(folder, "system/controlDict", "dictionary",
                          fmt::format("application cutterFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {0}; deltaT 1e-3; "
                                      "writeControl adjustable; writeInterval {0}; runTimeModifiable no;",
                                      k_settling));
    run_cutter_foam(folder);
    std::vector<Vec3> particles = last_rocks(folder).position;
    for (Vec3& p : particles) p.z() *= k_expansion;
    return particles;
}

double sphere_volume() {
    return k_pi / 6.0 * std::pow(k_diameter, 3);
}

/// Void fraction of the middle half of a packing [-].
double void_fraction_of(const std::vector<Vec3>& particles) {
    std::vector<double> heights;
    for (const Vec3& p : particles) heights.push_back(p.z());
    std::sort(heights.begin(), heights.end());
    const std::size_t n = heights.size();
    const double height = heights[3 * n / 4] - heights[n / 4];
    const double area = 4.0 * k_half_depth * k_half_width;
    return 1.0 - sphere_volume() * static_cast<double>(n / 2) / (area * height);
}

/// Superficial speed [m/s] at which Ergun's pressure drop carries a packing:
/// 150 (1 - a)/a^3 Re + 1.75/a^3 Re^2 = Ar, Ar = (rho_s/rho - 1) g d^3/nu^2. [Gidaspow1994]
double minimum_fluidising_speed(double void_fraction) {
    const double archimedes = (k_density / k_air_density - 1.0) * k_gravity * std::pow(k_diameter, 3) / (k_viscosity * k_viscosity);
    const double cube = std::pow(void_fraction, 3);
    const double linear = 150.0 * (1.0 - void_fraction) / cube, square = 1.75 / cube;
    const double reynolds = (std::sqrt(linear * linear + 4.0 * square * archimedes) - linear) / (2.0 * square);
    return reynolds * k_viscosity / k_diameter;
}

double weight_over_area(const Bed& bed) {
    const double volume = sphere_volume() * static_cast<double>(bed.particles.size());
    return (k_density - k_air_density) * k_gravity * volume / (4.0 * k_half_depth * k_half_width);
}

/// \param sides  type of front and back: DPMFoam knows contacts with walls alone; cutterFoam has them in the DEM, and a wall would be steel
void make_mesh(const fs::path& folder, const std::string& sides) {
    const auto corners = [](double z) {
        return fmt::format("({0} {2} {4}) ({1} {2} {4}) ({1} {3} {4}) ({0} {3} {4})", -k_half_depth, k_half_depth, -k_half_width,
                           k_half_width, z);
    };
    write_foam_dictionary(
        folder, "system/blockMeshDict", "dictionary",
        fmt::format("scale 1;\nvertices ( {0} {1} );\nblocks ( hex (0 1 2 3 4 5 6 7) (2 15 45) simpleGrading (1 1 1) );\nedges ();\n"
                    "boundary\n(\n    top {{ type wall; faces ((4 5 6 7)); }}\n    bottom {{ type wall; faces ((0 1 2 3)); }}\n"
                    "    walls {{ type wall; faces ((0 1 5 4) (2 3 7 6)); }}\n"
                    "    frontAndBack {{ type {2}; faces ((1 2 6 5) (3 0 4 7)); }}\n);",
                    corners(0.0), corners(k_height), sides));
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
Result result_of(const fs::path& folder, double core_s, double offset) {
    const postproc::TimeAverage average = average_at_bottom(folder, k_average_from, k_end);
    return {core_s, k_air_density * (average.mean - offset), k_air_density * average.standard_error.value()};
}

Result run_dpm_foam(const fs::path& folder, const Bed& bed) {
    fs::create_directories(folder.parent_path());
    fs::copy(tutorial(), folder, fs::copy_options::recursive);
    make_mesh(folder, "wall");
    std::string positions = "(\n";
    for (const Vec3& p : bed.particles) positions += fmt::format("({} {} {})\n", p.x(), p.y(), p.z());
    write_foam_dictionary(folder, "constant/kinematicCloudPositions", "vectorField", positions + ")");
    for (const char* key :
         {"constantProperties/youngsModulus", "subModels/pairCollisionCoeffs/wallSpringSliderDashpotCoeffs/youngsModulus"})
        run_in_case(folder, {"foamDictionary", "-entry", key, "-set", fmt::format("{}", bed.modulus), "constant/kinematicCloudProperties"});
    run_in_case(folder, {"foamDictionary", "-entry", "boundaryField/frontAndBack/type", "-set", "slip", "0/U.air"});
    run_in_case(folder, {"foamDictionary", "-entry", "boundaryField/frontAndBack/type", "-set", "zeroGradient", "0/p"});
    run_in_case(folder, {"foamDictionary", "-entry", "boundaryField/bottom/inletVelocity", "-set",
                         fmt::format("uniform (0 0 {})", bed.air_speed), "0/U.air"});
    write_foam_dictionary(
        folder, "system/controlDict", "dictionary",
        fmt::format(
            "application DPMFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {0}; deltaT 2e-5; writeControl runTime; "
            "writeInterval {0}; writeFormat binary; writePrecision 6; timePrecision 6; runTimeModifiable no; functions {1}",
            k_end, k_bed_probe));
    const double air_column = k_gravity * k_height;  // over the density, as the program's p
    return result_of(folder, require_child(meshing::foam_command(folder, "DPMFoam")).core_s, air_column);
}

void write_cutter_case(const fs::path& folder, const Bed& bed) {
    write_foam_dictionary(folder, "constant/g", "uniformDimensionedVectorField", "dimensions [0 1 -2 0 0 0 0]; value (0 0 -9.81);");
    write_foam_dictionary(folder, "constant/transportProperties", "dictionary", "transportModel Newtonian; nu 1e-5; rho 1.2;");
    write_foam_dictionary(folder, "constant/turbulenceProperties", "dictionary", "simulationType laminar;");
    write_foam_dictionary(folder, "constant/dynamicMeshDict", "dictionary", "dynamicFvMesh staticFvMesh;");
    write_foam_dictionary(folder, "constant/couplingProperties", "dictionary",
                          fmt::format("rock {{ feed \"constant/rockFeed.csv\"; {} {} }}\n"
                                      "closures {{ drag gidaspow; hindrance none; addedMass 0; }}\n",
                                      contact(bed.modulus, 0.97), dem_domain()));
    write_file(folder / "constant/rockFeed.csv", feed_of(bed.particles, k_diameter));
    write_foam_dictionary(
        folder, "system/controlDict", "dictionary",
        fmt::format(
            "application cutterFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {0}; deltaT 1e-4; adjustTimeStep yes; maxCo "
            "0.9; maxDeltaT 1e-3; writeControl adjustable; writeInterval {0}; writeFormat binary; writePrecision 9; timePrecision 9; "
            "runTimeModifiable no; functions {1}",
            k_end, k_bed_probe));
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
                          "dimensions [0 2 -2 0 0 0 0]; internalField uniform 0; boundaryField { \"(walls|bottom|frontAndBack)\" { type "
                          "fixedFluxPressure; value uniform 0; } top { "
                          "type fixedValue; value uniform 0; } }");
    write_foam_dictionary(folder, "0/U", "volVectorField",
                          "dimensions [0 1 -1 0 0 0 0]; internalField uniform (0 0 0); boundaryField { walls { type noSlip; } top { type "
                          "pressureInletOutletVelocity; "
                          "value uniform (0 0 0); } bottom { type interstitialInletVelocity; inletVelocity uniform (0 0 " +
                              fmt::format("{0}); value uniform (0 0 {0})", bed.air_speed) +
                              "; phi phi; alpha voidFraction; } frontAndBack { type slip; } }");
    make_mesh(folder, "patch");
}

Result run_cutter_foam_bed(const fs::path& folder, const Bed& bed) {
    write_cutter_case(folder, bed);
    return result_of(folder, require_child(meshing::foam_command(folder, cutter_foam())).core_s, 0.0);
}

/// What is required at one Young's modulus.
struct Bout {
    const char* name;
    double modulus;         ///< [Pa]
    double required_ratio;  ///< DPMFoam's core seconds over ours
};

void compare(Verification& verification, Bed bed, const Bout& bout) {
    bed.modulus = bout.modulus;
    const double weight = weight_over_area(bed);
    const auto check = [&](const char* program, const Result& result) {
        const std::string of = fmt::format(", {}, {}", bout.name, program);
        const About about{
            "exact",
            fmt::format("{} to {} s; the reference is the bed's weight less buoyancy over its cross section", k_average_from, k_end),
            {}};
        verification.relative("bed pressure drop" + of, "Pa", result.pressure_drop, weight, 0.03, about);
        verification.at_most("standard error of the pressure drop over the weight" + of, "-", result.standard_error / weight, 0.03,
                             {"exact", fmt::format("batches of {} s", k_batch), {}});
        verification.report("core seconds per simulated second" + of, "-", result.core_s / k_end, {}, {"exact", {}, {}});
    };
    const std::string of = fmt::format("_{:g}MPa", 1e-6 * bout.modulus);
    const Result ours = run_cutter_foam_bed(verification.folder("cutterFoam" + of), bed);
    check("cutterFoam", ours);
    const Result stock = run_dpm_foam(verification.folder("DPMFoam" + of), bed);
    check("DPMFoam", stock);
    verification.at_least(fmt::format("times faster than DPMFoam, {}", bout.name), "-", stock.core_s / ours.core_s, bout.required_ratio,
                          {"exact", "one core each, in turn; the same drag law", {}});
}

void run(Verification& verification) {
    if (!verification.wants(Effort::longest)) return;
    if (!fs::exists(tutorial()))
        throw UserError(fmt::format("{} is not there", tutorial().string()), "The bed is the one of OpenFOAM's tutorial",
                        "Run ./bootstrap, which fetches OpenFOAM's source");
    Bed bed;
    bed.particles = expanded_packing(verification.folder("packing"));
    const double void_fraction = void_fraction_of(bed.particles);
    bed.air_speed = minimum_fluidising_speed(void_fraction);
    verification.report("void fraction of the bed at the start", "-", void_fraction, {}, {"exact", "the middle half of its spheres", {}});
    verification.report("speed of the air", "m/s", bed.air_speed, {},
                        {"Gidaspow1994", "at which Ergun's law carries the bed as it starts", {}});
    for (const Bout& bout : {Bout{"1 MPa", k_soft_modulus, 17.0}, Bout{"100 MPa", k_stock_modulus, 13.0}}) compare(verification, bed, bout);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
