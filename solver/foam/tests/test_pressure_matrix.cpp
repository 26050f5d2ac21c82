// The matrix of the pressure is symmetric across a sliding interface: x.Ay = y.Ax for any x and y.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "solver/foam/mesh_motion/overlap_flux.hpp"
#include "solver/foam/tests/fluid_run.hpp"

#include "PCG.H"
#include "addToRunTimeSelectionTable.H"
#include "dynamicFvMesh.H"
#include "fvm.H"
#include "surfaceFields.H"
#include "surfaceInterpolate.H"

namespace cutterflow::foam {
namespace {

using Foam::word;  // in TypeName
using testing::FluidRun;

constexpr double k_omega = 2.0 * k_pi;
constexpr double k_time_step = 3e-3;
constexpr int k_steps = 5;  // to 5.4 degrees: a general angle between faces of 11.25 degrees and such of 15

/// Conjugate gradients that note how far each matrix that they are given is from symmetric: |x.Ay - y.Ax| / sum |x_i (Ay)_i|, x and y of
/// random values in [-1, 1]. Rounding leaves some 1e-16.
class SymmetryProbe : public Foam::lduMatrix::solver {
public:
    TypeName("symmetryProbe");
    using Foam::lduMatrix::solver::solver;

    Foam::solverPerformance solve(Foam::scalarField& psi, const Foam::scalarField& source, const Foam::direction cmpt) const override {
        const Foam::scalarField x(random_values(1)), y(random_values(2));
        const Foam::scalarField Ax(product(x)), Ay(product(y));
        found.push_back(Foam::mag(Foam::gSumProd(x, Ay) - Foam::gSumProd(y, Ax)) / Foam::gSum(Foam::mag(x * Ay)));
        return Foam::PCG(fieldName_, matrix_, interfaceBouCoeffs_, interfaceIntCoeffs_, interfaces_, controlDict_).solve(psi, source, cmpt);
    }

    static std::vector<double> found;

private:
    Foam::scalarField random_values(int seed) const {
        std::mt19937 random(static_cast<unsigned>(100 * Foam::Pstream::myProcNo() + seed));
        Foam::scalarField values(matrix_.diag().size());
        for (double& value : values) value = std::uniform_real_distribution<>(-1.0, 1.0)(random);
        return values;
    }
    Foam::scalarField product(const Foam::scalarField& x) const {
        Foam::scalarField result(x.size());
        matrix_.Amul(result, x, interfaceBouCoeffs_, interfaces_, 0);
        return result;
    }
};

std::vector<double> SymmetryProbe::found;
defineTypeNameAndDebug(SymmetryProbe, 0);
const Foam::lduMatrix::solver::addsymMatrixConstructorToTable<SymmetryProbe> k_selectable;

/// Water that is thrown against the boundary of a cylinder. \param around  faces of a quarter of the interface's still side, of 8 that turn
testing::TinyCase thrown_water(const std::string& name, int around) {
    testing::TurningCylinder shape;
    shape.stator_cells_around_quarter = around;
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(shape), k_time_step, k_steps * k_time_step);
    tiny.files["constant/dynamicMeshDict"] = testing::turning(k_omega);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0.7 -0.3 0.2)", "\".*\" { type fixedValue; value uniform (0 0 0); }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; }");
    tiny.files["system/fvSolution"] +=
        "solvers { \"p.*\" { solver symmetryProbe; preconditioner DIC; tolerance 1e-10; relTol 0; maxIter 2000; } }\n";
    return tiny;
}

/// Solid fraction of a cloud of rock that stands still on the interface.
double cloud(const Vec3& x) {
    return 0.4 * std::exp(-0.5 * (x - Vec3(0.1, 0.0, 0.0)).squaredNorm() / (0.03 * 0.03));
}

/// Goes to the end, with the cloud: its void fraction and its drag make the pressure's coefficients uneven.
void go_to_end(FluidRun& run) {
    while (run.engine().running()) {
        run.begin();
        const std::vector<double> solid = run.evaluate(cloud);
        std::vector<double> fraction(solid.size());
        for (std::size_t c = 0; c < solid.size(); ++c) {
            fraction[c] = 1.0 - solid[c];
            run.drag_rate[c] = 500.0 * solid[c];
            run.inertia[c] = 0.5 * solid[c];
        }
        run.end(fraction, fraction);
    }
}

void tell(const std::string& line) {
    if (Foam::Pstream::master()) fmt::print("{}\n", line);
}

