// Mapping between rock and cells: volume, centroid, walls, blades, the rotor interface, ranks, redistribution.
#include <functional>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/coupling/kernel/mapping.hpp"
#include "solver/coupling/kernel/redistribution.hpp"
#include "solver/coupling/kernel/testing/normalisation_error.hpp"
#include "solver/physics/drag.hpp"
#include "solver/ports/testing/synthetic_mesh.hpp"
#include "solver/ports/testing/threaded_ranks.hpp"

namespace cutterflow::coupling {
namespace {

using testing::normalisation_error;
using testing::SyntheticMesh;

/// Rocks with their own arrays.
struct TestRocks {
    std::vector<int> id;
    std::vector<Vec3> position;
    std::vector<double> diameter;
    void add(const Vec3& x, double d) {
        id.push_back(static_cast<int>(id.size()) + 1);
        position.push_back(x);
        diameter.push_back(d);
    }
    RockShapes shapes() const { return {id, position, diameter}; }
    std::vector<double> volumes() const {
        std::vector<double> v;
        for (const double d : diameter) v.push_back(sphere_volume(d));
        return v;
    }
};

TestRocks one_rock(const Vec3& x, double d) {
    TestRocks rocks;
    rocks.add(x, d);
    return rocks;
}

Stencils stencils_of(Mapping& mapping, const TestRocks& rocks) {
    Stencils stencils;
    mapping.build(rocks.shapes(), stencils);
    return stencils;
}

/// A mesh with its mapping, on one rank.
struct Bench {
    explicit Bench(SyntheticMesh m, NodeView view = NodeView::all_nodes)
        : mesh(std::move(m)), mapping(mesh.cells(), mesh.steel(), testing::unit_turn(), KernelSettings{}, serial, view) {}
    SyntheticMesh mesh;
    SerialCommunicator serial;
    Mapping mapping;

    Stencils build(const TestRocks& rocks) { return stencils_of(mapping, rocks); }
    double normalisation(const Stencils& s) { return normalisation_error(s, mesh.volumes, serial); }
    std::vector<double> solid_fraction(const TestRocks& rocks) {
        std::vector<double> f(mesh.size(), 0.0);
        deposit(build(rocks), rocks.volumes(), f);
        return f;
    }
    /// Absolute position of a cell at a rotor angle.
    Vec3 centre(std::size_t c, double angle) const {
        return mesh.in_rotor[c] != 0 ? rotate_about(RotationAxis{}, angle, mesh.centres[c]) : mesh.centres[c];
    }
    Vec3 centroid(const Stencils& s, double angle = 0.0) const {
        Vec3 sum = Vec3::Zero();
        for (std::size_t i = 0; i < s.cell.size(); ++i) {
            const auto c = static_cast<std::size_t>(s.cell[i]);
            sum += s.deposit[i] * mesh.volumes[c] * centre(c, angle);
        }
        return sum;
    }
};

SyntheticMesh cube(double half, double dx) {
    SyntheticMesh mesh;
    mesh.add_box(Vec3::Constant(-half), Vec3::Constant(half), dx, false);
    return mesh;
}

class RockOverCell : public ::testing::TestWithParam<double> {};

TEST_P(RockOverCell, keeps_volume_and_centroid_in_the_interior) {
    const double dx = 0.01, d = GetParam() * dx;
    const double reach = 3.0 * std::max(d, 1.5 * dx);
    Bench bench(cube(std::ceil((reach + dx) / dx) * dx, dx));
    for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(0.3, 0.1, -0.2), Vec3(0.5, 0.5, 0.5), Vec3(-0.37, 0.5, 0.11)}) {
        const TestRocks rocks = one_rock(shift * dx, d);
        const Stencils stencils = bench.build(rocks);
        EXPECT_LE(bench.normalisation(stencils), 1e-12);
        EXPECT_LE((bench.centroid(stencils) - rocks.position[0]).norm(), 0.05 * d);
        EXPECT_NEAR(stencils.width[0], std::max(d, 1.5 * dx), 1e-12);
    }
}

INSTANTIATE_TEST_SUITE_P(DiameterOverCell, RockOverCell, ::testing::Values(0.2, 0.5, 0.7, 1.0, 1.5, 2.0, 5.0, 10.0));

TEST(Mapping, keeps_volume_at_a_wall_an_edge_and_a_corner) {
    const double dx = 0.01, d = 0.02;
    Bench bench(cube(0.2, dx));
    for (const Vec3& x : {Vec3(0.19, 0, 0), Vec3(0.19, -0.19, 0.003), Vec3(0.19, 0.19, 0.19)}) {
        const Stencils stencils = bench.build(one_rock(x, d));
        EXPECT_LE(bench.normalisation(stencils), 1e-12);
        EXPECT_GT(stencils.cell.size(), 50u);
    }
}

