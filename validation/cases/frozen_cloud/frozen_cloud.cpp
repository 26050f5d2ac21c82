/// Turbulence in water with a cloud of neutral rock that rests in it, or is carried along: no source of anything.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "validation/harness/largest.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

namespace fs = std::filesystem;

constexpr double k_stream = 0.5;    // where there is one [m/s]
constexpr double k_start_k = 1e-2;  // [m2/s2]
constexpr double k_start_epsilon = 2e-2;

/// A lattice of rock in the middle of the box.
std::vector<BoxRock> cloud(double density, double stream) {
    std::vector<BoxRock> rocks;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                rocks.push_back({static_cast<int>(rocks.size()) + 1, 0.0,
                                 Vec3(-0.06 + 0.0131 * i, 0.0123 * (j - 1), 0.06 + 0.0127 * (k - 1)), 0.010, density,
                                 Vec3(stream, 0.0, 0.0)});
    return rocks;
}

/// Makes the box periodic along x, with a stream and turbulence in it.
void let_it_stream(const fs::path& folder, const BoxCase& box, double stream) {
    const Vec3 &a = box.lower, &b = box.upper;
    write_foam_dictionary(
        folder, "system/blockMeshDict", "dictionary",
        fmt::format("scale 1;\nvertices (({0} {1} {2}) ({3} {1} {2}) ({3} {4} {2}) ({0} {4} {2}) ({0} {1} {5}) ({3} {1} {5}) ({3} {4} {5}) "
                    "({0} {4} {5}));\nblocks ( hex (0 1 2 3 4 5 6 7) ({6} {7} {8}) simpleGrading (1 1 1) );\nedges ();\nboundary\n(\n"
                    "    upstream {{ type cyclic; neighbourPatch downstream; faces ((0 4 7 3)); }}\n"
                    "    downstream {{ type cyclic; neighbourPatch upstream; faces ((1 2 6 5)); }}\n"
                    "    sides {{ type patch; faces ((0 1 5 4) (3 7 6 2) (0 3 2 1) (4 5 6 7)); }}\n);\nmergePatchPairs ();",
                    a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), box.cells[0], box.cells[1], box.cells[2]));
    const auto field = [&](const char* name, const char* kind, const char* dimensions, const std::string& value, const char* side) {
        write_foam_dictionary(folder, std::string("0/") + name, kind,
                              fmt::format("dimensions {};\ninternalField uniform {};\nboundaryField\n{{\n    \"(upstream|downstream)\" {{ "
                                          "type cyclic; }}\n    sides {{ {} }}\n}}",
                                          dimensions, value, side));
    };
    field("U", "volVectorField", "[0 1 -1 0 0 0 0]", fmt::format("({} 0 0)", stream), "type slip;");
    field("p", "volScalarField", "[0 2 -2 0 0 0 0]", "0", "type fixedFluxPressure; value uniform 0;");
    field("k", "volScalarField", "[0 2 -2 0 0 0 0]", fmt::format("{}", k_start_k), "type zeroGradient;");
    field("epsilon", "volScalarField", "[0 2 -3 0 0 0 0]", fmt::format("{}", k_start_epsilon), "type zeroGradient;");
    field("nut", "volScalarField", "[0 2 -1 0 0 0 0]", fmt::format("{}", 0.09 * k_start_k * k_start_k / k_start_epsilon),
          "type calculated; value uniform 0;");
    write_foam_dictionary(folder, "constant/turbulenceProperties", "dictionary",
                          "simulationType RAS;\nRAS { RASModel realizableKE; turbulence on; printCoeffs off; }");
    write_foam_dictionary(
        folder, "system/fvSolution", "dictionary",
        "solvers\n{\n    \"p.*\" { solver PBiCGStab; preconditioner DIC; tolerance 1e-12; relTol 0; }\n"
        "    \"(U|k|epsilon).*\" { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-14; relTol 0; maxIter 200; }\n}\n"
        "PIMPLE { nOuterCorrectors 1; nCorrectors 2; nNonOrthogonalCorrectors 0; pRefCell 0; pRefValue 0; }");
    fs::remove_all(folder / "constant/polyMesh");
    run_in_case(folder, {"blockMesh"});
}

/// Largest less smallest value over the mean.
double spread(const std::vector<double>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return (*high - *low) / (std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()));
}

