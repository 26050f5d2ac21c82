#include "validation/harness/scenes/annulus_case.hpp"

#include <array>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "cases/scenes/cutter/flow_dictionaries.hpp"
#include "geometry/base/axis_frame.hpp"
#include "validation/harness/scenes/box_case.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

// The blocks of a zone begin at this azimuth and follow each other by quarters.
constexpr double k_first_azimuth = 0.25 * k_pi;
constexpr int k_circles = 4;  // inner wall, interface twice, outer wall
constexpr int k_level = 4 * k_circles;

struct Zone {
    const char* name;
    int circle;           ///< its inner one
    double inner, outer;  ///< radii [m]
    double growth;        ///< last cell over first, outwards
    int around;
    double speed;
};

std::array<Zone, 2> zones_of(const AnnulusCase& a) {
    return {{{"rotor", 0, a.inner, a.interface, 1.0 / a.grading, a.rotor_cells_around, a.rotor_speed},
             {"stator", 2, a.interface, a.outer, a.grading, a.stator_cells_around, 0.0}}};
}

/// Radii of the cells' bounds: a geometric series, as blockMesh makes it.
std::vector<double> radii_of(const Zone& zone, int cells) {
    const double ratio = cells > 1 ? std::pow(zone.growth, 1.0 / (cells - 1)) : 1.0;
    std::vector<double> radii{zone.inner};
    double size = 1.0, sum = 0.0;
    for (int i = 0; i < cells; ++i, size *= ratio) sum += size;
    size = (zone.outer - zone.inner) / sum;
    for (int i = 0; i < cells; ++i, size *= ratio) radii.push_back(radii.back() + size);
    return radii;
}

std::string vertices(const AnnulusCase& a) {
    std::string text;
    for (const double z : {-0.5 * a.height, 0.5 * a.height})
        for (const double radius : {a.inner, a.interface, a.interface, a.outer})
            for (int k = 0; k < 4; ++k) {
                const double azimuth = k_first_azimuth + 0.5 * k_pi * k;
                text += fmt::format("({:.17g} {:.17g} {:.17g})\n", radius * std::cos(azimuth), radius * std::sin(azimuth), z);
            }
    return text;
}

std::string edges(const AnnulusCase& a) {
    const std::array<double, k_circles> radii{a.inner, a.interface, a.interface, a.outer};
    std::string text;
    for (int level = 0; level < 2; ++level)
        for (int circle = 0; circle < k_circles; ++circle)
            for (int k = 0; k < 4; ++k) {
                const int first = level * k_level + 4 * circle;
                const double azimuth = k_first_azimuth + 0.5 * k_pi * (k + 0.5);
                text += fmt::format("arc {} {} ({:.17g} {:.17g} {:.17g})\n", first + k, first + (k + 1) % 4,
                                    radii[circle] * std::cos(azimuth), radii[circle] * std::sin(azimuth), (level - 0.5) * a.height);
            }
    return text;
}

std::string circle_faces(int circle) {
    std::string text;
    for (int k = 0; k < 4; ++k) {
        const int a = 4 * circle + k, b = 4 * circle + (k + 1) % 4;
        text += fmt::format("({} {} {} {}) ", a, b, b + k_level, a + k_level);
    }
    return text;
}

std::string block_mesh(const AnnulusCase& annulus) {
    std::string blocks, ends;
    for (const Zone& zone : zones_of(annulus))
        for (int k = 0; k < 4; ++k) {
            const int a = 4 * zone.circle + k, b = a + 4, c = 4 * zone.circle + 4 + (k + 1) % 4, d = c - 4;
            blocks += fmt::format("hex ({} {} {} {} {} {} {} {}) {} ({} {} 1) simpleGrading ({:.17g} 1 1)\n", a, b, c, d, a + k_level,
                                  b + k_level, c + k_level, d + k_level, zone.name, annulus.radial_cells, zone.around, zone.growth);
            for (const int level : {0, k_level}) ends += fmt::format("({} {} {} {}) ", a + level, b + level, c + level, d + level);
        }
    const auto interface = [](const char* name, const char* other, int circle) {
        return fmt::format("{} {{ type cyclicAMI; neighbourPatch {}; transform noOrdering; faces ({}); }}\n", name, other,
                           circle_faces(circle));
    };
    return fmt::format(
        "scale 1;\nvertices\n({});\nedges\n({});\nblocks\n({});\nboundary\n(\n"
        "    hub {{ type wall; faces ({}); }}\n    rim {{ type wall; faces ({}); }}\n    ends {{ type empty; faces ({}); }}\n    {}    "
        "{});\n"
        "mergePatchPairs ();",
        vertices(annulus), edges(annulus), blocks, circle_faces(0), circle_faces(3), ends,
        interface("rotor_interface", "stator_interface", 1), interface("stator_interface", "rotor_interface", 2));
}