TEST(Mapping, samples_a_linear_field_at_the_rock) {
    const double dx = 0.01;
    Bench bench(cube(0.2, dx));
    const TestRocks rocks = one_rock(Vec3(0.0123, -0.0071, 0.0049), 0.02);
    const Stencils s = bench.build(rocks);
    Vec3 mean = Vec3::Zero();
    for (std::size_t i = 0; i < s.cell.size(); ++i)
        mean += s.sample[i] * dx * dx * dx * bench.mesh.centres[static_cast<std::size_t>(s.cell[i])];
    EXPECT_LE((mean - rocks.position[0]).norm(), 0.02 * dx);
}

TEST(Mapping, gives_the_same_stencils_again_and_new_ones_to_rock_that_moved) {
    const double dx = 0.01, d = 0.02;
    TestRocks rocks = one_rock(Vec3(0.0123, -0.0071, 0.0049), d);
    rocks.add(Vec3(-0.05, 0.02, 0.0), d);
    Bench bench(cube(0.2, dx));
    const Stencils first = bench.build(rocks);
    const Stencils again = bench.build(rocks);
    EXPECT_EQ(again.cell, first.cell);
    EXPECT_EQ(again.deposit, first.deposit);
    EXPECT_EQ(again.sample, first.sample);

    rocks.position[1].x() += 0.3 * dx;
    const Stencils moved = bench.build(rocks);
    const Stencils expected = Bench(cube(0.2, dx)).build(rocks);
    EXPECT_NE(moved.deposit, first.deposit);
    EXPECT_EQ(moved.cell, expected.cell);
    EXPECT_EQ(moved.deposit, expected.deposit);
    EXPECT_EQ(moved.sample, expected.sample);
    EXPECT_EQ(bench.build(TestRocks()).size(), 0u);
}

class FromNodes : public ::testing::TestWithParam<NodeView> {};
INSTANTIATE_TEST_SUITE_P(Views, FromNodes, ::testing::Values(NodeView::all_nodes, NodeView::one_node));

/// What is kept of cells and nodes while rock travels and the mesh turns must not show in the result.
TEST_P(FromNodes, rock_that_travelled_is_mapped_as_rock_that_appeared) {
    const auto mesh = [] {
        SyntheticMesh m;
        m.add_annulus(0.05, 0.2, 15, 90, -0.12, 0.12, 24, true);
        m.add_annulus(0.2, 0.35, 12, 100, -0.12, 0.12, 20, false);
        m.add_sheet(Vec3(0.06, 0, -0.2), Vec3(0.135, 0, 0), Vec3(0, 0, 0.4), 20, 40, true);
        m.add_sheet(Vec3(0.21, 0.02, -0.2), Vec3(0.1, 0.02, 0), Vec3(0, 0, 0.4), 20, 40, false);
        return m;
    };
    Bench travelled(mesh(), GetParam());
    TestRocks rocks;
    for (int i = 0; i < 8; ++i) rocks.add(Vec3(0.1 + 0.015 * i, 0.02 + 0.002 * i, -0.05 + 0.01 * i), i % 2 == 0 ? 0.03 : 0.012);
    for (int step = 0; step < 60; ++step) {
        const double angle = 0.011 * step;
        for (std::size_t p = 0; p < rocks.id.size(); ++p) rocks.position[p] += 1e-3 * Vec3(0.5, std::sin(0.3 * step + p), 0.4 - 0.1 * p);
        travelled.mapping.set_time(angle);
        const Stencils found = travelled.build(rocks);
        if (step % 12 != 11) continue;
        Bench fresh(mesh(), GetParam());
        fresh.mapping.set_time(angle);
        const Stencils expected = fresh.build(rocks);
        EXPECT_EQ(found.cell, expected.cell) << step;
        EXPECT_EQ(found.width, expected.width) << step;
        EXPECT_EQ(found.deposit, expected.deposit) << step;
        EXPECT_EQ(found.sample, expected.sample) << step;
        EXPECT_EQ(found.zone, expected.zone) << step;
    }
}

/// The far one has no cell within its kernel; the near one has some within it, but none that it could see the flow of.
TEST(Mapping, leaves_rock_out_that_has_no_cells) {
    Bench bench(cube(0.2, 0.01));
    TestRocks rocks = one_rock(Vec3(0.5, 0, 0), 0.02);
    rocks.add(Vec3::Zero(), 0.02);
    rocks.add(Vec3(0.25, 0, 0), 0.02);
    const Stencils stencils = bench.build(rocks);
    EXPECT_EQ(stencils.without_cells, (std::vector<std::size_t>{0, 2}));
    EXPECT_EQ(stencils.first[1], stencils.first[0]);
    EXPECT_GT(stencils.first[2], stencils.first[1]);
    EXPECT_EQ(stencils.first[3], stencils.first[2]);
    for (const double weight : stencils.deposit) EXPECT_TRUE(std::isfinite(weight));
    for (const double weight : stencils.sample) EXPECT_TRUE(std::isfinite(weight));
    EXPECT_FALSE(bench.mapping.had_hidden_rock());
    EXPECT_THROW(bench.mapping.require_cells(rocks.shapes(), stencils), CheckFailure);
}