/// k after `duration` of homogeneous decay, by Heun's scheme. [Shih1995]
double decayed_k(double duration, double viscosity) {
    double k = k_start_k, epsilon = k_start_epsilon;
    constexpr int steps = 10000;
    const double dt = duration / steps;
    const auto rate = [&](double k_now, double e_now) {
        return std::pair(-e_now, -1.9 * e_now * e_now / (k_now + std::sqrt(viscosity * e_now)));
    };
    for (int i = 0; i < steps; ++i) {
        const auto [dk, de] = rate(k, epsilon);
        const auto [dk2, de2] = rate(k + dt * dk, epsilon + dt * de);
        k += 0.5 * dt * (dk + dk2);
        epsilon += 0.5 * dt * (de + de2);
    }
    return k;
}

/// What 0.1 s have made of a uniform start.
struct Outcome {
    double densest = 0.0;    ///< solid fraction
    double disturbed = 0.0;  ///< largest change of velocity over k_stream
    double spread_k = 0.0, spread_epsilon = 0.0, mean_k = 0.0;
};

Outcome outcome_of(const Verification& verification, double stream, int refinement) {
    BoxCase box;
    box.lower = Vec3(-0.16, -0.06, 0.0);
    box.upper = Vec3(0.16, 0.06, 0.12);
    box.cells = {32 * refinement, 12 * refinement, 12 * refinement};
    box.gravity = Vec3::Zero();
    box.rocks = cloud(box.density, stream);
    box.time_step = 1e-3;
    box.end_time = 0.1;
    box.kernel = "gamma 2.0; minWidthInCells 1.5; maxSolidFraction 0.7;";  // the same cloud on both meshes
    const auto folder = verification.folder(fmt::format("stream_{}_refined_{}", stream, refinement));
    write_box_case(folder, box);
    let_it_stream(folder, box, stream);
    run_cutter_foam(folder);

    const fs::path end = folder / "0.1";
    const std::size_t cells = box.cell_count();
    const std::vector<double> alpha = read_scalar_field(end / "voidFraction", cells), k = read_scalar_field(end / "k", cells);
    Outcome outcome;
    outcome.densest = 1.0 - *std::min_element(alpha.begin(), alpha.end());
    for (const Vec3& u : read_vector_field(end / "U", cells))
        outcome.disturbed = larger(outcome.disturbed, (u - Vec3(stream, 0, 0)).norm() / k_stream);
    outcome.spread_k = spread(k);
    outcome.spread_epsilon = spread(read_scalar_field(end / "epsilon", cells));
    outcome.mean_k = std::accumulate(k.begin(), k.end(), 0.0) / static_cast<double>(cells);
    return outcome;
}

void run(Verification& verification) {
    const About about{"exact", "36 rocks of 10 mm as heavy as water, kernel of 20 mm, 0.1 s", {}};
    const Outcome rest = outcome_of(verification, 0.0, 1);
    verification.at_least("largest solid fraction of the cloud", "-", rest.densest, 0.05, about);
    verification.at_most("cloud at rest: largest velocity over 0.5 m/s", "-", rest.disturbed, 1e-6, about);
    verification.at_most("cloud at rest: spread of k over its mean", "-", rest.spread_k, 1e-6, about);
    verification.at_most("cloud at rest: spread of epsilon over its mean", "-", rest.spread_epsilon, 1e-6, about);
    verification.relative("cloud at rest: mean k after 0.1 s", "m2/s2", rest.mean_k, decayed_k(0.1, BoxCase().viscosity), 0.005,
                          {"Shih1995", "Euler's first-order step of 1 ms", {}});
    if (!verification.wants(Effort::standard)) return;
    const Outcome coarse = outcome_of(verification, k_stream, 1), fine = outcome_of(verification, k_stream, 2);
    const About carried{
        "exact",
        "Cells of 10 and 5 mm. The void fraction that moves with the kernels and the one that the discrete stream carries differ by the "
        "truncation error of the mesh and of the step; that much the stream must give way.",
        {}};
    verification.at_most("carried cloud: largest change of velocity over the stream's", "-", fine.disturbed, 1e-3, carried);
    verification.at_most("carried cloud: spread of k over its mean", "-", fine.spread_k, 1e-3, carried);
    verification.report("carried cloud: order in the cell size of the change of velocity", "-",
                        std::log2(coarse.disturbed / fine.disturbed), {}, carried);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