std::string wall_velocity(double speed) {
    return fmt::format("type rotatingWallVelocity; origin (0 0 0); axis (0 0 1); omega {:.17g}; value uniform (0 0 0);", speed);
}

std::string start_velocity(const AnnulusCase& annulus) {
    std::string values;
    for (const Vec3& x : annulus_cells(annulus, 0.0).centre) {
        const double radius = std::hypot(x.x(), x.y()), velocity = annulus.start(radius);
        values += fmt::format("({:.17g} {:.17g} 0)\n", -velocity * x.y() / radius, velocity * x.x() / radius);
    }
    return fmt::format("nonuniform List<vector>\n{}\n(\n{})\n", annulus.cell_count(), values);
}

void write_fields(const fs::path& folder, const AnnulusCase& annulus) {
    const char* const constraints = "#includeEtc \"caseDicts/setConstraintTypes\"\n";
    write_foam_dictionary(
        folder, "0/U", "volVectorField",
        fmt::format("dimensions [0 1 -1 0 0 0 0];\ninternalField {};\nboundaryField\n{{\n{}    hub {{ {} }}\n    rim {{ {} }}\n}}",
                    start_velocity(annulus), constraints, wall_velocity(annulus.inner_speed), wall_velocity(annulus.outer_speed)));
    write_foam_dictionary(
        folder, "0/p", "volScalarField",
        fmt::format("dimensions [0 2 -2 0 0 0 0];\ninternalField uniform 0;\nboundaryField\n{{\n{}    \"(hub|rim)\" {{ type "
                    "fixedFluxPressure; value uniform 0; }}\n}}",
                    constraints));
}

void write_constant(const fs::path& folder, const AnnulusCase& annulus) {
    write_foam_dictionary(folder, "constant/transportProperties", "dictionary",
                          fmt::format("transportModel Newtonian;\nnu {:.17g};\nrho {:.17g};", annulus.viscosity, annulus.density));
    write_foam_dictionary(folder, "constant/turbulenceProperties", "dictionary", "simulationType laminar;");
    write_foam_dictionary(
        folder, "constant/dynamicMeshDict", "dictionary",
        annulus.rotor_speed == 0.0
            ? "dynamicFvMesh staticFvMesh;"
            : fmt::format("dynamicFvMesh dynamicMotionSolverFvMesh;\nmotionSolverLibs (fvMotionSolvers);\nmotionSolver solidBody;\n"
                          "solidBodyCoeffs\n{{\n    cellZone rotor;\n    solidBodyMotionFunction rotatingMotion;\n"
                          "    rotatingMotionCoeffs {{ origin (0 0 0); axis (0 0 1); omega {:.17g}; }}\n}}",
                          annulus.rotor_speed));
}

/// The pressure's reference is a place, because cell 0 is another cell on each number of ranks.
std::string pressure_reference(const AnnulusCase& annulus) {
    const double radius = 0.3 * annulus.interface + 0.7 * annulus.outer;
    return fmt::format("pRefPoint ({:.17g} {:.17g} 0); pRefValue 0;", radius * std::cos(0.01), radius * std::sin(0.01));
}

void write_study_schemes(const fs::path& folder, const AnnulusCase& annulus) {
    cases::CaseInputs inputs(geometry::Contour({0.0, annulus.height}, {annulus.inner, annulus.inner}, annulus.inner, annulus.height));
    inputs.numerics.convection = *annulus.study;
    inputs.rotor.speed = 1.0;  // acts on the controlDict alone
    for (const cases::FoamFile& file : cases::run_system_files(inputs))
        if (file.path != "system/controlDict") meshing::write_foam_file(folder / file.path, file.foam_class, file.contents);
    std::ofstream(folder / "system/fvSolution", std::ios::app) << "PIMPLE { " << pressure_reference(annulus) << " }\n";
}