/// A box cut by a blade without thickness in the plane x = 0 below z = 0.
SyntheticMesh bladed_box(double half, double dx, bool rotor_zone = false) {
    SyntheticMesh mesh;
    mesh.add_box(Vec3::Constant(-half), Vec3::Constant(half), dx, rotor_zone);
    mesh.add_sheet(Vec3(0, -2 * half, -2 * half), Vec3(0, 4 * half, 0), Vec3(0, 0, 2 * half), 40, 20, rotor_zone);
    return mesh;
}

TEST_P(FromNodes, a_thin_blade_has_nothing_behind_it) {
    const double d = 0.02;
    for (const double dx : {0.005, 0.01, 0.02}) {
        Bench bench(bladed_box(0.2, dx), GetParam());
        for (const Vec3& x : {Vec3(-0.51 * d, 0, -0.15), Vec3(-0.6 * d, 0.033, -0.1501), Vec3(-1.3 * d, 0.01, -0.14)}) {
            const Stencils s = bench.build(one_rock(x, d));
            EXPECT_LE(bench.normalisation(s), 1e-12);
            for (const std::int32_t c : s.cell) ASSERT_LT(bench.mesh.centres[static_cast<std::size_t>(c)][0], 0.0);
        }
    }
}

TEST_P(FromNodes, a_thin_blade_that_turns_has_nothing_behind_it_at_any_angle) {
    // Blade in the rotor, from the axis to the interface; rock on its leading side, cells of both zones around.
    SyntheticMesh mesh;
    mesh.add_annulus(0.02, 0.2, 18, 90, -0.15, 0.15, 30, true);
    mesh.add_annulus(0.2, 0.3, 10, 120, -0.15, 0.15, 30, false);
    mesh.add_sheet(Vec3(0.0, 0, -0.2), Vec3(0.195, 0, 0), Vec3(0, 0, 0.4), 20, 40, true);
    Bench bench(std::move(mesh), GetParam());
    for (const double angle : {0.0, 0.013, 0.4, 1.234, 3.0}) {
        bench.mapping.set_time(angle);
        const Vec3 x = rotate_about(RotationAxis{}, angle, Vec3(0.15, 0.012, 0.004));
        const Stencils s = bench.build(one_rock(x, 0.02));
        EXPECT_LE(bench.normalisation(s), 1e-12);
        bool saw_stator = false;
        for (const std::int32_t cell : s.cell) {
            const auto c = static_cast<std::size_t>(cell);
            const Vec3 in_rotor = rotate_about(RotationAxis{}, -angle, bench.centre(c, angle));
            saw_stator = saw_stator || bench.mesh.in_rotor[c] == 0;
            if (in_rotor.head<2>().norm() < 0.195) {
                ASSERT_GT(in_rotor[1], 0.0) << angle;
            }
        }
        EXPECT_TRUE(saw_stator);
    }
}

/// Of a flow that goes around the edge of a blade. A node is at most half a diagonal of the lattice, 0.8 sigma, from the rock, and only
/// cells past the edge are judged otherwise from there.
TEST(OneNode, samples_nearly_what_all_nodes_do) {
    const double d = 0.02, half = 0.15;
    Bench all(bladed_box(half, 0.01)), one(bladed_box(half, 0.01), NodeView::one_node);
    const auto flow = [](const Vec3& x) { return Vec3(-x[2], 0.0, x[0]); };
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-2.0 * d, 2.0 * d);
    TestRocks rocks;
    while (rocks.id.size() < 200) {
        const Vec3 x(place(random), place(random), place(random));
        if (x[2] > 0.5 * d || std::abs(x[0]) > 0.5 * d) rocks.add(x, d);  // outside the blade
    }
    const Stencils of_all = all.build(rocks), of_one = one.build(rocks);
    EXPECT_LE(one.normalisation(of_one), 1e-12);
    const auto sampled = [&](const Stencils& s, std::size_t p) {
        Vec3 sum = Vec3::Zero();
        for (std::size_t i = s.first[p]; i < s.first[p + 1]; ++i) {
            const auto c = static_cast<std::size_t>(s.cell[i]);
            sum += s.sample[i] * all.mesh.volumes[c] * flow(all.mesh.centres[c]);
        }
        return sum;
    };
    double squares = 0.0, largest = 0.0;
    for (std::size_t p = 0; p < rocks.id.size(); ++p) {
        const double difference = (sampled(of_one, p) - sampled(of_all, p)).norm();
        squares += difference * difference;
        largest = std::max(largest, difference);
    }
    EXPECT_GT(largest, 0.0);                                                        // they are not the same view
    EXPECT_LE(std::sqrt(squares / static_cast<double>(rocks.id.size())), 0.1 * d);  // of a shear of 1/s
    EXPECT_LE(largest, 0.5 * d);
}

