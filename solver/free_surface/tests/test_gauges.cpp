/// What is read off a run: levels and pressures at gauges.
#include <gtest/gtest.h>

#include "solver/free_surface/output/scene_gauges.hpp"

namespace cutterflow::free_surface {
namespace {

SceneSettings pool() {
    SceneSettings scene;
    scene.tank.cells = {40, 1, 30};
    scene.tank.cell = 0.01;
    scene.tank.depth = 0.05;
    scene.water.filled = {{Vec3(-1, -1, -1), Vec3(1, 1, 0.15)}};
    return scene;
}

TEST(Gauges, read_level_and_hydrostatic_pressure_of_water_at_rest) {
    SurfaceRun run(pool(), nullptr);
    run.step();
    for (const double x : {0.0, 0.034, 0.21, 0.4}) {
        EXPECT_NEAR(read_gauge(run, {"level", x, 0.0, {}}).level, 0.15, 1e-9) << x;
        EXPECT_EQ(read_gauge(run, {"level", x, 0.0, {}}).pressure, 0.0) << x;
        for (const double z : {0.0131, 0.05, 0.1}) {
            const GaugeReading reading = read_gauge(run, {"pressure", x, 0.0, z});
            EXPECT_NEAR(reading.pressure, 1000.0 * 9.81 * (0.15 - z), 1e-3) << x << ' ' << z;
        }
        EXPECT_NEAR(read_gauge(run, {"floor", x, 0.0, 0.0}).pressure, 1000.0 * 9.81 * 0.145, 1e-3) << x;  // of the lowest centre
        EXPECT_NEAR(read_gauge(run, {"air", x, 0.0, 0.25}).pressure, 0.0, 1e-12) << x;
    }
}

TEST(Gauges, tell_a_wave_from_its_trough) {
    SceneSettings scene = pool();
    scene.water.filled = {{Vec3(-1, -1, -1), Vec3(0.2, 1, 0.2)}, {Vec3(0.2, -1, -1), Vec3(1, 1, 0.1)}};
    SurfaceRun run(scene, nullptr);
    EXPECT_NEAR(read_gauge(run, {"left", 0.05, 0.0, {}}).level, 0.2, 1e-9);
    EXPECT_NEAR(read_gauge(run, {"right", 0.35, 0.0, {}}).level, 0.1, 1e-9);
}

/// Above the tank there are no cells.
TEST(Gauges, read_a_pipe_that_reaches_out_of_the_tank_up_to_its_end) {
    SceneSettings scene = pool();
    scene.solids = {SolidBox{Vec3(0.10, -1, 0.05), Vec3(0.12, 1, 1e3)}, SolidBox{Vec3(0.22, -1, 0.05), Vec3(0.24, 1, 1e3)}};
    scene.water.filled = {{Vec3(-1, -1, -1), Vec3(0.2, 1, 0.2)}};
    SurfaceRun run(scene, nullptr);
    for (int n = 0; n < 3; ++n) run.step();
    const SceneReading within = read_gauges(run, PipeGauge{0.17, 0.1, 0.02, 0.05, 0.3});
    const SceneReading beyond = read_gauges(run, PipeGauge{0.17, 0.1, 0.02, 0.05, 1e3});
    EXPECT_NE(within.mouth_flow, 0.0);
    EXPECT_EQ(beyond.hole_flow, within.hole_flow);
    EXPECT_EQ(beyond.level_in_pipe, within.level_in_pipe);
}

/// A step across: gauges read the water where they stand, not that in the middle. The pressure between two centres is their mean.
TEST(Gauges, in_space_read_their_place_across) {
    SceneSettings scene = pool();
    scene.tank.plane = false;
    scene.tank.cells = {8, 8, 30};
    scene.water.filled = {{Vec3(-1, -1, -1), Vec3(1, 0.04, 0.2)}, {Vec3(-1, 0.04, -1), Vec3(1, 1, 0.1)}};
    SurfaceRun run(scene, nullptr);
    EXPECT_NEAR(read_gauge(run, {"near", 0.04, 0.01, {}}).level, 0.2, 1e-9);
    EXPECT_NEAR(read_gauge(run, {"far", 0.04, 0.07, {}}).level, 0.1, 1e-9);
    run.step();
    const auto pressure = [&](double y) { return read_gauge(run, {"shoulder", 0.045, y, 0.095}).pressure; };
    EXPECT_GT(pressure(0.015), 1.2 * pressure(0.065));
    EXPECT_NEAR(pressure(0.04), 0.5 * (pressure(0.035) + pressure(0.045)), 1e-9 * pressure(0.04));
}

}  // namespace
}  // namespace cutterflow::free_surface
