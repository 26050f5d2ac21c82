// A run that is stopped and continued is the run that was not stopped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "solver/foam/tests/fluid_run.hpp"

#include "Pstream.H"

namespace cutterflow::foam {
namespace {

using testing::FluidRun;

/// Turbulent flow between a turning hub and a rim, with an adaptive time step.
testing::TinyCase stirred_annulus(const std::string& name) {
    testing::TurningAnnulus shape;
    shape.height = 0.05;
    shape.cells_high = 4;
    shape.cells_around_quarter = shape.stator_cells_around_quarter = 10;
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(shape), 1e-3, 10.0);
    testing::make_turbulent(tiny, 0.01, 0.1);
    for (const char* field : {"0/k", "0/epsilon", "0/nut"}) {
        std::string& text = tiny.files[field];
        text.insert(text.rfind('}'), "\".*ends\" { type zeroGradient; }\n");
    }
    tiny.files["0/nut"].replace(tiny.files["0/nut"].find("{ type zeroGradient; }"), 22, "{ type calculated; value uniform 0; }");
    tiny.files["system/controlDict"] += "adjustTimeStep yes; maxCo 0.3; maxDeltaT 1; timePrecision 6;\n";
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)",
                                              "\".*ends\" { type slip; } rim { type noSlip; } "
                                              "hub { type movingWallVelocity; value uniform (0 0 0); }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; }");
    tiny.files["constant/dynamicMeshDict"] = testing::turning(20.0);
    return tiny;
}

/// A lump of rock at a fixed place in the turning zone, which drags and moves slowly along.
void step_with_rock(FluidRun& run) {
    const auto solid_at = [](double time) {
        return [time](const Vec3& x) { return 0.3 * std::exp(-0.5 * (x - Vec3(0.065, 0.1 * time, 0.0)).squaredNorm() / 1e-4); };
    };
    const double before = run.engine().time();
    run.begin();
    auto old_fraction = run.evaluate(solid_at(before));
    auto new_fraction = run.evaluate(solid_at(run.engine().time()));
    for (std::size_t i = 0; i < run.cells(); ++i) {
        run.inertia[i] = 1.5 * new_fraction[i];
        run.drag_rate[i] = 10.0 * new_fraction[i];
        run.source[i] =
            -run.drag_rate[i] * run.engine().fields().velocity[i] - run.inertia[i] * run.engine().fields().material_acceleration[i];
        old_fraction[i] = 1.0 - old_fraction[i];
        new_fraction[i] = 1.0 - new_fraction[i];
    }
    run.end(old_fraction, new_fraction);
}

struct State {
    double time, time_step;
    std::vector<Vec3> velocity, acceleration;
    std::vector<double> void_fraction;
    coupling::FluidLoads loads;
};

State state_of(FluidRun& run) {
    const coupling::FluidFields f = run.engine().fields();
    return {run.engine().time(),
            run.engine().time_step(),
            {f.velocity.begin(), f.velocity.end()},
            {f.material_acceleration.begin(), f.material_acceleration.end()},
            {f.void_fraction.begin(), f.void_fraction.end()},
            run.engine().loads()};
}

double largest_difference(FluidRun& run, const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double worst = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, (a[i] - b[i]).norm());
    return run.largest(worst);
}

TEST(Restart, ContinuesTheSameRun) {
    const std::filesystem::path folder = testing::build_case(stirred_annulus("restart"));
    State uninterrupted;
    {
        FluidRun run(folder, true);
        for (int step = 0; step < 8; ++step) step_with_rock(run);
        run.engine().write_now();
        step_with_rock(run);
        uninterrupted = state_of(run);
    }
    FluidRun resumed(folder, true);
    EXPECT_GT(resumed.engine().time(), 0.0);
    step_with_rock(resumed);
    const State state = state_of(resumed);
    EXPECT_DOUBLE_EQ(state.time, uninterrupted.time);
    EXPECT_DOUBLE_EQ(state.time_step, uninterrupted.time_step);
    EXPECT_LE(largest_difference(resumed, state.velocity, uninterrupted.velocity), 1e-12);
    EXPECT_LE(largest_difference(resumed, state.acceleration, uninterrupted.acceleration), 1e-12 / state.time_step);
    double worst = 0.0;
    for (std::size_t i = 0; i < state.void_fraction.size(); ++i)
        worst = std::max(worst, std::abs(state.void_fraction[i] - uninterrupted.void_fraction[i]));
    EXPECT_LE(resumed.largest(worst), 1e-14);
    EXPECT_NEAR(state.loads.torque_viscous / uninterrupted.loads.torque_viscous, 1.0, 1e-10);
    EXPECT_NE(state.loads.torque_viscous, 0.0);
}

/// OpenFOAM itself looks for these folders as 3.1098684441377582 and 3.10710961834521981.
TEST(Restart, FindsAFolderOfAnyDigits) {
    for (const std::string name : {"3.109868444137758", "3.1", "0.00012345678901", "2.5e-05"}) {
        testing::TinyCase tiny = stirred_annulus("digits_of_time");
        tiny.files["constant/dynamicMeshDict"] = testing::turning(0.0);
        const std::filesystem::path folder = testing::build_case(tiny);
        const std::filesystem::path of_rank =
            Foam::UPstream::parRun() ? folder / ("processor" + std::to_string(Foam::UPstream::myProcNo())) : folder;
        std::filesystem::rename(of_rank / "0", of_rank / name);
        FluidRun run(folder, true);
        EXPECT_EQ(run.engine().time_name(), name);
        step_with_rock(run);
        EXPECT_GT(run.engine().time(), std::stod(name));
    }
}