/// Largest solid volume that moves between cells in one step along a path, over the rock's volume, and the largest change of a cell.
struct StepChange {
    double moved = 0.0, largest = 0.0;
};

StepChange change_along(Bench& bench, const Vec3& from, const Vec3& to, double step, double d) {
    StepChange change;
    std::vector<double> before;
    const int n = static_cast<int>(std::ceil((to - from).norm() / step));
    for (int i = 0; i <= n; ++i) {
        const std::vector<double> now = bench.solid_fraction(one_rock(from + (to - from) * i / n, d));
        double moved = 0.0;
        for (std::size_t c = 0; c < before.size(); ++c) {
            moved += 0.5 * std::abs(now[c] - before[c]) * bench.mesh.volumes[c] / sphere_volume(d);
            change.largest = std::max(change.largest, std::abs(now[c] - before[c]));
        }
        change.moved = std::max(change.moved, moved);
        before = now;
    }
    return change;
}

struct EdgePassage {
    double d, dx, step;  ///< step over min(sigma, dx)
};

class PassingAnEdge : public ::testing::TestWithParam<EdgePassage> {};

TEST_P(PassingAnEdge, changes_the_void_fraction_at_most_twice_as_fast_as_open_water) {
    const auto [d, dx, step_share] = GetParam();
    const double sigma = std::max(d, 1.5 * dx), half = std::ceil((4.5 * sigma) / dx) * dx;
    Bench bladed(bladed_box(half, dx)), open(cube(half, dx));
    const double step = step_share * std::min(sigma, dx);
    const Vec3 paths[][2] = {{Vec3(-1.2 * sigma, 0.3 * dx, 0.6 * d), Vec3(1.2 * sigma, 0.3 * dx, 0.6 * d)},
                             {Vec3(-0.6 * d, 0.3 * dx, -1.2 * sigma), Vec3(-0.6 * d, 0.3 * dx, 1.2 * sigma)}};
    for (const auto& path : paths) {
        const StepChange past_edge = change_along(bladed, path[0], path[1], step, d);
        const StepChange in_open = change_along(open, path[0], path[1], step, d);
        EXPECT_LE(past_edge.moved, 2.0 * in_open.moved);
        EXPECT_LE(past_edge.largest, 3.0 * in_open.largest);
    }
}

// The last ones take steps of a fiftieth: a jump, which does not shrink with the step, would show.
INSTANTIATE_TEST_SUITE_P(Sizes, PassingAnEdge,
                         ::testing::Values(EdgePassage{0.02, 0.01, 0.25}, EdgePassage{0.02, 0.02, 0.25}, EdgePassage{0.01, 0.01, 0.25},
                                           EdgePassage{0.02, 0.01, 0.02}, EdgePassage{0.02, 0.02, 0.02}));

TEST(RockInSteel, is_mapped_from_the_nearest_cell_on_its_side) {
    // A solid plate of 6 mm; the rock's centre lies 1 mm below its upper face, as when mesh and wall differ a little.
    SyntheticMesh mesh;
    mesh.add_box(Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.1), 0.01, false);
    mesh.add_sheet(Vec3(-0.2, -0.2, 0.003), Vec3(0.4, 0, 0), Vec3(0, 0.4, 0), 20, 20, false);
    mesh.add_sheet(Vec3(-0.2, -0.2, -0.003), Vec3(0.4, 0, 0), Vec3(0, 0.4, 0), 20, 20, false);
    Bench bench(std::move(mesh));
    const Stencils s = bench.build(one_rock(Vec3(0.002, 0.001, 0.002), 0.004));
    EXPECT_TRUE(bench.mapping.had_hidden_rock());
    EXPECT_EQ(s.hidden, 1u);
    EXPECT_EQ(bench.build(one_rock(Vec3(0.002, 0.001, 0.03), 0.004)).hidden, 0u);
    EXPECT_LE(bench.normalisation(s), 1e-12);
    ASSERT_GT(s.cell.size(), 10u);
    for (const std::int32_t c : s.cell) EXPECT_GT(bench.mesh.centres[static_cast<std::size_t>(c)][2], 0.003);
}

/// Six sheets around a box.
void add_sheets_around(SyntheticMesh& mesh, const Vec3& low, const Vec3& high) {
    const Vec3 size = high - low;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {0.0, 1.0}) {
            const Vec3 a = size[(axis + 1) % 3] * Vec3::Unit((axis + 1) % 3), b = size[(axis + 2) % 3] * Vec3::Unit((axis + 2) % 3);
            mesh.add_sheet(low + side * size[axis] * Vec3::Unit(axis), a, b, 4, 4, false);
        }
}

/// Two cells of 6 mm wide, one high, `length` long.
SyntheticMesh box_with_a_nook(double length) {
    SyntheticMesh mesh = cube(0.12, 0.006);
    add_sheets_around(mesh, Vec3(-0.06, 0.0, 0.0), Vec3(-0.06 + length, 0.012, 0.006));
    return mesh;
}