/// Euler would be of first order. Two outer correctors: the first one convects by the flux before the step.
void write_second_order_schemes(const fs::path& folder, const AnnulusCase& annulus) {
    write_foam_dictionary(folder, "system/fvSchemes", "dictionary",
                          "ddtSchemes { default backward; }\ngradSchemes { default Gauss linear; }\ndivSchemes\n{\n    default none;\n"
                          "    div(phi,U) Gauss linear;\n    div((nuEff*dev2(T(grad(U))))) Gauss linear;\n}\n"
                          "laplacianSchemes { default Gauss linear corrected; }\ninterpolationSchemes { default linear; }\n"
                          "snGradSchemes { default corrected; }");
    write_foam_dictionary(folder, "system/fvSolution", "dictionary",
                          "solvers\n{\n    \"p.*\" { solver PBiCGStab; preconditioner DIC; tolerance 1e-11; relTol 0; }\n"
                          "    \"U.*\" { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-12; relTol 0; maxIter 200; }\n}\n"
                          "PIMPLE { nOuterCorrectors 2; nCorrectors 2; nNonOrthogonalCorrectors 0; " +
                              pressure_reference(annulus) + " }");
}

void write_system(const fs::path& folder, const AnnulusCase& annulus) {
    write_foam_dictionary(folder, "system/blockMeshDict", "dictionary", block_mesh(annulus));
    if (annulus.study)
        write_study_schemes(folder, annulus);
    else
        write_second_order_schemes(folder, annulus);
    write_foam_dictionary(
        folder, "system/controlDict", "dictionary",
        fmt::format("application cutterFoam;\nstartFrom latestTime;\nstartTime 0;\nstopAt endTime;\nendTime {:.17g};\ndeltaT {:.17g};\n"
                    "adjustTimeStep no;\nwriteControl adjustable;\nwriteInterval {:.17g};\nwriteFormat ascii;\nwritePrecision 17;\n"
                    "timePrecision 12;\nrunTimeModifiable no;",
                    annulus.end_time, annulus.time_step, std::min(annulus.write_interval, annulus.end_time)));
}

}  // namespace

void write_annulus_case(const fs::path& folder, const AnnulusCase& annulus) {
    write_system(folder, annulus);
    write_constant(folder, annulus);
    write_fields(folder, annulus);
    run_in_case(folder, {"blockMesh"});
}

void run_annulus_case(const fs::path& folder, int ranks) {
    if (ranks > 1) {
        write_foam_dictionary(folder, "system/decomposeParDict", "dictionary",
                              fmt::format("numberOfSubdomains {};\nmethod simple;\nsimpleCoeffs {{ n ({} {} 1); delta 0.001; }}", ranks,
                                          ranks > 2 ? ranks / 2 : ranks, ranks > 2 ? 2 : 1));
        run_in_case(folder, {"decomposePar"});
    }
    run_cutter_foam(folder, ranks);
    if (ranks > 1) run_in_case(folder, {"reconstructPar", "-latestTime", "-fields", "(U p)"});
}

AnnulusCells annulus_cells(const AnnulusCase& annulus, double time) {
    AnnulusCells cells;
    for (const Zone& zone : zones_of(annulus)) {
        const std::vector<double> radii = radii_of(zone, annulus.radial_cells);
        const double half = 0.25 * k_pi / zone.around;  // of a cell's azimuth
        for (int j = 0; j < 4 * zone.around; ++j)
            for (int i = 0; i < annulus.radial_cells; ++i) {
                // A trapezium between two chords: their lengths and distances from the axis.
                const double a = 2.0 * radii[i] * std::sin(half), b = 2.0 * radii[i + 1] * std::sin(half);
                const double from = radii[i] * std::cos(half), to = radii[i + 1] * std::cos(half);
                const double radius = from + (to - from) / 3.0 * (a + 2.0 * b) / (a + b);
                const double azimuth = k_first_azimuth + half * (2 * j + 1) + zone.speed * time;
                cells.centre.emplace_back(radius * std::cos(azimuth), radius * std::sin(azimuth), 0.0);
                cells.volume.push_back(0.5 * (a + b) * (to - from) * annulus.height);
            }
    }
    return cells;
}

}  // namespace cutterflow::validation