class PressureMatrix : public ::testing::TestWithParam<int> {
protected:
    void SetUp() override { SymmetryProbe::found.clear(); }
    std::string case_name(const std::string& of) const { return fmt::format("{}_{}", of, GetParam()); }
};

/// What the solver solves, at every angle that it comes to.
TEST_P(PressureMatrix, is_symmetric_across_a_sliding_interface) {
    FluidRun run(testing::build_case(thrown_water(case_name("symmetric_pressure"), GetParam())), true);
    go_to_end(run);
    EXPECT_GE(run.deviation(Vec3(0.7, -0.3, 0.2)), 0.1);
    ASSERT_EQ(SymmetryProbe::found.size(), 2u * k_steps) << "two correctors";
    for (const double asymmetry : SymmetryProbe::found) EXPECT_LE(asymmetry, 1e-12);
    tell(fmt::format("asymmetry of what is solved, {} faces a quarter: at most {:.1e}", GetParam(),
                     *std::max_element(SymmetryProbe::found.begin(), SymmetryProbe::found.end())));
}

/// Asymmetry of div(coefficient grad p), by the overlaps' weights as they are.
double asymmetry_of(const Foam::surfaceScalarField& coefficient, Foam::volScalarField& pressure) {
    Foam::fvScalarMatrix matrix(Foam::fvm::laplacian(coefficient, pressure));
    matrix.solve(Foam::dictionary(Foam::IStringStream("solver symmetryProbe; preconditioner DIC; tolerance 1e30; relTol 0;")()));
    return SymmetryProbe::found.back();
}

/// The same by parts, as the solver has it. \param mesh  of the pressure
double asymmetry_of_parts(OverlapFlux& parts, Foam::surfaceScalarField coefficient, Foam::volScalarField& pressure) {
    const Foam::fvMesh& mesh = pressure.mesh();
    for (const PartFluxes& part : parts.sides()) {
        const Foam::label patch = part.side.patch();
        coefficient.boundaryFieldRef()[patch] =
            part.side.sum(part.conductance) / (mesh.nonOrthDeltaCoeffs().boundaryField()[patch] * mesh.magSf().boundaryField()[patch]);
    }
    const OverlapFlux::InMatrix in_matrix(parts);
    return asymmetry_of(coefficient, pressure);
}

/// The operator from before fluxes had parts, each face by the weights of what it overlaps, and parts of which one side tells another
/// number are found out.
TEST_P(PressureMatrix, is_found_out_when_both_sides_differ) {
    FluidRun run(testing::build_case(thrown_water(case_name("unsymmetric_pressure"), GetParam())), true);
    go_to_end(run);
    Foam::fvMesh& mesh = run.session().mesh();
    auto& pressure = mesh.lookupObjectRef<Foam::volScalarField>("p");
    const auto& fraction = mesh.lookupObject<Foam::volScalarField>("voidFraction");
    const Foam::surfaceScalarField coefficient("coefficient", Foam::fvc::interpolate(fraction));
    const double of_faces = asymmetry_of(coefficient, pressure);

    const double angle = k_omega * run.engine().time();
    const MovingZones zones = read_moving_zones(run.session().mesh());
    SlidingOverlap overlap(mesh, zones, angle);
    overlap.set(angle);
    OverlapFlux parts(mesh);
    parts.couple(overlap);
    ASSERT_EQ(parts.sides().size(), 2u);
    for (PartFluxes& part : parts.sides()) part.conductance = part.side.mean(fraction.primitiveField()) * part.side.strength();
    const double of_parts = asymmetry_of_parts(parts, coefficient, pressure);
    Foam::scalarField& liar = parts.sides().front().conductance;
    forAll(liar, k) liar[k] *= k % 2 == 0 ? 1.001 : 0.999;
    const double of_lie = asymmetry_of_parts(parts, coefficient, pressure);

    EXPECT_LE(of_parts, 1e-12);
    EXPECT_GT(of_faces, 1e-8);
    EXPECT_GT(of_lie, 1e-8);
    tell(fmt::format("asymmetry, {} faces a quarter: by parts {:.1e}, by faces {:.1e}, of a lie of 0.1 % {:.1e}", GetParam(), of_parts,
                     of_faces, of_lie));
}

INSTANTIATE_TEST_SUITE_P(FacesAround, PressureMatrix, ::testing::Values(8, 6));

}  // namespace
}  // namespace cutterflow::foam