TEST(CrampedRock, finds_room_behind_the_steel_of_a_nook) {
    Bench bench(box_with_a_nook(0.012));                                    // 0.9e-6 m3
    const TestRocks rocks = one_rock(Vec3(-0.0545, 0.006, 0.0035), 0.018);  // 3.1e-6 m3
    Stencils stencils = bench.build(rocks);
    EXPECT_TRUE(bench.mapping.had_cramped_rock());
    EXPECT_EQ(stencils.cramped, 1u);
    EXPECT_EQ(stencils.hidden, 0u);
    Stencils* const all[] = {&stencils};
    const auto f = redistribute(all, rocks.volumes(), bench.mesh.volumes, 0.7, bench.serial)[0];
    EXPECT_LE(*std::max_element(f.begin(), f.end()), 0.7);
    EXPECT_LE(bench.normalisation(stencils), 1e-12);
}

/// Towards the nook's end it sees less and less: what it lays behind the steel grows without a jump.
TEST(CrampedRock, moves_in_a_nook_without_a_jump) {
    Bench nook(box_with_a_nook(0.12)), open(cube(0.12, 0.006));
    const Vec3 from(0.0, 0.006, 0.0035), to(-0.0545, 0.006, 0.0035);
    const double d = 0.018, step = 0.02 * d;
    const StepChange in_nook = change_along(nook, from, to, step, d), in_open = change_along(open, from, to, step, d);
    EXPECT_TRUE(nook.mapping.had_cramped_rock());
    EXPECT_LE(in_nook.moved, 2.0 * in_open.moved);
}

TEST(CrampedRock, is_no_rock_beside_steel_with_room_on_its_side) {
    Bench bench(box_with_a_nook(0.012));
    EXPECT_EQ(bench.build(one_rock(Vec3(-0.054, -0.0095, 0.006), 0.018)).cramped, 0u);
    EXPECT_FALSE(bench.mapping.had_cramped_rock());
}

/// Rotor and stator of an annulus with cells that differ in size across the interface at r = 0.2.
SyntheticMesh annulus() {
    SyntheticMesh mesh;
    mesh.add_annulus(0.05, 0.2, 15, 90, -0.12, 0.12, 24, true);
    mesh.add_annulus(0.2, 0.35, 12, 100, -0.12, 0.12, 20, false);
    return mesh;
}

TEST(RotorInterface, leaves_volume_and_centroid_alone_at_any_angle) {
    Bench bench(annulus());
    const double d = 0.02;
    for (const double radius : {0.185, 0.195, 0.2, 0.2001, 0.21, 0.225})
        for (int i = 0; i < 24; ++i) {
            const double angle = 0.37 * i;
            bench.mapping.set_time(angle);
            const TestRocks rocks = one_rock(Vec3(radius * std::cos(0.1), radius * std::sin(0.1), 0.003), d);
            const Stencils s = bench.build(rocks);
            ASSERT_LE(bench.normalisation(s), 1e-12);
            ASSERT_LE((bench.centroid(s, angle) - rocks.position[0]).norm(), 0.05 * d) << radius << ' ' << angle;
        }
}

TEST(RotorInterface, lets_the_solid_of_rock_at_rest_turn_past_smoothly) {
    // What a stator cell holds of a rock that rests in the stator must not depend on where the rotor stands.
    Bench bench(annulus());
    const TestRocks rocks = one_rock(Vec3(0.215, 0.01, 0.003), 0.02);
    std::vector<double> lowest(bench.mesh.size(), 1.0), highest(bench.mesh.size(), 0.0);
    double largest = 0.0;
    for (int i = 0; i < 40; ++i) {
        bench.mapping.set_time(0.0017 * i);
        const auto f = bench.solid_fraction(rocks);
        for (std::size_t c = 0; c < f.size(); ++c) {
            if (bench.mesh.in_rotor[c] != 0) continue;
            lowest[c] = std::min(lowest[c], f[c]);
            highest[c] = std::max(highest[c], f[c]);
            largest = std::max(largest, f[c]);
        }
    }
    for (std::size_t c = 0; c < lowest.size(); ++c)
        if (bench.mesh.in_rotor[c] == 0) {
            EXPECT_LE(highest[c] - lowest[c], 0.01 * largest);
        }
}

/// Largest second difference of any cell's solid fraction along a straight path.
double second_difference(Bench& bench, const Vec3& from, const Vec3& direction, double step, int steps, double d) {
    std::vector<double> before, middle;
    double largest = 0.0;
    for (int i = 0; i < steps; ++i) {
        std::vector<double> now = bench.solid_fraction(one_rock(from + i * step * direction, d));
        for (std::size_t c = 0; c < before.size(); ++c) largest = std::max(largest, std::abs(now[c] - 2.0 * middle[c] + before[c]));
        before = std::move(middle);
        middle = std::move(now);
    }
    return largest;
}

