/// Uniform turbulent flow that carries a cloud of neutral rock stays uniform.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "validation/support/box_case.hpp"
#include "validation/support/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

namespace fs = std::filesystem;

constexpr double k_stream = 0.5;    // [m/s]
constexpr double k_start_k = 1e-2;  // [m2/s2]
constexpr double k_start_epsilon = 2e-2;

/// A lattice of rock in the middle of the box.
std::vector<FeedRock> cloud(double density) {
    std::vector<FeedRock> rocks;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                rocks.push_back({static_cast<int>(rocks.size()) + 1, 0.0, Vec3(-0.06 + 0.0131 * i, 0.0123 * (j - 1), 0.06 + 0.0127 * (k - 1)),
                                 0.010, density, Vec3(k_stream, 0.0, 0.0)});
    return rocks;
}

/// Makes the box periodic along x, with a stream and turbulence in it.
void let_it_stream(const fs::path& folder, const BoxCase& box) {
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
    field("U", "volVectorField", "[0 1 -1 0 0 0 0]", fmt::format("({} 0 0)", k_stream), "type slip;");
    field("p", "volScalarField", "[0 2 -2 0 0 0 0]", "0", "type fixedFluxPressure; value uniform 0;");
    field("k", "volScalarField", "[0 2 -2 0 0 0 0]", fmt::format("{}", k_start_k), "type zeroGradient;");
    field("epsilon", "volScalarField", "[0 2 -3 0 0 0 0]", fmt::format("{}", k_start_epsilon), "type zeroGradient;");
    field("nut", "volScalarField", "[0 2 -1 0 0 0 0]", fmt::format("{}", 0.09 * k_start_k * k_start_k / k_start_epsilon),
          "type calculated; value uniform 0;");
    write_foam_dictionary(folder, "constant/turbulenceProperties", "dictionary",
                          "simulationType RAS;\nRAS { RASModel realizableKE; turbulence on; printCoeffs off; }");
    write_foam_dictionary(folder, "system/fvSolution", "dictionary",
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

void run(Verification& verification) {
    BoxCase box;
    box.lower = Vec3(-0.16, -0.06, 0.0);
    box.upper = Vec3(0.16, 0.06, 0.12);
    box.cells = {32, 12, 12};
    box.gravity = Vec3::Zero();
    box.rocks = cloud(box.density);
    box.time_step = 1e-3;
    box.end_time = 0.1;
    box.contact = "youngsModulus 1e7; poissonRock 0.24; poissonSteel 0.27; friction 0.15; restitution 0.97; wetRestitution true; "
                  "timeStepFraction 0.1; maxSpeed 1.5;";
    const auto folder = verification.folder("stream");
    write_box_case(folder, box);
    let_it_stream(folder, box);
    run_cutter_foam(folder);

    const fs::path end = folder / "0.1";
    const std::size_t cells = box.cell_count();
    const std::vector<double> alpha = read_scalar_field(end / "voidFraction", cells);
    const std::vector<double> k = read_scalar_field(end / "k", cells);
    double disturbed = 0.0;
    for (const Vec3& u : read_vector_field(end / "U", cells)) disturbed = std::max(disturbed, (u - Vec3(k_stream, 0, 0)).norm() / k_stream);
    const double densest = 1.0 - *std::min_element(alpha.begin(), alpha.end());
    const About about{"exact", "36 rocks of 10 mm, d/dx = 1, 0.1 s: they travel 5 cm", {}};
    verification.at_least("largest solid fraction of the cloud", "-", densest, 0.1, about);
    verification.at_most("largest change of velocity over the stream's", "-", disturbed, 1e-6, about);
    verification.at_most("spread of k over its mean", "-", spread(k), 1e-6, about);
    verification.at_most("spread of epsilon over its mean", "-", spread(read_scalar_field(end / "epsilon", cells)), 1e-6, about);
    verification.relative("mean k after 0.1 s", "m2/s2", std::accumulate(k.begin(), k.end(), 0.0) / static_cast<double>(cells),
                          decayed_k(box.end_time, box.viscosity), 0.005, {"Shih1995", "Euler's first-order step of 1 ms", {}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
