/// Whole steps: rest, restart, repetition, momentum, light bodies, and what a run must refuse to go on with.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "solver/free_surface/testing/free_bodies.hpp"

namespace cutterflow::free_surface {
namespace {

SceneSettings dam(int cells) {
    SceneSettings scene;
    const double width = 0.1;
    scene.tank.cells = {4 * cells, 1, 3 * cells};
    scene.tank.cell = width / cells;
    scene.tank.depth = 0.05;
    scene.water.filled = {{Vec3(-1, -1, -1), Vec3(width, 1, 2 * width)}};
    return scene;
}

SceneSettings pool() {
    SceneSettings scene = dam(10);
    scene.water.filled = {{Vec3(-1, -1, -1), Vec3(1, 1, 0.15)}};
    return scene;
}

void expect_equal(const WaterParticles& a, const WaterParticles& b, double tolerance) {
    ASSERT_EQ(a.size(), b.size());
    double largest = 0.0;
    for (std::size_t p = 0; p < a.size(); ++p)
        largest = std::max({largest, (a.place(p) - b.place(p)).norm(), (a.speed(p) - b.speed(p)).norm()});
    EXPECT_LE(largest, tolerance);
}

/// A DEM that loses a body in its first step.
class LosesABody final : public BodiesWithoutContacts {
public:
    using BodiesWithoutContacts::BodiesWithoutContacts;
    coupling::DemStep advance(double, const coupling::HydrodynamicForce&) override {
        coupling::DemStep step;
        step.left = std::move(rocks_);
        rocks_ = {};
        step.left_impulse = step.left_contact_impulse = {Vec3::Zero()};
        return step;
    }
};

TEST(SurfaceRun, ends_when_a_body_leaves_the_tank) {
    const SceneSettings scene = pool();
    LosesABody bodies(one_rock(Vec3(0.2, 0.025, 0.2), 0.05, 2700.0));
    SurfaceRun run(scene, &bodies);
    try {
        run.step();
        FAIL() << "no body is left";
    } catch (const CheckFailure& failure) {
        EXPECT_THAT(failure.what(), ::testing::HasSubstr("Body 1 left the tank at (0.2, 0.2) m at 0 s, in a step of"));
    }
}

TEST(SurfaceRun, water_at_rest_stays_at_rest) {
    SurfaceRun run(pool(), nullptr);
    const double energy = run.energy();
    while (run.time() < 1.0) run.step();
    EXPECT_LE(largest_speed(run.particles()), 1e-10);
    EXPECT_NEAR(run.energy(), energy, 1e-10 * energy);
    EXPECT_NEAR(run.last().occupied_volume, 0.4 * 0.15 * 0.05, 1e-12);
}

TEST(SurfaceRun, pressure_at_rest_is_hydrostatic) {
    SurfaceRun run(pool(), nullptr);
    run.step();
    for (int k = 0; k < 15; ++k) {
        const double depth = 0.15 - (k + 0.5) * 0.01;
        EXPECT_NEAR(run.pressure()[run.grid().at(7, 0, k)], 1000.0 * 9.81 * depth, 1e-4);
    }
}

/// No air: the mean pressure is 0, its differences are those of the weight, and a flux that cannot be met does not stop the solver.
TEST(SurfaceRun, enclosed_water_is_solved_with_its_mean_pressure_fixed) {
    SceneSettings scene = pool();
    scene.water.filled = {{Vec3(-1, -1, -1), Vec3(1, 1, 1)}};
    EXPECT_EQ(enclosed_waters(scene, {}), 1);
    SurfaceRun run(scene, nullptr);
    while (run.time() < 0.2) {
        run.step();
        ASSERT_TRUE(run.last().pressure.converged);
        ASSERT_EQ(run.last().enclosed_waters, 1);
    }
    EXPECT_LE(largest_speed(run.particles()), 1e-10);
    double mean = 0.0;
    run.grid().for_each_cell([&](int cell, int, int, int) { mean += run.pressure()[cell] / (40 * 30); });
    EXPECT_NEAR(mean, 0.0, 1e-6);
    EXPECT_NEAR(run.pressure()[run.grid().at(7, 0, 3)] - run.pressure()[run.grid().at(20, 0, 13)], 1000.0 * 9.81 * 0.1, 1e-4);

    scene.gates = {{{Vec3(0.1, -1, 0.0), Vec3(0.12, 1, 0.2)}, 0.2, 0.0, 1.5}};  // draws water in below, leaves by the top
    SurfaceRun with_gate(scene, nullptr);
    for (int n = 0; n < 5; ++n) {
        with_gate.step();
        EXPECT_TRUE(with_gate.last().pressure.converged);
        EXPECT_TRUE(std::isfinite(largest_speed(with_gate.particles())));
    }
}

TEST(SurfaceRun, waters_below_a_lid_are_counted) {
    SceneSettings scene = pool();
    EXPECT_EQ(enclosed_waters(scene, {}), 0);
    scene.solids = {SolidBox{Vec3(0.0, -1, 0.10), Vec3(0.2, 1, 0.12)}, SolidBox{Vec3(0.2, -1, 0.0), Vec3(0.22, 1, 0.12)}};
    EXPECT_EQ(enclosed_waters(scene, {}), 1);
}

TEST(SurfaceRun, repeats_bit_by_bit) {
    SurfaceRun a(dam(8), nullptr), b(dam(8), nullptr);
    for (int n = 0; n < 60; ++n) {
        a.step();
        b.step();
    }
    expect_equal(a.particles(), b.particles(), 0.0);
}

TEST(SurfaceRun, goes_on_from_a_state_as_if_it_had_not_stopped) {
    SceneSettings scene = dam(8);
    scene.water.filled[0].to = Vec3(0.2, 1, 0.12);
    FreeBodies whole_bodies(one_rock(Vec3(0.28, 0.025, 0.06), 0.1, 300.0), scene), first_bodies(whole_bodies.rocks(), scene);
    SurfaceRun whole(scene, &whole_bodies), first(scene, &first_bodies);
    for (int n = 0; n < 30; ++n) {
        whole.step();
        first.step();
    }
    FreeBodies later_bodies(first_bodies.rocks(), scene);
    SurfaceRun later(scene, &later_bodies);
    later.restore(first.state());
    for (int n = 0; n < 30; ++n) {
        whole.step();
        later.step();
    }
    EXPECT_EQ(whole.time(), later.time());
    expect_equal(whole.particles(), later.particles(), 1e-12);
    EXPECT_LE((whole_bodies.rocks().position[0] - later_bodies.rocks().position[0]).norm(), 1e-12);
}

TEST(SurfaceRun, energy_of_a_falling_column_only_falls_and_its_volume_stays) {
    SurfaceRun run(dam(10), nullptr);
    double energy = run.energy();
    const double start = energy;
    while (run.time() < 0.5) {
        run.step();
        EXPECT_LE(run.energy(), energy + 0.005 * start);
        energy = std::min(energy, run.energy());
        EXPECT_NEAR(run.last().occupied_volume / run.initial_volume(), 1.0, 0.02);
    }
    EXPECT_LT(energy, 0.9 * start);
}

/// The same run without the even-out must show a loss, else the measure is blind.
TEST(SurfaceRun, occupied_volume_shows_water_that_clumps) {
    SceneSettings scene = dam(10);
    scene.run.even_out = false;
    scene.run.volume_limit = 1.0;
    SurfaceRun run(scene, nullptr);
    while (run.time() < 0.8) run.step();
    EXPECT_LT(run.last().occupied_volume / run.initial_volume(), 0.96);
}

/// Why a run ends, after at most `steps` steps; empty when it goes on.
std::string end_of(SurfaceRun& run, int steps) {
    try {
        for (int n = 0; n < steps; ++n) run.step();
    } catch (const CheckFailure& failure) {
        EXPECT_EQ(failure.code(), ExitCode::check_failed);
        return failure.what();
    }
    return "";
}

TEST(SurfaceRun, ends_when_water_is_lost) {
    SceneSettings scene = dam(10);
    scene.run.even_out = false;
    SurfaceRun run(scene, nullptr);
    EXPECT_THAT(end_of(run, 2000), ::testing::MatchesRegex("The water occupies -2\\..* % .* at .* s.*, most of it near \\(.*, .*\\) m.*"));
}

WaterParticles with_speed(double speed) {
    WaterParticles water = fill_water(pool(), {});
    water.velocity[2][water.size() / 2] = speed;
    return water;
}

/// The message has the time and the place.
TEST(SurfaceRun, ends_when_water_flies_or_is_no_number) {
    SurfaceRun calm(pool(), nullptr, with_speed(1.0));
    EXPECT_EQ(end_of(calm, 3), "");
    SurfaceRun fast(pool(), nullptr, with_speed(-1000.0));
    EXPECT_THAT(end_of(fast, 1), ::testing::MatchesRegex("Water flies at .* m/s near \\(.*, .*\\) m at .* s, in a step of .*"));
    SurfaceRun none(pool(), nullptr, with_speed(std::nan("")));
    EXPECT_THAT(end_of(none, 1), ::testing::MatchesRegex("The pressure of the water is no number near \\(.*, .*\\) m at 0 s.*"));
    SurfaceRun flying(pool(), nullptr, [] {  // alone in the air: no pressure acts on it
        WaterParticles water = fill_water(pool(), {});
        water.add(Vec3(0.2, 0.025, 0.25), 0);
        water.velocity[0].back() = std::nan("");
        return water;
    }());
    EXPECT_THAT(end_of(flying, 1), ::testing::MatchesRegex("Water flies at -?nan m/s near .* at .* s.*"));
}

TEST(SurfaceRun, ends_when_the_pressure_does_not_converge_twice) {
    SceneSettings scene = dam(8);
    scene.run.pressure_tolerance = 1e-300;
    SurfaceRun run(scene, nullptr);
    EXPECT_EQ(end_of(run, 1), "");
    EXPECT_FALSE(run.last().pressure.converged);
    EXPECT_THAT(end_of(run, 1), ::testing::MatchesRegex("The pressure did not converge twice at .* s.* largest near \\(.*, .*\\) m.*"));
}

TEST(SurfaceRun, pressure_takes_from_the_water_what_it_gives_to_bodies_and_walls) {
    SceneSettings scene = dam(10);
    scene.solids = {SolidBox{Vec3(0.3, -1, 0), Vec3(0.34, 1, 0.05)}};
    scene.water.filled[0].to = Vec3(0.25, 1, 0.15);
    FreeBodies bodies(one_rock(Vec3(0.2, 0.025, 0.06), 0.1, 500.0), scene);
    SurfaceRun run(scene, &bodies);
    for (int n = 0; n < 40; ++n) {
        const StepReport& report = run.step();
        EXPECT_LE(report.impulses.sum().norm(), 1e-6 * report.impulses.walls.norm());
        EXPECT_GT(report.impulses.bodies.norm(), 1e-6 * report.impulses.walls.norm());
    }
}

/// Water breaks over a wall: none of it passes through. The same plane watched without the wall must count it, else the count is blind.
TEST(SurfaceRun, counts_water_that_passes_the_middle_of_a_watched_wall) {
    SceneSettings scene = dam(10);
    scene.watched_walls = {{0.19, 0.0, 0.08}};
    const auto passed = [](const SceneSettings& settings) {
        SurfaceRun run(settings, nullptr);
        int count = 0;
        while (run.time() < 0.6) count += run.step().through_walls;
        double beyond = 0.0;
        for (const double x : run.particles().position[0]) beyond += x > 0.2;
        EXPECT_GT(beyond, 20.0);
        return count;
    };
    EXPECT_GT(passed(scene), 100);
    scene.solids = {SolidBox{Vec3(0.18, -1, 0), Vec3(0.2, 1, 0.08)}};
    EXPECT_EQ(passed(scene), 0);
}

/// A head of 30 mm over a hole of one cell in a wall of two, from `bottom` up.
SceneSettings narrow_hole(double bottom) {
    SceneSettings scene;
    const double cell = 2e-3, left = 0.04, right = left + 2.0 * cell;
    scene.tank.cells = {42, 1, 40};
    scene.tank.cell = cell;
    scene.tank.depth = 0.01;
    scene.solids = {SolidBox{Vec3(left, -1, -1), Vec3(right, 1, bottom)}, SolidBox{Vec3(left, -1, bottom + cell), Vec3(right, 1, 1)}};
    scene.water.filled = {{Vec3(-1, -1, -1), Vec3(left, 1, 0.06)},
                          {Vec3(right, -1, -1), Vec3(1, 1, 0.03)},
                          {Vec3(left, -1, bottom), Vec3(right, 1, bottom + cell)}};
    return scene;
}

/// What a particle gains in a hole must not grow with the number of steps that it takes to pass: with kernels that let wall and jet take
/// from each other, particles reached 15 sqrt(2 g dh) at this step.
TEST(SurfaceRun, water_in_a_narrow_hole_is_no_faster_at_small_steps) {
    SceneSettings scene = narrow_hole(0.02);
    scene.run.max_courant = 0.05;
    SurfaceRun run(scene, nullptr);
    double fastest = 0.0;
    while (run.time() < 0.08) {
        run.step(0.08 - run.time());
        fastest = std::max(fastest, largest_speed(run.particles()));
    }
    const double torricelli = std::sqrt(2.0 * 9.81 * 0.03);
    EXPECT_LE(fastest, 2.0 * torricelli);
    EXPECT_GE(fastest, 0.5 * torricelli);
}

/// A hole that opens halves of two rows drives water against the closed halves. What is put out of the wall there no longer moves into it.
TEST(SurfaceRun, water_put_out_of_a_wall_does_not_move_into_it) {
    const SceneSettings scene = narrow_hole(0.021);
    SurfaceRun run(scene, nullptr);
    const double wall = 0.04, just_before = 1e-5 * scene.tank.cell;
    int put_out = 0;
    while (run.time() < 0.1) {
        run.step();
        for (std::size_t p = 0; p < run.particles().size(); ++p) {
            const double before = wall - run.particles().position[0][p];
            if (before < 0.0 || before > just_before) continue;
            ++put_out;
            EXPECT_LE(run.particles().velocity[0][p], 1e-12);
        }
    }
    EXPECT_GT(put_out, 10);
}

/// Takes nine tenths of the water's force.
class LyingBodies final : public FreeBodies {
public:
    using FreeBodies::FreeBodies;
    coupling::DemStep advance(double duration, const coupling::HydrodynamicForce& force) override {
        return FreeBodies::advance(duration, [&](std::size_t n, const Vec3& v) { return Vec3(0.9 * force(n, v)); });
    }
};

TEST(SurfaceRun, a_dem_that_takes_another_force_than_the_waters_is_caught) {
    const SceneSettings scene = pool();
    const coupling::Rocks rock = one_rock(Vec3(0.2, 0.025, 0.07), 0.08, 400.0);
    FreeBodies honest(rock, scene);
    LyingBodies liar(rock, scene);
    SurfaceRun with_honest(scene, &honest), with_liar(scene, &liar);
    EXPECT_LE(with_honest.step().body_impulse_error, 1e-12);
    EXPECT_GE(with_liar.step().body_impulse_error, 0.05);
}

TEST(SurfaceRun, a_light_disc_starts_with_its_exact_acceleration_at_any_step) {
    const double radius = 0.01, cavity = 0.04, ratio = 0.1;
    const double exact = 9.81 * (1.0 - ratio) / (ratio + (cavity * cavity + radius * radius) / (cavity * cavity - radius * radius));
    SceneSettings scene;
    scene.tank.cell = 0.001;
    scene.tank.cells = {84, 1, 84};
    const Vec3 centre(0.04213, 0.5, 0.04187);
    scene.solids = {SolidCavity{centre, cavity, false}};
    scene.water.filled = {{Vec3(-1, -1, -1), Vec3(1, 1, 1)}};
    scene.water.kinematic_viscosity = 0.0;
    for (const double step : {1e-5, 1e-3}) {
        scene.run.longest_step = step;
        FreeBodies body(one_rock(centre, 2 * radius, 1000.0 * ratio), scene);
        SurfaceRun run(scene, &body);
        run.step();
        EXPECT_NEAR(body.rocks().velocity[0].z() / step, exact, 0.015 * exact) << step;
        EXPECT_LE(std::abs(body.rocks().velocity[0].x() / step), 1e-3 * 9.81);
        EXPECT_EQ(run.last().enclosed_waters, 1);
    }
}

TEST(SurfaceRun, plane_and_space_give_the_same) {
    SceneSettings plane = dam(6);
    plane.run.pressure_tolerance = plane.run.even_out_tolerance = 1e-12;  // what is left of the residuals differs
    SceneSettings space = plane;
    space.tank.plane = false;
    space.tank.cells[1] = 4;
    SurfaceRun a(plane, nullptr), b(space, nullptr);
    for (int n = 0; n < 30; ++n) {
        a.step();
        b.step();
    }
    EXPECT_NEAR(a.time(), b.time(), 1e-9);
    EXPECT_NEAR(largest_speed(a.particles()), largest_speed(b.particles()), 1e-6);
    const double depth_ratio = plane.tank.depth / (4 * space.tank.cell);
    EXPECT_NEAR(a.energy(), depth_ratio * b.energy(), 1e-6 * a.energy());
}

}  // namespace
}  // namespace cutterflow::free_surface