TEST(MovingRock, changes_the_void_fraction_smoothly_in_time) {
    // Slopes that jump would shrink the second difference with the step only, values that jump not at all; smooth ones with its square.
    Bench bench(cube(0.12, 0.01));
    const Vec3 from(-0.006, 0.0031, 0.0017), direction(1.0, 0.2, 0.1);
    const double coarse = second_difference(bench, from, direction, 1e-3, 12, 0.02);
    const double fine = second_difference(bench, from, direction, 1e-3 / 8.0, 96, 0.02);
    EXPECT_LE(fine, coarse / 40.0);
}

TEST(MovingRock, crosses_the_rotor_interface_without_a_jump) {
    Bench bench(annulus());
    bench.mapping.set_time(0.3);
    const Vec3 from(0.185, 0.0031, 0.0017), direction(1.0, 0.2, 0.1);
    const double coarse = second_difference(bench, from, direction, 1e-3, 30, 0.02);
    const double fine = second_difference(bench, from, direction, 1e-3 / 8.0, 240, 0.02);
    EXPECT_LE(fine, coarse / 7.0);
}

TEST(RotorInterface, is_no_step_in_the_size_field) {
    Bench bench(annulus());
    const ZoneFrames frames(testing::unit_turn(), 0.7);
    SizeField::Vicinity vicinity;
    double before = bench.mapping.sizes().around(frames, Vec3(0.15, 0, 0), vicinity).size;
    for (double r = 0.15; r < 0.25; r += 1e-4) {
        const double size = bench.mapping.sizes().around(frames, Vec3(r, 0, 0), vicinity).size;
        SizeField::Vicinity unknown;
        EXPECT_EQ(size, bench.mapping.sizes().around(frames, Vec3(r, 0, 0), unknown).size);
        EXPECT_LE(std::abs(size - before), 0.2 * 1e-4);
        EXPECT_GT(size, 0.009);
        EXPECT_LT(size, 0.018);
        before = size;
    }
}

TEST(Ranks, share_the_cells_without_a_trace) {
    const SyntheticMesh whole = [] {
        SyntheticMesh mesh = annulus();
        mesh.add_sheet(Vec3(0.06, 0, -0.2), Vec3(0.135, 0, 0), Vec3(0, 0, 0.4), 20, 40, true);
        mesh.add_sheet(Vec3(0.21, 0.02, -0.2), Vec3(0.1, 0.02, 0), Vec3(0, 0, 0.4), 20, 40, false);
        // A nook that the ranks share, with a rock that fills it.
        add_sheets_around(mesh, Vec3(-0.17, 0.004, -0.01), Vec3(-0.15, 0.016, 0.01));
        return mesh;
    }();
    TestRocks rocks;
    rocks.add(Vec3(-0.16, 0.0098, 0.0), 0.02);
    for (int i = 0; i < 12; ++i) rocks.add(Vec3(0.12 + 0.011 * i, 0.013 + 0.001 * i, -0.05 + 0.009 * i), i % 3 == 0 ? 0.03 : 0.02);
    const double angle = 0.11;
    SerialCommunicator serial;
    Mapping one(whole.cells(), whole.steel(), testing::unit_turn(), KernelSettings{}, serial);
    one.set_time(angle);
    std::vector<double> expected(whole.size(), 0.0);
    const Stencils stencils = stencils_of(one, rocks);
    EXPECT_TRUE(one.had_cramped_rock());
    EXPECT_EQ(stencils.cramped, 1u);
    deposit(stencils, rocks.volumes(), expected);
    std::vector<double> expected_sample(rocks.id.size(), 0.0);
    for (std::size_t p = 0; p < rocks.id.size(); ++p)
        for (std::size_t i = stencils.first[p]; i < stencils.first[p + 1]; ++i) {
            const auto c = static_cast<std::size_t>(stencils.cell[i]);
            expected_sample[p] += stencils.sample[i] * whole.volumes[c] * whole.centres[c][0];
        }

    std::vector<double> found(whole.size(), 0.0), found_sample(rocks.id.size(), 0.0);
    testing::ThreadedRanks(2).run([&](Communicator& communicator) {
        std::vector<std::size_t> mine;
        const SyntheticMesh part = whole.part([&](std::size_t c) {
            const bool is_mine = (whole.centres[c][1] > 0.01 ? 1 : 0) == communicator.rank();
            if (is_mine) mine.push_back(c);
            return is_mine;
        });
        Mapping mapping(part.cells(), part.steel(), testing::unit_turn(), KernelSettings{}, communicator);
        mapping.set_time(angle);
        std::vector<double> f(part.size(), 0.0);
        const Stencils s = stencils_of(mapping, rocks);
        deposit(s, rocks.volumes(), f);
        for (std::size_t c = 0; c < mine.size(); ++c) found[mine[c]] = f[c];
        std::vector<double> sample(rocks.id.size(), 0.0);
        for (std::size_t p = 0; p < rocks.id.size(); ++p)
            for (std::size_t i = s.first[p]; i < s.first[p + 1]; ++i) {
                const auto c = static_cast<std::size_t>(s.cell[i]);
                sample[p] += s.sample[i] * part.volumes[c] * part.centres[c][0];
            }
        communicator.sum(sample);
        if (communicator.rank() == 0) found_sample = sample;
        EXPECT_LE(normalisation_error(s, part.volumes, communicator), 1e-12);
    });
    for (std::size_t c = 0; c < whole.size(); ++c) ASSERT_NEAR(found[c], expected[c], 1e-12);
    for (std::size_t p = 0; p < rocks.id.size(); ++p) EXPECT_NEAR(found_sample[p], expected_sample[p], 1e-12);
}

