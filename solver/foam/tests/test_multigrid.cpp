// The multigrid that preconditions the pressure: its clusters, its sweeps, and what conjugate gradients make of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Dense>

#include "solver/foam/multigrid/aggregation_multigrid.hpp"
#include "solver/foam/multigrid/clusters.hpp"
#include "solver/foam/multigrid/level_matrix.hpp"
#include "solver/foam/tests/fluid_run.hpp"

#include "dynamicFvMesh.H"
#include "solverPerformance.H"

namespace cutterflow::foam {
namespace {

/// A block of n x n x n cells.
FaceGraph block(int n) {
    FaceGraph graph;
    graph.cells = n * n * n;
    for (int cell = 0; cell < graph.cells; ++cell) {
        const int at[] = {cell % n, cell / n % n, cell / (n * n)};
        for (int axis = 0, step = 1; axis < 3; ++axis, step *= n) {
            if (at[axis] + 1 == n) continue;
            graph.lower.push_back(cell);
            graph.upper.push_back(cell + step);
        }
    }
    return graph;
}

/// A Laplacian of random coefficients, with something on the diagonal besides.
FaceMatrix laplacian(const FaceGraph& graph, double besides) {
    std::mt19937 random(1);
    FaceMatrix matrix{std::vector<double>(static_cast<std::size_t>(graph.cells), besides), {}};
    for (std::size_t face = 0; face < graph.faces(); ++face) {
        const double value = std::uniform_real_distribution<>(0.5, 2.0)(random);
        matrix.coupling.push_back(-value);
        for (const int cell : {graph.lower[face], graph.upper[face]}) matrix.diagonal[static_cast<std::size_t>(cell)] += value;
    }
    return matrix;
}

Eigen::MatrixXd dense(const FaceGraph& graph, const FaceMatrix& matrix) {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(graph.cells, graph.cells);
    for (int cell = 0; cell < graph.cells; ++cell) all(cell, cell) = matrix.diagonal[static_cast<std::size_t>(cell)];
    for (std::size_t face = 0; face < graph.faces(); ++face)
        all(graph.lower[face], graph.upper[face]) = all(graph.upper[face], graph.lower[face]) = matrix.coupling[face];
    return all;
}

std::vector<float> random_values(int size, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> values(static_cast<std::size_t>(size));
    for (float& value : values) value = std::uniform_real_distribution<float>(-1.0F, 1.0F)(random);
    return values;
}

Eigen::VectorXd vector_of(const std::vector<float>& values) {
    return Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(values.size())).cast<double>();
}

TEST(Clusters, HaveSomeEightCellsEach) {
    const FaceGraph graph = block(20);
    const Clusters clusters = cluster(graph, std::vector<double>(graph.faces(), 1.0), 3);
    std::vector<int> sizes(static_cast<std::size_t>(clusters.graph.cells), 0);
    for (const int number : clusters.of_cells) ++sizes.at(static_cast<std::size_t>(number));
    EXPECT_NEAR(clusters.graph.cells, graph.cells / 8, graph.cells / 40);
    EXPECT_GE(*std::min_element(sizes.begin(), sizes.end()), 4);
    EXPECT_LE(*std::max_element(sizes.begin(), sizes.end()), 24);
}

TEST(Clusters, JoinAlongStrongFaces) {
    const FaceGraph graph = block(8);
    std::vector<double> strength;
    for (std::size_t face = 0; face < graph.faces(); ++face) strength.push_back(graph.upper[face] - graph.lower[face] == 8 ? 100.0 : 1.0);
    const Clusters clusters = cluster(graph, strength, 3);
    for (int cell = 0; cell < graph.cells; ++cell)
        EXPECT_EQ(clusters.of_cells[static_cast<std::size_t>(cell)],
                  clusters.of_cells[static_cast<std::size_t>(cell % 8 + cell / 64 * 64)]);
}

TEST(Clusters, AreTheSameWhateverTheRounding) {
    const FaceGraph graph = block(12);
    std::vector<double> strength(graph.faces(), 0.3);
    const Clusters exact = cluster(graph, strength, 3);
    std::mt19937 random(2);
    for (double& value : strength) value *= std::uniform_real_distribution<>(1.0 - 1e-9, 1.0 + 1e-9)(random);
    EXPECT_EQ(cluster(graph, strength, 3).of_cells, exact.of_cells);
}

TEST(Clusters, OfCellsWithoutFacesAreTheCells) {
    FaceGraph graph;
    graph.cells = 3;
    EXPECT_EQ(cluster(graph, {}, 3).graph.cells, 3);
}

TEST(Clusters, HaveTheMatrixThatActsOnEqualCells) {
    const FaceGraph graph = block(6);
    const FaceMatrix matrix = laplacian(graph, 0.1);
    const Clusters clusters = cluster(graph, std::vector<double>(graph.faces(), 1.0), 3);
    FaceMatrix gathered;
    clusters.gather(graph, matrix, gathered);
    Eigen::MatrixXd prolongation = Eigen::MatrixXd::Zero(graph.cells, clusters.graph.cells);
    for (int cell = 0; cell < graph.cells; ++cell) prolongation(cell, clusters.of_cells[static_cast<std::size_t>(cell)]) = 1.0;
    const Eigen::MatrixXd expected = prolongation.transpose() * dense(graph, matrix) * prolongation;
    EXPECT_LE((dense(clusters.graph, gathered) - expected).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(LevelMatrix, SweepsSolveItsTriangles) {
    const FaceGraph graph = block(5);
    const FaceMatrix matrix = laplacian(graph, 0.1);
    const Eigen::MatrixXd all = dense(graph, matrix);
    const RowLayout layout(graph);
    const LevelMatrix level(layout, matrix);
    const std::vector<float> b = random_values(graph.cells, 3);
    std::vector<float> x(b.size()), r(b.size());
    level.sweep_forward(b, x, r);
    const Eigen::VectorXd forward = all.triangularView<Eigen::Lower>().solve(vector_of(b));
    EXPECT_LE((vector_of(x) - forward).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LE((vector_of(r) - (vector_of(b) - all * forward)).cwiseAbs().maxCoeff(), 1e-5);

    const std::vector<float> z = random_values(graph.cells, 5);
    r = b;
    level.subtract(z, r);
    EXPECT_LE((vector_of(r) - (vector_of(b) - all * vector_of(z))).cwiseAbs().maxCoeff(), 1e-5);

    std::vector<float> y = random_values(graph.cells, 4);
    const Eigen::VectorXd rest = vector_of(b) - all.triangularView<Eigen::StrictlyLower>() * vector_of(y);
    level.sweep_backward(b, y);
    EXPECT_LE((vector_of(y) - all.triangularView<Eigen::Upper>().solve(rest)).cwiseAbs().maxCoeff(), 1e-6);
}

/// Water that is thrown against the rim of a turning cylinder, after some steps.
struct Thrown {
    std::vector<Vec3> velocity;
    int iterations = 0;  ///< most of one solution
};

Thrown thrown(const std::string& name, int cells, const std::string& linear_solver) {
    testing::TurningCylinder shape;
    shape.cells_around_quarter = shape.cells_in_stator = shape.cells_high = cells;
    shape.stator_cells_around_quarter = cells / 2 + 1;
    shape.cells_in_rotor_ring = cells / 2;
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(shape), 2e-3, 0.01);
    tiny.files["constant/dynamicMeshDict"] = testing::turning(2.0 * k_pi);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0.7 -0.3 0.2)", "\".*\" { type fixedValue; value uniform (0 0 0); }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; }");
    tiny.files["system/fvSolution"] += "solvers { \"p.*\" { " + linear_solver + " tolerance 1e-10; relTol 0; maxIter 2000; } }\n";
    testing::FluidRun run(testing::build_case(tiny), false);
    Thrown result;
    while (run.engine().running()) {
        run.begin();
        run.end({}, {});
        Foam::List<Foam::solverPerformance> solutions(run.session().mesh().solverPerformanceDict().lookup("p"));
        for (const Foam::solverPerformance& solution : solutions) {
            EXPECT_TRUE(solution.converged());
            result.iterations = std::max(result.iterations, static_cast<int>(solution.nIterations()));
        }
    }
    const auto velocity = run.engine().fields().velocity;
    result.velocity.assign(velocity.begin(), velocity.end());
    return result;
}

// A closed cylinder, whose sliding interface has turned, on one rank and on several.
TEST(AggregationMultigrid, LeadsToTheSolutionOfOthers) {
    const Thrown own = thrown("multigrid_own", 8, "solver PCG; preconditioner aggregationMultigrid;");
    const Thrown stock = thrown("multigrid_stock", 8, "solver PCG; preconditioner DIC;");
    ASSERT_EQ(own.velocity.size(), stock.velocity.size());
    for (std::size_t i = 0; i < own.velocity.size(); ++i) EXPECT_LE((own.velocity[i] - stock.velocity[i]).norm(), 1e-6) << i;
}

// Twice as fine: DIC needs nearly twice as many iterations.
TEST(AggregationMultigrid, TakesHardlyMoreIterationsOnAFinerMesh) {
    const std::string multigrid = "solver PCG; preconditioner aggregationMultigrid;";
    const int coarse = thrown("multigrid_8", 8, multigrid).iterations, fine = thrown("multigrid_16", 16, multigrid).iterations;
    EXPECT_LE(coarse, 40);
    EXPECT_LE(fine, 1.3 * coarse + 1);
}

// A case that other programs read as well names cutterFoam's own beside theirs.
TEST(AggregationMultigrid, TakesThePlaceOfTheOneForOtherPrograms) {
    const Foam::dictionary section(
        Foam::IStringStream("solver PCG; preconditioner { preconditioner GAMG; smoother DIC; } "
                            "cutterFoamPreconditioner aggregationMultigrid; tolerance 1e-7;")());
    EXPECT_EQ(Foam::word(own_linear_solver(section).lookup("preconditioner")), "aggregationMultigrid");
    const Foam::dictionary stock(Foam::IStringStream("solver PCG; preconditioner DIC;")());
    EXPECT_EQ(Foam::word(own_linear_solver(stock).lookup("preconditioner")), "DIC");
}

}  // namespace
}  // namespace cutterflow::foam
