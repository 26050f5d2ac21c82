/// The pressure operator: symmetric, and the same as one assembled and factorised independently.
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include "solver/free_surface/pressure_system.hpp"

namespace cutterflow::free_surface {
namespace {

/// Water in a tank with a step in it, its surface halfway up, two discs, one of them across the surface.
struct Pool {
    StaggeredGrid grid;
    std::vector<Body> bodies{2};
    CutCells cells;
    WaterFraction water;
    double cell_mass;

    /// \param fineness  cells in 50 mm
    explicit Pool(int fineness = 1)
        : grid(StaggeredGrid::plane(24 * fineness, 20 * fineness, 0.05 / fineness, 0.2)), cell_mass(1000.0 * grid.cell_volume()) {
        bodies[0].position = Vec3(0.51, 0.1, 0.33);
        bodies[1].position = Vec3(0.83, 0.1, 0.57);
        for (Body& body : bodies) {
            body.radius = 0.13;
            body.mass = 2.0;
        }
        bodies[1].mass = 0.02;
        CellCutter cutter(grid, {SolidBox{Vec3(0, -1, 0), Vec3(0.2, 1, 0.2)}});
        cutter.cut(bodies, cells);
        WaterParticles particles;
        const auto is_open = [&](const Vec3& place) {
            for (const Body& body : bodies) {
                if ((place - body.position).norm() < body.radius) return false;
            }
            return place.x() > 0.2 || place.z() > 0.2;
        };
        fill_box(grid, Vec3(-1, -1, -1), Vec3(9, 9, 0.57), 0, is_open, particles);
        CellField fraction;
        map_fraction(grid, particles, fraction);
        find_water(grid, fraction, cells, water);
    }
};

/// The same system from its definition alone, with the bodies' part multiplied out.
Eigen::SparseMatrix<double> assembled(const Pool& pool, const PressureSystem& system) {
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](std::size_t r, std::size_t c, double value) {
        entries.emplace_back(static_cast<int>(r), static_cast<int>(c), value);
    };
    for (std::size_t r = 0; r < system.unknowns(); ++r) {
        const int cell = system.cell(r);
        for (const int d : {0, 2}) {
            for (const int side : {0, 1}) {
                const int face = cell + side * pool.grid.stride(d), neighbour = side ? face : cell - pool.grid.stride(d);
                const double open = pool.cells.open[d][face];
                if (open == 0.0) continue;
                if (system.row(neighbour) >= 0) {
                    add(r, r, open);
                    add(r, system.row(neighbour), -open);
                } else {
                    const double w = pool.water.fraction[cell], a = pool.water.fraction[neighbour];
                    add(r, r, open / std::max(0.1, (w - 0.5) / (w - a)));
                }
            }
        }
    }
    for (std::size_t b = 0; b < pool.bodies.size(); ++b) {
        for (const BodyCell& one : pool.cells.bodies[b]) {
            for (const BodyCell& other : pool.cells.bodies[b]) {
                if (system.row(one.cell) < 0 || system.row(other.cell) < 0) continue;
                add(system.row(one.cell), system.row(other.cell), pool.cell_mass / pool.bodies[b].mass * one.k.dot(other.k));
            }
        }
    }
    Eigen::SparseMatrix<double> matrix(static_cast<int>(system.unknowns()), static_cast<int>(system.unknowns()));
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

std::vector<double> random_vector(std::size_t size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> value(-1, 1);
    std::vector<double> vector(size);
    for (double& v : vector) v = value(random);
    return vector;
}

TEST(PressureSystem, is_symmetric_and_positive) {
    const Pool pool;
    PressureSystem system(pool.grid);
    system.assemble(pool.water, pool.cells, pool.bodies, pool.cell_mass);
    const std::size_t n = system.unknowns();
    const auto a = random_vector(n, 1), b = random_vector(n, 2);
    std::vector<double> ya(n), yb(n);
    system.apply(a, ya);
    system.apply(b, yb);
    double ab = 0.0, ba = 0.0, aa = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        ab += b[i] * ya[i];
        ba += a[i] * yb[i];
        aa += a[i] * ya[i];
    }
    EXPECT_NEAR(ab, ba, 1e-11 * std::abs(aa));
    EXPECT_GT(aa, 0.0);
}

TEST(PressureSystem, agrees_with_a_direct_solution_of_the_assembled_matrix) {
    const Pool pool;
    PressureSystem system(pool.grid);
    system.assemble(pool.water, pool.cells, pool.bodies, pool.cell_mass);
    const std::size_t n = system.unknowns();
    const auto right = random_vector(n, 3);
    std::vector<double> q(n, 0.0);
    const SolveReport report = system.solve(right, 1e-12, q);
    EXPECT_TRUE(report.converged);
    EXPECT_LT(report.iterations, 60);
    const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> direct(assembled(pool, system));
    ASSERT_EQ(direct.info(), Eigen::Success);
    const Eigen::VectorXd exact = direct.solve(Eigen::Map<const Eigen::VectorXd>(right.data(), static_cast<int>(n)));
    const Eigen::Map<const Eigen::VectorXd> found(q.data(), static_cast<int>(n));
    EXPECT_LE((exact - found).lpNorm<Eigen::Infinity>(), 1e-9 * exact.lpNorm<Eigen::Infinity>());
}

TEST(PressureSystem, takes_as_many_iterations_on_a_finer_mesh) {
    std::vector<int> iterations;
    for (const int fineness : {2, 8}) {
        const Pool pool(fineness);
        PressureSystem system(pool.grid);
        system.assemble(pool.water, pool.cells, pool.bodies, pool.cell_mass);
        std::vector<double> q(system.unknowns(), 0.0);
        iterations.push_back(system.solve(random_vector(q.size(), 3), 1e-8, q).iterations);
    }
    EXPECT_LE(iterations[0], 30);
    EXPECT_LE(iterations[1], iterations[0]);
}

TEST(BlockCorrection, leaves_no_sum_over_a_block) {
    constexpr int size = 11, blocks = 3;
    const std::vector<int> block{0, 0, 0, 1, 1, 1, 2, 2, 2, blocks, blocks};
    const Eigen::MatrixXd part = Eigen::Map<const Eigen::MatrixXd>(random_vector(size * size, 4).data(), size, size);
    const Eigen::MatrixXd matrix = part * part.transpose() + Eigen::MatrixXd::Identity(size, size);
    BlockCorrection correction;
    correction.begin(block, blocks);
    for (int r = 0; r < size; ++r) {
        for (int c = 0; c < size; ++c) correction.add(block[r], block[c], matrix(r, c));
    }
    correction.factorise();
    const Eigen::VectorXd residual = part.col(0);
    Eigen::VectorXd z = part.col(1);
    correction.correct(residual, matrix * z, z);
    const Eigen::VectorXd left = residual - matrix * z;
    for (int b = 0; b < blocks; ++b) EXPECT_NEAR(left.segment(3 * b, 3).sum(), 0.0, 1e-12) << b;
    EXPECT_EQ(z.tail(2), part.col(1).tail(2));
}

TEST(PressureSystem, finds_water_without_a_surface_and_solves_it_up_to_a_constant) {
    const StaggeredGrid grid = StaggeredGrid::plane(10, 10, 0.1, 1.0);
    CellCutter cutter(grid, {});
    CutCells cells;
    std::vector<Body> body(1);
    body[0].position = Vec3(0.47, 0.5, 0.52);
    body[0].radius = 0.2;
    body[0].mass = 10.0;
    cutter.cut(body, cells);
    WaterFraction water;
    find_water(grid, grid.cell_field(1.0), cells, water);
    PressureSystem system(grid);
    system.assemble(water, cells, body, 10.0);
    EXPECT_EQ(system.enclosed_waters(), 1);
    std::vector<double> right(system.unknowns(), 0.0), q(system.unknowns(), 5.0);
    right[3] = 1.0;  // not consistent: its mean is lost
    const SolveReport report = system.solve(right, 1e-10, q);
    EXPECT_TRUE(report.converged);
    double mean = 0.0;
    for (const double v : q) mean += v / static_cast<double>(q.size());
    EXPECT_NEAR(mean, 0.0, 1e-12);
}

}  // namespace
}  // namespace cutterflow::free_surface
