// What is kept from one position of the mesh to the next changes nothing.
#include <random>

#include <gtest/gtest.h>

#include "solver/ports/testing/synthetic_mesh.hpp"
#include "solver/space/visibility.hpp"

namespace cutterflow::coupling {
namespace {

/// A still and a turning zone of 4,000 random cells each, with a random facet of steel here and there in both.
testing::SyntheticMesh random_mesh() {
    testing::SyntheticMesh mesh;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> place(-1.0, 1.0), size(-0.3, 0.3);
    const auto point = [&](auto& distribution) { return Vec3(distribution(random), distribution(random), distribution(random)); };
    for (int c = 0; c < 8000; ++c) mesh.add_cell(point(place), 1e-3, 0.1, c % 2 != 0);
    for (std::vector<SteelTriangle>* steel : {&mesh.stator_steel, &mesh.rotor_steel})
        for (int t = 0; t < 40; ++t) {
            const Vec3 a = point(place);
            steel->push_back({a, a + point(size), a + point(size)});
        }
    return mesh;
}

/// Visible fraction of every cell from a place, the nearer ones than `reach`.
std::vector<double> seen_from(Visibility& visibility, const CellTrees& trees, const ZoneFrames& frames, const Vec3& place, double reach) {
    visibility.look_from(place, reach, 0.1);
    std::vector<double> seen;
    for (std::int32_t cell = 0; cell < 8000; ++cell) {
        const auto zone = static_cast<Zone>(trees.cells().zone[static_cast<std::size_t>(trees.number(cell))]);
        const bool is_near = (trees.centre(cell) - frames.from_absolute(zone, place)).norm() < reach;
        seen.push_back(is_near ? visibility.visible_fraction(cell) : -1.0);
    }
    return seen;
}

// Small turns, by which the cells near a node stay the same, one large turn, and a turn back.
TEST(Visibility, of_cells_that_pass_is_that_of_a_mesh_just_made) {
    const testing::SyntheticMesh mesh = random_mesh();
    const std::vector<ZoneMotion> moving{{{Vec3(0.1, 0.0, 0.0), Vec3(0.0, 0.6, 0.8)}, 1.0, "rotor"}};
    const CellTrees trees(mesh.cells(), 2);
    Visibility kept(mesh.steel(), trees, ZoneFrames(moving, 0.0));
    int dimmed = 0;
    for (const double time : {0.0, 0.01, 0.02, 0.03, 0.08, 0.5, 0.51, 0.02}) {
        const ZoneFrames frames(moving, time);
        kept.set_frames(frames);
        Visibility fresh(mesh.steel(), trees, frames);
        for (const double reach : {0.35, 0.45})  // the second look asks for more of the same nodes
            for (const Vec3& place : {Vec3(0.3, 0.1, 0.2), Vec3(-0.2, 0.4, -0.1), Vec3(0.1, -0.3, 0.45)}) {
                const std::vector<double> seen = seen_from(kept, trees, frames, place, reach);
                const std::vector<double> expected = seen_from(fresh, trees, frames, place, reach);
                for (std::size_t cell = 0; cell < seen.size(); ++cell) {
                    ASSERT_NEAR(seen[cell], expected[cell], 1e-12) << "time " << time << ", cell " << cell;
                    if (seen[cell] >= 0.0 && seen[cell] < 1.0) ++dimmed;
                }
            }
    }
    EXPECT_GT(dimmed, 1000) << "steel hides some of them";
}

// A cell at the node's side of the steel is in view, one behind it is not, at every turn.
TEST(Visibility, of_a_turning_plate_hides_what_is_behind_it) {
    testing::SyntheticMesh mesh;
    for (int i = -10; i <= 10; ++i)
        for (int j = -10; j <= 10; ++j) mesh.add_cell(Vec3(0.1 * i, 0.1 * j, 0.013), 1e-3, 0.1, false);
    mesh.rotor_steel.push_back({Vec3(0.0, -9.0, -9.0), Vec3(0.0, 9.0, -9.0), Vec3(0.0, 0.0, 18.0)});
    const CellTrees trees(mesh.cells(), 2);
    Visibility visibility(mesh.steel(), trees, ZoneFrames(testing::unit_turn(), 0.0));
    for (int step = 0; step < 60; ++step) {
        const double angle = 0.02 * step;
        const ZoneFrames frames(testing::unit_turn(), angle);
        visibility.set_frames(frames);
        const Vec3 normal(std::cos(angle), std::sin(angle), 0.0), rock = 0.5 * normal;
        visibility.look_from(rock, 0.9, 0.05);
        for (std::int32_t cell = 0; cell < static_cast<std::int32_t>(mesh.size()); ++cell) {
            const Vec3& centre = trees.centre(cell);
            const double height = centre.dot(normal);
            if ((centre - rock).norm() >= 0.9 || std::abs(height) < 1e-9) continue;
            EXPECT_EQ(visibility.visible_fraction(cell), height > 0.0 ? 1.0 : 0.0) << "angle " << angle << ", cell " << centre.transpose();
        }
    }
}

}  // namespace
}  // namespace cutterflow::coupling
