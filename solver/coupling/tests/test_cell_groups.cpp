// Maps that lay rock evenly over cells: the cell of its centre, the cells of a cube.
#include <numeric>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/coupling/kernel/mapping.hpp"
#include "solver/coupling/kernel/testing/normalisation_error.hpp"
#include "solver/coupling/tests/coupling_rig.hpp"
#include "solver/ports/testing/threaded_ranks.hpp"

namespace cutterflow::coupling {
namespace {

using ::testing::HasSubstr;
using testing::normalisation_error;
using testing::SyntheticMesh;

constexpr double k_dx = 0.01;

KernelSettings centroid() {
    KernelSettings kernel;
    kernel.map = k_centroid_map;
    return kernel;
}

KernelSettings clusters(double size) {
    KernelSettings kernel;
    kernel.map = k_cluster_map;
    kernel.cluster_size = size;
    return kernel;
}

/// Rock of equal diameter at these places.
struct TestRocks {
    TestRocks(std::vector<Vec3> places, double d) : position(std::move(places)), diameter(position.size(), d), id(position.size()) {
        std::iota(id.begin(), id.end(), 1);
    }
    RockShapes shapes() const { return {id, position, diameter}; }
    std::vector<Vec3> position;
    std::vector<double> diameter;
    std::vector<int> id;
};

/// Places all over a box of half width `half`, near its walls too.
std::vector<Vec3> places_in(double half, int count) {
    std::vector<Vec3> places;
    for (int i = 0; i < count; ++i) places.push_back(0.99 * half * Vec3(std::sin(1.1 * i), std::sin(2.3 * i + 1.0), std::sin(3.7 * i)));
    return places;
}

/// A mesh with its mapping, on one rank.
struct Bench {
    Bench(SyntheticMesh m, const KernelSettings& kernel)
        : mesh(std::move(m)), mapping(mesh.cells(), mesh.steel(), testing::unit_turn(), kernel, serial) {}
    SyntheticMesh mesh;
    SerialCommunicator serial;
    Mapping mapping;
    Stencils build(const TestRocks& rocks) {
        Stencils stencils;
        mapping.build(rocks.shapes(), stencils);
        return stencils;
    }
};

/// Two boxes side by side, cells of 10 and of 20 mm.
SyntheticMesh two_sizes() {
    SyntheticMesh mesh;
    mesh.add_box(Vec3(-0.1, -0.1, -0.1), Vec3(0.0, 0.1, 0.1), k_dx, false);
    mesh.add_box(Vec3(0.0, -0.1, -0.1), Vec3(0.1, 0.1, 0.1), 2.0 * k_dx, false);
    return mesh;
}

TEST(CentroidMap, lays_a_rock_into_the_cell_of_its_centre) {
    Bench bench(testing::box(0.1, k_dx), centroid());
    const Vec3 cell = bench.mesh.centres[1234];
    const Stencils s = bench.build(TestRocks({cell + Vec3(0.0049, -0.0049, 0.004)}, 0.005));
    ASSERT_EQ(s.cell, std::vector<std::int32_t>{1234});
    EXPECT_NEAR(s.deposit[0], 1.0 / std::pow(k_dx, 3), 1e-12 / std::pow(k_dx, 3));
    EXPECT_EQ(s.sample, s.deposit);
    EXPECT_NEAR(s.width[0], k_dx, 1e-12);
}

TEST(CentroidMap, follows_a_turning_mesh) {
    SyntheticMesh mesh;
    mesh.add_annulus(0.05, 0.2, 15, 90, -0.12, 0.12, 24, true);
    mesh.add_annulus(0.2, 0.35, 12, 100, -0.12, 0.12, 20, false);
    Bench bench(std::move(mesh), centroid());
    const std::size_t cell = 777;
    ASSERT_NE(bench.mesh.in_rotor[cell], 0);
    for (const double angle : {0.0, 0.4, 2.9}) {
        bench.mapping.set_time(angle);
        const Stencils s = bench.build(TestRocks({rotate_about(RotationAxis{}, angle, bench.mesh.centres[cell])}, 0.005));
        EXPECT_EQ(s.cell, std::vector<std::int32_t>{static_cast<std::int32_t>(cell)}) << angle;
        EXPECT_NE(s.zone[0], k_still_zone);
    }
}

TEST(ClusterMap, lays_a_rock_evenly_over_the_cells_of_its_cube) {
    Bench bench(testing::box(0.1, k_dx), clusters(0.04));
    const Stencils s = bench.build(TestRocks({Vec3(0.001, 0.039, -0.021)}, 0.02));  // of the cube from (-0.02 0.02 -0.06) on
    ASSERT_EQ(s.cell.size(), 64u);
    const double even = 1.0 / std::pow(0.04, 3);
    for (std::size_t i = 0; i < s.cell.size(); ++i) {
        const Vec3 centre = bench.mesh.centres[static_cast<std::size_t>(s.cell[i])];
        EXPECT_LT((centre - Vec3(0.0, 0.04, -0.04)).cwiseAbs().maxCoeff(), 0.02);
        EXPECT_NEAR(s.deposit[i], even, 1e-12 * even);
        EXPECT_EQ(s.sample[i], s.deposit[i]);
    }
    EXPECT_NEAR(s.width[0], 0.04, 1e-12);
}

TEST(ClusterMap, puts_every_cell_into_one_cluster) {
    // 0.2 m in cubes of 0.06 m: the last ones along each axis are cut by the walls.
    Bench bench(two_sizes(), clusters(0.06));
    std::vector<std::set<std::int32_t>> clusters_found;
    std::size_t cells = 0;
    for (std::size_t c = 0; c < bench.mesh.size(); ++c) {
        const Stencils s = bench.build(TestRocks({bench.mesh.centres[c]}, 0.01));
        const std::set<std::int32_t> members(s.cell.begin(), s.cell.end());
        ASSERT_EQ(members.count(static_cast<std::int32_t>(c)), 1u);
        if (std::find(clusters_found.begin(), clusters_found.end(), members) != clusters_found.end()) continue;
        clusters_found.push_back(members);
        cells += members.size();
    }
    EXPECT_EQ(clusters_found.size(), 64u);
    EXPECT_EQ(cells, bench.mesh.size());
}

TEST(ClusterMap, of_one_cell_is_the_centroid_map) {
    const TestRocks rocks(places_in(0.1, 50), 0.01);
    EXPECT_EQ(Bench(testing::box(0.1, k_dx), clusters(k_dx)).build(rocks).cell,
              Bench(testing::box(0.1, k_dx), centroid()).build(rocks).cell);
}

class EvenMaps : public ::testing::TestWithParam<KernelSettings> {};

TEST_P(EvenMaps, keep_the_volume_and_see_a_constant_field) {
    Bench bench(two_sizes(), GetParam());
    const TestRocks rocks(places_in(0.1, 200), 0.013);
    const Stencils s = bench.build(rocks);
    EXPECT_LE(normalisation_error(s, bench.mesh.volumes, bench.serial), 1e-12);
    std::vector<double> solid(bench.mesh.size(), 0.0);
    const std::vector<double> volumes(rocks.id.size(), sphere_volume(0.013));
    deposit(s, volumes, solid);
    const double laid = std::inner_product(solid.begin(), solid.end(), bench.mesh.volumes.begin(), 0.0);
    EXPECT_NEAR(laid, 200.0 * sphere_volume(0.013), 1e-12 * laid);
    for (std::size_t p = 0; p < s.size(); ++p) {
        double seen = 0.0;
        for (std::size_t i = s.first[p]; i < s.first[p + 1]; ++i)
            seen += s.sample[i] * bench.mesh.volumes[static_cast<std::size_t>(s.cell[i])] * 3.25;
        EXPECT_NEAR(seen, 3.25, 1e-12);
    }
}

TEST_P(EvenMaps, refuse_rock_outside_the_mesh) {
    Bench bench(testing::box(0.1, k_dx), GetParam());
    EXPECT_THROW(bench.build(TestRocks({Vec3(0.15, 0, 0)}, 0.02)), CheckFailure);
}

TEST_P(EvenMaps, are_the_same_on_two_ranks) {
    const SyntheticMesh whole = testing::box(0.1, k_dx);
    std::vector<Vec3> places = places_in(0.1, 40);
    places.insert(places.end(), {Vec3::Zero(), Vec3(0.02, 0.005, 0.0), Vec3(0.0, 0.0, 0.015)});  // where cells and ranks meet
    const TestRocks rocks(places, 0.013);
    const std::vector<double> volumes(places.size(), sphere_volume(0.013));
    SerialCommunicator serial;
    const auto solid_of = [&](const SyntheticMesh& mesh, Communicator& communicator) {
        Mapping mapping(mesh.cells(), mesh.steel(), testing::unit_turn(), GetParam(), communicator);
        Stencils s;
        mapping.build(rocks.shapes(), s);
        std::vector<double> solid(mesh.size(), 0.0);
        deposit(s, volumes, solid);
        return solid;
    };
    const std::vector<double> expected = solid_of(whole, serial);
    std::vector<double> found(whole.size(), -1.0);
    testing::ThreadedRanks(2).run([&](Communicator& communicator) {
        const SyntheticMesh part = whole.part([&](std::size_t c) { return (whole.centres[c].x() > 0.0) == (communicator.rank() == 0); });
        const std::vector<double> solid = solid_of(part, communicator);
        for (std::size_t c = 0; c < part.size(); ++c) found[static_cast<std::size_t>(part.ids[c])] = solid[c];
    });
    for (std::size_t c = 0; c < whole.size(); ++c) ASSERT_NEAR(found[c], expected[c], 1e-12);
}

TEST_P(EvenMaps, balance_rock_fluid_and_carry_in_every_step) {
    CouplingSettings settings = testing::settings_with_rock();
    settings.kernel = GetParam();
    testing::CouplingRig<> rig(testing::box(0.15, 0.02), {}, 2e-3, settings);
    rig.dem.gravity = Vec3(3.0, -1.0, -9.0);
    std::vector<FeedRock> due;
    for (int i = 0; i < 12; ++i)
        due.push_back(
            {i + 1, 0.0, Vec3(0.06 * (i % 4) - 0.09, 0.06 * (i / 4) - 0.06, 0.02 * i - 0.1), 0.015, 2650.0, Vec3(0.3, 0.1, -0.2)});
    rig.coupling.insert(due);
    for (int n = 0; n < 40; ++n) {
        const ExchangeBalance balance = rig.step();
        ASSERT_LE(rig.momentum_errors.error, 1e-10) << n;
        ASSERT_LE(balance.solid_volume_error, 1e-12) << n;
    }
}

std::string map_name(const ::testing::TestParamInfo<KernelSettings>& info) {
    return info.param.map;
}

INSTANTIATE_TEST_SUITE_P(Maps, EvenMaps, ::testing::Values(centroid(), clusters(0.05)), map_name);

TEST(CentroidMap, has_no_room_for_rock_larger_than_a_cell) {
    CouplingSettings settings = testing::settings_with_rock();
    settings.kernel = centroid();
    testing::CouplingRig<> rig(testing::box(0.1, k_dx), {}, 2e-3, settings);
    try {
        rig.coupling.insert({{1, 0.0, Vec3::Zero(), 0.02, 2650.0, Vec3::Zero()}});
        FAIL();
    } catch (const CheckFailure& failure) {
        EXPECT_THAT(failure.what(), HasSubstr("kernel.map = centroid"));
        EXPECT_THAT(failure.what(), HasSubstr("map gaussian"));
    }
}

TEST(ClusterMap, is_refused_where_cells_turn_or_are_longer) {
    testing::FakeFluid fluid(two_sizes(), testing::unit_turn().front(), 1e-3);
    SerialCommunicator serial;
    std::vector<Mistake> mistakes = map_mistakes(clusters(0.05), fluid, serial);
    ASSERT_EQ(mistakes.size(), 1u);
    EXPECT_EQ(mistakes[0].where, "constant/couplingProperties");
    EXPECT_THAT(mistakes[0].what, HasSubstr("kernel.map = cluster with the turning cell zone rotor"));
    EXPECT_THAT(mistakes[0].remedy, HasSubstr("map gaussian"));

    fluid.moving.clear();
    EXPECT_TRUE(map_mistakes(clusters(0.05), fluid, serial).empty());
    EXPECT_TRUE(map_mistakes(clusters(0.02), fluid, serial).empty());
    mistakes = map_mistakes(clusters(0.019), fluid, serial);
    ASSERT_EQ(mistakes.size(), 1u);
    EXPECT_EQ(mistakes[0].what, "kernel.clusterSize = 0.019");
    EXPECT_THAT(mistakes[0].rule, HasSubstr("0.02 m"));
    EXPECT_FALSE(mistakes[0].remedy.empty());
}

TEST(CentroidMap, is_not_refused_where_cells_turn) {
    const testing::FakeFluid fluid(two_sizes(), testing::unit_turn().front(), 1e-3);
    SerialCommunicator serial;
    EXPECT_TRUE(map_mistakes(centroid(), fluid, serial).empty());
    EXPECT_TRUE(map_mistakes(KernelSettings{}, fluid, serial).empty());
}

}  // namespace
}  // namespace cutterflow::coupling