/// A turning drum of cubes of 10 mm in cells at rest, with soil below a level top.
SyntheticMesh drum_over_ground(double ground) {
    SyntheticMesh mesh;
    const auto is_in_drum = [](const Vec3& x) { return x.head<2>().norm() < 0.1; };
    mesh.add_box(Vec3::Constant(-0.15), Vec3::Constant(0.15), 0.01, true, is_in_drum);
    mesh.add_box(Vec3::Constant(-0.15), Vec3::Constant(0.15), 0.01, false, [&](const Vec3& x) { return !is_in_drum(x); });
    mesh.add_box_of_soil(Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, ground));
    return mesh;
}

TEST(Mapping, lays_nothing_into_soil_and_half_as_much_into_a_cell_a_quarter_of_which_is_soil) {
    const double ground = -0.0275, d = 0.02;  // a quarter of a cell below the centres of a layer
    Bench bench(drum_over_ground(ground));
    bench.mapping.set_time(0.4);
    Bench open_water(cube(0.15, 0.01));
    const Vec3 rock(0.06, 0.0, ground + 0.5 * d);
    const Stencils stencils = bench.build(one_rock(rock, d)), free = open_water.build(one_rock(rock, d));
    EXPECT_LE(bench.normalisation(stencils), 1e-12);
    double half = 0.0, whole = 0.0, half_free = 0.0, whole_free = 0.0;
    const auto weigh = [&](const Bench& of, const Stencils& s, double& in_half, double& in_whole) {
        for (std::size_t i = 0; i < s.cell.size(); ++i) {
            const auto c = static_cast<std::size_t>(s.cell[i]);
            const double height = of.mesh.centres[c][2] - ground;
            const double laid = s.deposit[i] * of.mesh.volumes[c];
            (height < 0.005 ? in_half : in_whole) += height > 0.0 ? laid : 0.0;
            if (&of == &bench) {
                EXPECT_GT(height, 0.0) << "soil";
            }
        }
    };
    weigh(bench, stencils, half, whole);
    weigh(open_water, free, half_free, whole_free);
    EXPECT_NEAR(half / whole, 0.5 * half_free / whole_free, 0.02 * half / whole) << "the drum is turned against its surroundings";
}

TEST(Mapping, of_a_rock_deep_in_soil_lays_it_there) {
    Bench bench(drum_over_ground(0.09));
    const Stencils stencils = bench.build(one_rock(Vec3(0.02, 0.0, 0.0), 0.005));
    EXPECT_LE(bench.normalisation(stencils), 1e-12);
    EXPECT_TRUE(bench.mapping.had_hidden_rock());
}

/// Rock in a row across four ranks, each of which has a slab of cells as wide as half of what a kernel spans.
class FourSlabs : public ::testing::Test {
protected:
    FourSlabs() {
        for (int i = 0; i < 37; ++i) rocks.add(Vec3(-0.18 + 0.01 * i, 0.001 * i, 0.0), 0.02);
    }
    void on_each_rank(const std::function<void(Mapping&, Communicator&)>& check) {
        testing::ThreadedRanks(4).run([&](Communicator& communicator) {
            const SyntheticMesh part = whole.part(
                [&](std::size_t c) { return static_cast<int>(std::floor(whole.centres[c].x() / 0.1)) + 2 == communicator.rank(); });
            Mapping mapping(part.cells(), part.steel(), {}, KernelSettings{}, communicator);
            check(mapping, communicator);
        });
    }
    SyntheticMesh whole = cube(0.2, 0.01);
    TestRocks rocks;
};

TEST_F(FourSlabs, sum_over_the_ranks_near_to_a_rock_as_over_all) {
    on_each_rank([&](Mapping& mapping, Communicator& communicator) {
        const SharedRocks shared = stencils_of(mapping, rocks).shared;
        EXPECT_LT(shared.near().size(), rocks.id.size());
        std::vector<double> values(2 * rocks.id.size(), 0.0), leaders(rocks.id.size(), 0.0);
        for (const std::size_t p : shared.near())
            for (const std::size_t k : {0, 1}) values[2 * p + k] = 0.1 * communicator.rank() + static_cast<double>(p * p + k);
        for (const std::size_t p : shared.led()) leaders[p] = 1.0;
        std::vector<double> expected = values;
        communicator.sum(expected);
        communicator.sum(leaders);
        shared.sum(values, 2, communicator);
        for (const std::size_t p : shared.near())
            for (const std::size_t k : {0, 1}) EXPECT_DOUBLE_EQ(values[2 * p + k], expected[2 * p + k]);
        for (const double leader : leaders) EXPECT_EQ(leader, 1.0);
    });
}

