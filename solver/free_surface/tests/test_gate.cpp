/// Gates: closed they hold water, rising they let it go later than none, and they draw in the water that they leave room for.
#include <cmath>

#include <gtest/gtest.h>

#include "solver/free_surface/testing/free_bodies.hpp"

namespace cutterflow::free_surface {
namespace {

constexpr double k_cell = 0.01, k_depth = 0.05, k_column = 0.1, k_height = 0.2, k_width = 0.4;

SceneSettings dam() {
    SceneSettings scene;
    scene.tank.cells = {40, 1, 30};
    scene.tank.cell = k_cell;
    scene.tank.depth = k_depth;
    scene.water.filled = {{Vec3(-1, -1, -1), Vec3(k_column, 1, k_height)}};
    return scene;
}

/// Before the column; out of the tank after 0.3 m / speed.
Gate gate(double speed, double start) {
    return {{Vec3(k_column, -1, 0.0), Vec3(k_column + 2.0 * k_cell, 1, 0.25)}, speed, start, start + 0.3 / speed};
}

double front(const SurfaceRun& run) {
    return *std::max_element(run.particles().position[0].begin(), run.particles().position[0].end());
}

/// Time at which the front is half a cell off the far wall; every step must keep the volume.
double arrival(const SceneSettings& scene) {
    SurfaceRun run(scene, nullptr);
    while (front(run) < k_width - 0.5 * k_cell && run.time() < 2.0) {
        run.step();
        EXPECT_NEAR(run.last().occupied_volume / run.initial_volume(), 1.0, 0.02) << run.time();
    }
    return run.time();
}

TEST(Gate, stands_rises_at_its_speed_and_ends) {
    const Gate one = gate(0.5, 0.2);
    EXPECT_DOUBLE_EQ(one.rise(0.1), 0.0);
    EXPECT_DOUBLE_EQ(one.rise(0.4), 0.1);
    EXPECT_DOUBLE_EQ(one.rise(9.0), 0.3);
    EXPECT_DOUBLE_EQ(one.at(0.4).from.z(), 0.1);
    EXPECT_DOUBLE_EQ(one.at(0.4).to.z(), 0.35);
}

/// Wherever it stands in the cells: what it covers is its volume, what it pushes out of cells adds up to nothing and to its section above
/// and below.
TEST(Gate, covers_its_volume_and_pushes_as_much_as_it_draws) {
    const StaggeredGrid grid = dam().tank.grid();
    CellCutter cutter(grid, {});
    CutCells cells;
    for (const double shift : {0.0, 0.0012, 0.0031, 0.0049, 0.0087}) {
        const SolidBox box{Vec3(0.1 + shift, -1, 0.08 + shift), Vec3(0.13 + shift, 1, 0.2 + shift)};
        cutter.set_gates(std::vector<SolidBox>{box});
        cutter.cut({}, cells);
        double covered = 0.0, above = 0.0, sum = 0.0;
        grid.for_each_cell([&](int cell, int, int, int) { covered += (1.0 - cells.open_volume[cell]) * grid.cell_volume(); });
        for (const BodyCell& entry : cells.gates[0]) {
            sum += entry.k.z();
            above += std::max(0.0, -entry.k.z());
        }
        const double sliver = shift < k_smallest_gate_opening * k_cell ? shift : 0.0;  // under the lower edge
        EXPECT_NEAR(covered, 0.03 * (0.12 + sliver) * k_depth, 1e-12) << shift;
        EXPECT_NEAR(above * grid.face_area(), 0.03 * k_depth, 1e-12) << shift;
        EXPECT_NEAR(sum, 0.0, 1e-12) << shift;
    }
}

/// At speed 0 a scene's gate is a box among the solids.
TEST(Gate, closed_keeps_the_water_as_a_wall_does) {
    SceneSettings wall = dam(), closed = dam();
    closed.gates = {gate(1.0, 10.0)};
    wall.solids = {closed.gates[0].closed};
    SurfaceRun run(closed, nullptr), beside_wall(wall, nullptr);
    while (run.time() < 1.0) {
        run.step();
        beside_wall.step();
    }
    EXPECT_LT(front(run), k_column);
    EXPECT_EQ(run.particles().position, beside_wall.particles().position);
}

TEST(Gate, that_rises_delays_the_front_by_less_than_its_lifting_time) {
    const double at_once = arrival(dam());
    double before = at_once;
    for (const double speed : {4.0, 1.0, 0.4}) {
        SceneSettings scene = dam();
        scene.gates = {gate(speed, 0.0)};
        const double late = arrival(scene), lifting = k_height / speed;
        EXPECT_GT(late, before) << speed;
        EXPECT_LT(late - at_once, lifting) << speed;
        before = late;
    }
    SceneSettings later = dam();
    later.gates = {gate(1.0, 0.5)};
    SceneSettings first = dam();
    first.gates = {gate(1.0, 0.0)};
    EXPECT_NEAR(arrival(later), arrival(first) + 0.5, 0.01);
}

TEST(Gate, goes_on_from_a_state_where_it_stood) {
    SceneSettings scene = dam();
    scene.gates = {gate(0.5, 0.05)};
    SurfaceRun whole(scene, nullptr), first(scene, nullptr);
    while (first.time() < 0.2) {
        whole.step();
        first.step();
    }
    SurfaceRun later(scene, nullptr);
    later.restore(first.state());
    for (int n = 0; n < 30; ++n) {
        whole.step();
        later.step();
    }
    EXPECT_EQ(whole.time(), later.time());
    EXPECT_EQ(whole.particles().position, later.particles().position);
    EXPECT_EQ(whole.cells().open_volume, later.cells().open_volume);
}

/// A piston between two walls: its lower face is at the level of the water outside, so that only what it draws rises after it.
TEST(Gate, draws_water_after_it_like_a_piston) {
    SceneSettings scene = dam();
    scene.tank.cells = {30, 1, 30};
    scene.water.filled = {{Vec3(-1, -1, -1), Vec3(1, 1, 0.1)}};
    scene.solids = {SolidBox{Vec3(0.10, -1, 0.05), Vec3(0.12, 1, 1)}, SolidBox{Vec3(0.16, -1, 0.05), Vec3(0.18, 1, 1)}};
    scene.gates = {{{Vec3(0.12, -1, 0.1), Vec3(0.16, 1, 0.25)}, 0.2, 0.1, 0.35}};
    SurfaceRun run(scene, nullptr);
    while (run.time() < 0.35) {
        run.step();
        double drawn = 0.0;
        for (std::size_t p = 0; p < run.particles().size(); ++p) {
            const Vec3 place = run.particles().place(p);
            if (place.z() > 0.1 && place.x() > 0.12 && place.x() < 0.16) drawn += run.particles().volume;
        }
        const double swept = 0.04 * k_depth * scene.gates[0].rise(run.time());
        EXPECT_NEAR(drawn, swept, 0.04 * k_depth * k_cell) << run.time();  // within a cell's height
    }
    EXPECT_NEAR(run.last().occupied_volume / run.initial_volume(), 1.0, 0.02);
}

}  // namespace
}  // namespace cutterflow::free_surface
