#include "solver/foam/tests/tiny_case.hpp"

#include <mpi.h>

#include <fstream>
#include <vector>

#include <fmt/format.h>

#include "geometry/base/process/child_process.hpp"

namespace cutterflow::foam::testing {
namespace {

const char* class_of(const std::string& path) {
    if (path == "0/U") return "volVectorField";
    if (path.rfind("0/", 0) == 0) return "volScalarField";
    return "dictionary";
}

void write_file(const std::filesystem::path& folder, const std::string& path, const std::string& body) {
    const std::filesystem::path file = folder / path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << fmt::format("FoamFile {{ version 2.0; format ascii; class {}; object {}; }}\n{}\n", class_of(path),
                                       file.filename().string(), body);
}

void run_program(const std::filesystem::path& folder, const std::string& program) {
    ChildCommand command;
    command.arguments = {program, "-case", folder.string()};
    command.log = folder / ("log." + program);
    require_child(command);
}

constexpr double k_diagonal = 0.70710678118654752;

/// Four vertices at the corners of a square (azimuth 45, 135, 225, 315 degrees) at height z.
std::string corners(double radius, double z) {
    const double a = radius * k_diagonal;
    return fmt::format("({0} {0} {1}) (-{0} {0} {1}) (-{0} -{0} {1}) ({0} -{0} {1})\n", a, z);
}

/// Arcs along a circle between the four vertices that start at `first`.
std::string arcs(int first, double radius, double z) {
    const double middle[4][2] = {{0, radius}, {-radius, 0}, {0, -radius}, {radius, 0}};
    std::string text;
    for (int k = 0; k < 4; ++k)
        text += fmt::format("arc {} {} ({} {} {})\n", first + k, first + (k + 1) % 4, middle[k][0], middle[k][1], z);
    return text;
}

/// Four blocks between two rings of four vertices; `level` vertices lie between the bottom plane's numbers and the top plane's.
std::string ring_blocks(int inner, int outer, int level, const std::string& zone, int radial, int around, int high) {
    std::string text;
    for (int k = 0; k < 4; ++k) {
        const int n = (k + 1) % 4;
        text +=
            fmt::format("hex ({} {} {} {} {} {} {} {}) {} ({} {} {}) simpleGrading (1 1 1)\n", inner + k, outer + k, outer + n, inner + n,
                        inner + k + level, outer + k + level, outer + n + level, inner + n + level, zone, radial, around, high);
    }
    return text;
}

std::string cylinder_faces(int first, int level) {
    std::string text;
    for (int k = 0; k < 4; ++k) {
        const int n = (k + 1) % 4;
        text += fmt::format("({} {} {} {}) ", first + k, first + n, first + n + level, first + k + level);
    }
    return text;
}

std::string ring_end_faces(int inner, int outer, int level) {
    std::string text;
    for (const int shift : {0, level}) {
        for (int k = 0; k < 4; ++k) {
            const int n = (k + 1) % 4;
            text += fmt::format("({} {} {} {}) ", inner + k + shift, outer + k + shift, outer + n + shift, inner + n + shift);
        }
    }
    return text;
}

std::string patch(const std::string& name, const std::string& type, const std::string& faces) {
    return fmt::format("{} {{ type {}; faces ( {} ); }}\n", name, type, faces);
}

std::string interface_patches(const std::string& inner, int inner_first, const std::string& outer, int outer_first, int level) {
    const char* text = "{} {{ type cyclicAMI; neighbourPatch {}; transform noOrdering; faces ( {} ); }}\n";
    return fmt::format(text, inner, outer, cylinder_faces(inner_first, level)) +
           fmt::format(text, outer, inner, cylinder_faces(outer_first, level));
}

std::string dictionary(const std::string& vertices, const std::string& edges, const std::string& blocks, const std::string& patches) {
    return fmt::format("scale 1;\nvertices\n({}\n);\nedges\n({}\n);\nblocks\n({}\n);\nboundary\n({}\n);\nmergePatchPairs ();\n", vertices,
                       edges, blocks, patches);
}

}  // namespace

std::string block_mesh(const TurningCylinder& s) {
    constexpr int level = 16, core = 0, rotor = 4, stator = 8, rim = 12;
    std::string vertices, edges;
    for (const double z : {-0.5 * s.height, 0.5 * s.height}) {
        vertices +=
            corners(0.5 * s.radius_interface, z) + corners(s.radius_interface, z) + corners(s.radius_interface, z) + corners(s.radius, z);
    }
    for (int l = 0; l < 2; ++l) {
        const double z = (l - 0.5) * s.height;
        edges += arcs(rotor + l * level, s.radius_interface, z) + arcs(stator + l * level, s.radius_interface, z) +
                 arcs(rim + l * level, s.radius, z);
    }
    const int n = s.cells_around_quarter;
    const std::string blocks = fmt::format("hex (0 1 2 3 16 17 18 19) rotor ({} {} {}) simpleGrading (1 1 1)\n", n, n, s.cells_high) +
                               ring_blocks(core, rotor, level, "rotor", s.cells_in_rotor_ring, n, s.cells_high) +
                               ring_blocks(stator, rim, level, "stator", s.cells_in_stator, s.stator_cells_around_quarter, s.cells_high);
    const std::string patches = interface_patches("rotor_interface", rotor, "stator_interface", stator, level) +
                                patch("rim", "patch", cylinder_faces(rim, level)) +
                                patch("rotor_ends", "patch", "(0 1 2 3) (16 17 18 19) " + ring_end_faces(core, rotor, level)) +
                                patch("stator_ends", "patch", ring_end_faces(stator, rim, level));
    return dictionary(vertices, edges, blocks, patches);
}

std::string block_mesh(const TurningAnnulus& s) {
    constexpr int level = 16, hub = 0, inner = 4, outer = 8, rim = 12;
    std::string vertices, edges;
    for (int l = 0; l < 2; ++l) {
        const double z = (l - 0.5) * s.height;
        vertices += corners(s.radius_hub, z) + corners(s.radius_interface, z) + corners(s.radius_interface, z) + corners(s.radius, z);
        edges += arcs(hub + l * level, s.radius_hub, z) + arcs(inner + l * level, s.radius_interface, z) +
                 arcs(outer + l * level, s.radius_interface, z) + arcs(rim + l * level, s.radius, z);
    }
    const std::string blocks = ring_blocks(hub, inner, level, "rotor", s.cells_in_rotor, s.cells_around_quarter, s.cells_high) +
                               ring_blocks(outer, rim, level, "stator", s.cells_in_stator, s.stator_cells_around_quarter, s.cells_high);
    const std::string ends = s.plane ? "empty" : "patch";
    const std::string patches = interface_patches("rotor_interface", inner, "stator_interface", outer, level) +
                                patch("hub", "wall", cylinder_faces(hub, level)) + patch("rim", "wall", cylinder_faces(rim, level)) +
                                patch("rotor_ends", ends, ring_end_faces(hub, inner, level)) +
                                patch("stator_ends", ends, ring_end_faces(outer, rim, level));
    return dictionary(vertices, edges, blocks, patches);
}

std::string block_mesh(const Box& b) {
    std::string vertices;
    for (int i = 0; i < 8; ++i) {
        const bool x = i % 4 == 1 || i % 4 == 2, y = i % 4 >= 2, z = i >= 4;
        vertices += fmt::format("({} {} {})\n", (x ? b.upper : b.lower)[0], (y ? b.upper : b.lower)[1], (z ? b.upper : b.lower)[2]);
    }
    const std::string blocks = fmt::format("hex (0 1 2 3 4 5 6 7) ({} {} {}) simpleGrading (1 1 1)\n", b.cells[0], b.cells[1], b.cells[2]);
    const std::string x_faces = b.periodic_x ? "x_min { type cyclic; neighbourPatch x_max; faces ((0 4 7 3)); }\n"
                                               "x_max { type cyclic; neighbourPatch x_min; faces ((1 2 6 5)); }\n"
                                : b.duct     ? patch("inlet", "patch", "(0 4 7 3)") + patch("outlet", "patch", "(1 2 6 5)")
                                             : patch("x_min", "wall", "(0 4 7 3)") + patch("x_max", "wall", "(1 2 6 5)");
    const std::string patches = x_faces + patch("y_min", "wall", "(0 1 5 4)") + patch("y_max", "wall", "(3 7 6 2)") +
                                patch("z_min", "wall", "(0 3 2 1)") + patch("z_max", "wall", "(4 5 6 7)");
    return dictionary(vertices, "", blocks, patches);
}

std::string block_mesh(const ThreeRings& s) {
    constexpr int level = 24;
    const double radii[] = {0.05, 0.1, 0.1, 0.15, 0.15, 0.2};
    std::string vertices, edges, blocks, ends;
    for (const double z : {0.0, s.height})
        for (const double radius : radii) vertices += corners(radius, z);
    for (int ring = 0; ring < 6; ++ring) edges += arcs(4 * ring, radii[ring], 0.0) + arcs(4 * ring + level, radii[ring], s.height);
    for (int part = 0; part < 3; ++part) {
        const int inner = 8 * part, outer = inner + 4;
        blocks += ring_blocks(inner, outer, level, "", 5, s.cells_around_quarter[part], 1);
        ends += ring_end_faces(inner, outer, level);
    }
    const std::string patches = interface_patches("near_1", 4, "far_1", 8, level) + interface_patches("near_2", 12, "far_2", 16, level) +
                                patch("hub", "patch", cylinder_faces(0, level)) + patch("rim", "patch", cylinder_faces(20, level)) +
                                patch("ends", "patch", ends);
    return dictionary(vertices, edges, blocks, patches);
}

std::string turning(double omega) {
    return fmt::format(
        "dynamicFvMesh dynamicMotionSolverFvMesh; motionSolverLibs (fvMotionSolvers); motionSolver solidBody;\n"
        "solidBodyCoeffs {{ cellZone rotor; solidBodyMotionFunction rotatingMotion;\n"
        "rotatingMotionCoeffs {{ origin (0 0 0); axis (0 0 1); omega {:.17g}; }} }}\n",
        omega);
}

std::string volume_field(const std::string& dimensions, const std::string& internal, const std::string& boundary) {
    return fmt::format("dimensions {};\ninternalField uniform {};\nboundaryField {{ #includeEtc \"caseDicts/setConstraintTypes\"\n{} }}\n",
                       dimensions, internal, boundary);
}

TinyCase laminar_case(const std::string& name, const std::string& mesh, double time_step, double end_time) {
    TinyCase tiny;
    tiny.name = name;
    tiny.files["system/blockMeshDict"] = mesh;
    tiny.files["system/controlDict"] = fmt::format(
        "application cutterFoam; startFrom latestTime; startTime 0; stopAt endTime; endTime {}; deltaT {}; writeControl timeStep;\n"
        "writeInterval 1000000; writeFormat binary; writePrecision 12; timePrecision 8; runTimeModifiable no; adjustTimeStep no;\n",
        end_time, time_step);
    tiny.files["system/fvSchemes"] =
        "ddtSchemes { default Euler; } gradSchemes { default Gauss linear; }\n"
        "divSchemes { default none; div(phi,U) Gauss linear; div((nuEff*dev2(T(grad(U))))) Gauss linear; }\n"
        "laplacianSchemes { default Gauss linear corrected; } interpolationSchemes { default linear; } snGradSchemes { default corrected; "
        "}\n";
    tiny.files["system/fvSolution"] =
        "solvers { \"p.*\" { solver PBiCGStab; preconditioner DIC; tolerance 1e-13; relTol 0; }\n"
        "\"U.*\" { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-14; relTol 0; maxIter 100; } }\n"
        "PIMPLE { nOuterCorrectors 1; nCorrectors 2; nNonOrthogonalCorrectors 0; pRefCell 0; pRefValue 0; }\n";
    tiny.files["constant/transportProperties"] = "transportModel Newtonian; nu 1e-6; rho 1000;\n";
    tiny.files["constant/turbulenceProperties"] = "simulationType laminar;\n";
    return tiny;
}

void make_turbulent(TinyCase& tiny, double k, double epsilon) {
    tiny.files["constant/turbulenceProperties"] = "simulationType RAS; RAS { RASModel realizableKE; turbulence on; printCoeffs off; }\n";
    tiny.files["system/fvSchemes"] +=
        "divSchemes { div(phi,k) Gauss upwind; div(phi,epsilon) Gauss upwind; } wallDist { method meshWave; }\n";
    tiny.files["system/fvSolution"] +=
        "solvers { \"(k|epsilon).*\" { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-14; relTol 0; maxIter 100; } }\n";
    tiny.files["0/k"] = volume_field("[0 2 -2 0 0 0 0]", fmt::format("{}", k), "\".*\" { type kqRWallFunction; value $internalField; }");
    tiny.files["0/epsilon"] =
        volume_field("[0 2 -3 0 0 0 0]", fmt::format("{}", epsilon), "\".*\" { type epsilonWallFunction; value $internalField; }");
    tiny.files["0/nut"] = volume_field("[0 2 -1 0 0 0 0]", fmt::format("{}", 0.09 * k * k / epsilon),
                                       "\".*\" { type nutkWallFunction; value $internalField; }");
}

std::filesystem::path build_case(const TinyCase& tiny) {
    int rank = 0, ranks = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    const std::filesystem::path folder =
        std::filesystem::path(CUTTERFLOW_BUILD_DIR) / "Testing" / "foam" / fmt::format("{}_{}", tiny.name, ranks);
    if (rank == 0) {
        std::filesystem::remove_all(folder);
        for (const auto& [path, body] : tiny.files) write_file(folder, path, body);
        run_program(folder, "blockMesh");
        if (ranks > 1) {
            write_file(folder, "system/decomposeParDict",
                       fmt::format("numberOfSubdomains {0}; method simple; coeffs {{ n ({0} 1 1); delta 0.001; }}\n", ranks));
            run_program(folder, "decomposePar");
        }
    }
    MPI_Barrier(MPI_COMM_WORLD);
    return folder;
}

}  // namespace cutterflow::foam::testing