/// At 20 rad/s a mesh that stands as in constant/polyMesh at 0.1 s is 2 rad from where rock and walls take it to be.
TEST(Restart, RefusesAMeshThatStandsAtAnotherAngle) {
    const std::filesystem::path folder = testing::build_case(stirred_annulus("another_angle"));
    const std::filesystem::path of_rank =
        Foam::UPstream::parRun() ? folder / ("processor" + std::to_string(Foam::UPstream::myProcNo())) : folder;
    std::filesystem::rename(of_rank / "0", of_rank / "0.1");
    try {
        FluidRun run(folder, false);
        FAIL() << "started";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("beside where omega = 20 rad/s turns it"));
    }
}

TEST(TimeStep, KeepsWithinTheTravelLimitAndTheCourantNumber) {
    FluidRun run(testing::build_case(stirred_annulus("travel_limit")), false);
    for (int step = 0; step < 12; ++step) {
        run.begin();
        run.end({}, {});
        EXPECT_LE(run.engine().loads().courant_max, 0.3 * 1.05);
    }
    const double free_step = run.engine().time_step();
    run.engine().begin_step(0.4 * free_step, std::numeric_limits<double>::infinity());
    run.end({}, {});
    // Steps are a little shorter than the limit, so that a whole number of them leads to the end of the run.
    EXPECT_LE(run.engine().time_step(), 0.4 * free_step * (1.0 + 1e-12));
    EXPECT_GE(run.engine().time_step(), 0.999 * 0.4 * free_step);
}

TEST(TimeStep, IsLongerWhileTheFlowDevelops) {
    const auto steps = [](const std::string& name, const std::string& control) {
        testing::TinyCase tiny = stirred_annulus(name);
        tiny.files["system/controlDict"] += control;
        FluidRun run(testing::build_case(tiny), false);
        std::vector<double> lengths;
        for (int step = 0; step < 40; ++step) {
            run.begin();
            run.end({}, {});
            lengths.push_back(run.engine().time_step());
        }
        return lengths;
    };
    const double usual = steps("usual", "").back();
    EXPECT_NEAR(steps("develops", "developmentEnd 1e9; developmentStepRatio 3;").back() / usual, 3.0, 0.1);
    const std::vector<double> back = steps("developed", fmt::format("developmentEnd {}; developmentStepRatio 3;", 20.0 * usual));
    EXPECT_GT(*std::max_element(back.begin(), back.end()), 2.0 * usual);
    EXPECT_NEAR(back.back() / usual, 1.0, 0.05);
}

TEST(TimeStep, MeetsAReleaseWithoutAStepMuchShorterThanTheOthers) {
    FluidRun run(testing::build_case(stirred_annulus("release")), false);
    for (int step = 0; step < 12; ++step) {
        run.begin();
        run.end({}, {});
    }
    const double free_step = run.engine().time_step(), release = run.engine().time() + 3.3 * free_step;
    double shortest = free_step;
    while (run.engine().time() < release - 1e-9) {
        run.engine().begin_step(std::numeric_limits<double>::infinity(), release);
        run.end({}, {});
        shortest = std::min(shortest, run.engine().time_step());
    }
    EXPECT_NEAR(run.engine().time(), release, 1e-12);
    EXPECT_GT(shortest, 0.5 * free_step);
}

TEST(Steel, OfTheRotorIsGivenInItsOwnFrame) {
    const std::filesystem::path folder = testing::build_case(stirred_annulus("steel"));
    std::vector<coupling::SteelTriangle> at_start;
    {
        FluidRun run(folder, true);
        const coupling::Steel steel = run.engine().steel();
        at_start.assign(steel.of_zone.at(1).begin(), steel.of_zone.at(1).end());
        EXPECT_EQ(at_start.size(), 2u * 40u * 4u);
        EXPECT_EQ(steel.of_zone.at(0).size(), 2u * 40u * 4u);
        for (int step = 0; step < 5; ++step) step_with_rock(run);
        run.engine().write_now();
    }
    FluidRun resumed(folder, true);
    EXPECT_GT(std::abs(resumed.engine().moving_zones()[0].angle(resumed.engine().time())), 0.02);
    const coupling::Steel steel = resumed.engine().steel();
    ASSERT_EQ(steel.of_zone.at(1).size(), at_start.size());
    double worst = 0.0, area = 0.0;
    for (std::size_t i = 0; i < at_start.size(); ++i) {
        worst = std::max({worst, (steel.of_zone.at(1)[i].a - at_start[i].a).norm(), (steel.of_zone.at(1)[i].b - at_start[i].b).norm()});
        area += 0.5 * (at_start[i].b - at_start[i].a).cross(at_start[i].c - at_start[i].a).norm();
    }
    EXPECT_LE(worst, 1e-12);
    EXPECT_NEAR(area, 40.0 * 2.0 * 0.05 * std::sin(k_pi / 40.0) * 0.05, 1e-9);
}

// A pure flow has blades too: points in them are dry.
TEST(Steel, IsThereWithoutRock) {
    FluidRun run(testing::build_case(stirred_annulus("steel_of_a_pure_flow")), false);
    const coupling::Steel steel = run.engine().steel();
    ASSERT_EQ(steel.of_zone.size(), 2u);
    EXPECT_EQ(steel.of_zone[0].size(), 2u * 40u * 4u);
    EXPECT_EQ(steel.of_zone[1].size(), 2u * 40u * 4u);
}

}  // namespace
}  // namespace cutterflow::foam