TEST_F(FourSlabs, know_of_every_rock_that_has_no_cell) {
    rocks.add(Vec3(0.5, 0.0, 0.0), 0.02);
    on_each_rank([&](Mapping& mapping, Communicator&) {
        const Stencils stencils = stencils_of(mapping, rocks);
        EXPECT_EQ(stencils.without_cells, std::vector<std::size_t>{rocks.id.size() - 1});
        EXPECT_THROW(mapping.require_cells(rocks.shapes(), stencils), CheckFailure);
    });
}

TEST(Redistribution, makes_room_and_keeps_every_rocks_volume) {
    // Rock packed at 0.63 into a corner: the kernels, cut by three walls, overfill the cells there.
    Bench bench(cube(0.1, 0.01));
    TestRocks rocks;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
            for (int k = 0; k < 6; ++k) rocks.add(Vec3::Constant(0.091) - 0.0168 * Vec3(i, j, k), 0.018);
    Stencils stencils = bench.build(rocks);
    std::vector<double> before(bench.mesh.size(), 0.0);
    deposit(stencils, rocks.volumes(), before);
    ASSERT_GT(*std::max_element(before.begin(), before.end()), 0.7);

    Stencils* const all[] = {&stencils};
    const auto after = redistribute(all, rocks.volumes(), bench.mesh.volumes, 0.7, bench.serial)[0];
    EXPECT_LE(*std::max_element(after.begin(), after.end()), 0.7);
    EXPECT_LE(bench.normalisation(stencils), 1e-12);
    const auto volumes = rocks.volumes();
    const double rock = std::accumulate(volumes.begin(), volumes.end(), 0.0);
    double mesh = 0.0;
    for (std::size_t c = 0; c < after.size(); ++c) mesh += after[c] * bench.mesh.volumes[c];
    EXPECT_NEAR(mesh / rock, 1.0, 1e-12);
}

TEST(Sampling, is_near_to_the_rock_or_clear_of_it) {
    const SyntheticMesh mesh = cube(0.1, 0.01);
    const TestRocks rocks = one_rock(Vec3(0.003, 0.002, 0.001), 0.02);
    SerialCommunicator serial;
    KernelSettings kernel;
    kernel.sampling = k_quadratic_sampling;
    Mapping shell(mesh.cells(), mesh.steel(), testing::unit_turn(), kernel, serial);
    kernel.sampling = k_gaussian_sampling;
    Mapping near(mesh.cells(), mesh.steel(), testing::unit_turn(), kernel, serial);
    const Stencils far_away = stencils_of(shell, rocks), nearer = stencils_of(near, rocks);
    EXPECT_EQ(far_away.deposit, nearer.deposit);
    const auto within_a_width = [&](const Stencils& s) {
        double share = 0.0;
        for (std::size_t i = 0; i < s.cell.size(); ++i) {
            const auto c = static_cast<std::size_t>(s.cell[i]);
            if ((mesh.centres[c] - rocks.position[0]).norm() < 0.02) share += s.sample[i] * mesh.volumes[c];
        }
        return share;
    };
    EXPECT_LT(within_a_width(far_away), 0.02);
    EXPECT_GT(within_a_width(nearer), 0.85);
}

TEST(Redistribution, leaves_dilute_rock_alone) {
    Bench bench(cube(0.1, 0.01));
    const TestRocks rocks = one_rock(Vec3(0.01, 0.02, 0.03), 0.02);
    Stencils stencils = bench.build(rocks);
    const Stencils before = stencils;
    Stencils* const all[] = {&stencils};
    redistribute(all, rocks.volumes(), bench.mesh.volumes, 0.7, bench.serial);
    EXPECT_EQ(stencils.deposit, before.deposit);
}

TEST(Redistribution, reports_what_cannot_be_placed_and_still_conserves) {
    // More rock than 0.7 of a closed box can hold.
    Bench bench(cube(0.03, 0.01));
    TestRocks rocks;
    for (int i = 0; i < 60; ++i) rocks.add(Vec3(0.001 * (i % 7), 0.001 * (i % 5), 0.0), 0.018);
    Stencils stencils = bench.build(rocks);
    Stencils* const all[] = {&stencils};
    const auto f = redistribute(all, rocks.volumes(), bench.mesh.volumes, 0.7, bench.serial)[0];
    EXPECT_GT(*std::max_element(f.begin(), f.end()), 0.7);
    EXPECT_LE(bench.normalisation(stencils), 1e-12);
}

}  // namespace
}  // namespace cutterflow::coupling
