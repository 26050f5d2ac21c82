// Settings: good ones pass, bad ones name every key.
#include <gtest/gtest.h>

#include "solver/ports/dem_settings.hpp"
#include "solver/ports/settings.hpp"
#include "solver/ports/testing/temporary_folder.hpp"

namespace cutterflow::coupling {
namespace {

CouplingSettings good_settings() {
    CouplingSettings settings;
    settings.has_rock = true;
    settings.rock_feed = "constant/rockFeed.csv";
    FateSettings fates;
    fates.contour = "constant/contour.csv";
    fates.ring_radius = 0.4;
    fates.z_backplate = 0.03;
    fates.mouth = {Vec3(0.22, 0, 0.05), Vec3::UnitZ(), 0.1, 0.2};
    fates.bin_width = 0.03;
    settings.fates = fates;
    settings.outflow = OutflowSettings{0.015, 1.0};
    settings.stop = StopSettings{0.05};
    settings.checkpoint = CheckpointSettings{0.25, 2};
    return settings;
}

const FluidProperties k_water{998.2, 1.0034e-6};

TEST(Settings, of_the_contract_pass) {
    EXPECT_TRUE(check_settings(good_settings(), k_water, "x").empty());
}

TEST(Settings, of_a_pure_flow_run_need_nothing) {
    EXPECT_TRUE(check_settings(CouplingSettings{}, k_water, "x").empty());
}

TEST(Settings, of_a_replay_ask_for_nothing_that_a_recording_lacks) {
    CouplingSettings settings = good_settings();
    settings.replay = "recording";
    settings.record = RecordSettings{0.0, 1.0, 48, 6};
    settings.velocity.emplace();
    settings.soil = SoilSettings{"bank.stl", 0.0};
    settings.closures.lift = "mei";
    settings.closures.viscous_force = false;
    EXPECT_EQ(check_settings(settings, k_water, "x").size(), 7u);  // soil, outflow, velocity, checkpoint, record, lift, viscous force
    CouplingSettings plain = good_settings();
    plain.replay = "recording";
    plain.outflow.reset();
    plain.checkpoint.reset();
    EXPECT_TRUE(check_settings(plain, k_water, "x").empty());
    plain.has_rock = false;
    plain.stop.reset();
    EXPECT_EQ(check_settings(plain, k_water, "x").size(), 1u);
}

TEST(Settings, of_a_recording_need_rock_and_an_interval) {
    CouplingSettings settings = good_settings();
    settings.record = RecordSettings{1.0, 2.0, 48, 6};
    EXPECT_TRUE(check_settings(settings, k_water, "x").empty());
    settings.record->end_time = 1.0;
    EXPECT_EQ(check_settings(settings, k_water, "x").size(), 1u);
    settings.has_rock = false;
    settings.stop.reset();
    EXPECT_EQ(check_settings(settings, k_water, "x").size(), 2u);
}

TEST(Settings, name_every_mistake) {
    CouplingSettings settings = good_settings();
    settings.kernel.gamma = 0.0;
    settings.closures.drag = "stokes";
    settings.closures.drag_modifier = -1.0;
    settings.fates->bin_width = 0.0;
    settings.stop->undecided = 1.5;
    settings.checkpoint->keep = 0;
    settings.soil = SoilSettings{"bank.stl", -1.0};
    settings.rock_feed.clear();
    const auto mistakes = check_settings(settings, {0.0, 1e-6}, "constant/couplingProperties");
    ASSERT_EQ(mistakes.size(), 9u);
    for (const Mistake& mistake : mistakes) {
        const bool of_fluid = mistake.what.rfind("rho", 0) == 0;
        EXPECT_EQ(mistake.where, of_fluid ? "constant/transportProperties" : "constant/couplingProperties");
        EXPECT_FALSE(mistake.rule.empty());
        EXPECT_FALSE(mistake.remedy.empty());
    }
    const auto names = [&](const std::string& what) {
        return std::any_of(mistakes.begin(), mistakes.end(), [&](const Mistake& m) { return m.what.find(what) != std::string::npos; });
    };
    EXPECT_TRUE(names("rho = 0"));
    EXPECT_TRUE(names("closures.drag = \"stokes\""));
    EXPECT_TRUE(names("kernel.gamma = 0"));
    EXPECT_TRUE(names("soil.permeability = -1"));
    EXPECT_TRUE(names("checkpoint.keep = 0"));
}

TEST(Settings, count_the_void_fraction_once) {
    CouplingSettings settings = good_settings();
    settings.closures.drag = "gidaspow";
    EXPECT_EQ(check_settings(settings, k_water, "x").size(), 1u);
    settings.closures.hindrance = "none";
    settings.closures.lift = "mei";
    EXPECT_TRUE(check_settings(settings, k_water, "x").empty());
    settings.closures.sphericity = 1.2;
    settings.closures.lift = "magnus";
    EXPECT_EQ(check_settings(settings, k_water, "x").size(), 2u);
}

TEST(Settings, give_clusters_their_size_and_no_other_map) {
    CouplingSettings settings = good_settings();
    settings.kernel.map = k_centroid_map;
    EXPECT_TRUE(check_settings(settings, k_water, "x").empty());
    settings.kernel.cluster_size = 0.06;
    auto mistakes = check_settings(settings, k_water, "x");
    ASSERT_EQ(mistakes.size(), 1u);
    EXPECT_EQ(mistakes[0].what, "kernel.clusterSize = 0.06 with kernel.map = centroid");
    settings.kernel.map = k_cluster_map;
    EXPECT_TRUE(check_settings(settings, k_water, "x").empty());
    settings.kernel.cluster_size = 0.0;
    mistakes = check_settings(settings, k_water, "x");
    ASSERT_EQ(mistakes.size(), 1u);
    EXPECT_EQ(mistakes[0].what, "kernel.clusterSize is missing");
    settings.kernel = {};
    settings.kernel.map = "divided";
    EXPECT_EQ(check_settings(settings, k_water, "x").size(), 1u);
}

TEST(Settings, only_outflow_and_the_stop_rule_need_fates) {
    CouplingSettings settings = good_settings();
    settings.fates.reset();
    EXPECT_EQ(check_settings(settings, k_water, "x").size(), 2u);
    settings.outflow.reset();
    EXPECT_EQ(check_settings(settings, k_water, "x").size(), 1u);
    settings.stop.reset();
    EXPECT_TRUE(check_settings(settings, k_water, "x").empty());
}

TEST(DemWalls, move_in_one_way) {
    WallSettings still;
    still.name = "lid";
    still.file = "lid.stl";
    WallSettings rotating = still, travelling = still, turning = still, pressing = still, belt = still;
    rotating.rotating = true;
    travelling.travels = {{Vec3::UnitZ(), 0.0, 1.0}};
    turning.turn.speed = 1.0;
    pressing.press = WallPress{-Vec3::UnitZ(), 8.0, 0.05};
    belt.surface_velocity = Vec3::UnitX();
    const auto of_motion = [](const WallSettings& wall) {
        DemSettings settings;
        settings.walls = {wall};
        std::string texts;
        for (const Mistake& mistake : check_settings(settings, "x"))
            if (mistake.rule == "A wall moves in one way" || mistake.rule == "A wall whose surface runs does not turn")
                texts += mistake.what + ";";
        return texts;
    };
    for (const WallSettings& one : {still, rotating, travelling, turning, pressing, belt}) EXPECT_EQ(of_motion(one), "");
    rotating.travels = travelling.travels;
    EXPECT_EQ(of_motion(rotating), "rock.walls.lid turns with the moving zone and travels;");
    turning.travels = travelling.travels;
    turning.press = pressing.press;
    EXPECT_EQ(of_motion(turning), "rock.walls.lid turns by itself and travels and presses;");
    rotating.travels = {};
    rotating.surface_velocity = belt.surface_velocity;
    EXPECT_EQ(of_motion(rotating), "rock.walls.lid.surfaceVelocity of a wall that turns;");
}

TEST(DemWalls, travel_several_times_one_after_the_other) {
    const std::vector<WallTravel> travels{{Vec3(0, 0, 2), 1.0, 1.5}, {Vec3(1, 0, 0), 1.5, 2.0}, {Vec3(0, 0, -4), 3.0, 4.0}};
    // The way is the integral of the velocity, by the midpoint rule on steps that meet all times.
    Vec3 way = Vec3::Zero();
    constexpr double step = 0.125;
    for (double time = 0.0; time < 5.0; time += step) {
        EXPECT_NEAR((way_until(travels, time) - way).norm(), 0.0, 1e-12) << time;
        way += step * velocity_at(travels, time + 0.5 * step);
    }
    EXPECT_NEAR((way_until(travels, 9.0) - Vec3(0.5, 0.0, -3.0)).norm(), 0.0, 1e-12);
    EXPECT_EQ(velocity_at(travels, 2.5), Vec3(Vec3::Zero()));
    EXPECT_EQ(velocity_at(travels, 1.5), Vec3(0, 0, 2)) << "the end of a travel belongs to it";

    DemSettings settings;
    WallSettings wall;
    wall.name = "gate";
    wall.travels = travels;
    const auto of_travel = [&] {
        settings.walls = {wall};
        std::string texts;
        for (const Mistake& mistake : check_settings(settings, "x"))
            if (mistake.what.find(".travel") != std::string::npos) texts += mistake.what + ";";
        return texts;
    };
    EXPECT_EQ(of_travel(), "");
    wall.travels[1].begin = 1.4;
    wall.travels[2].end = 2.9;
    EXPECT_EQ(of_travel(),
              "rock.walls.gate.travel: from 1.4 on, and the one before lasts until 1.5;rock.walls.gate.travel: from 3 to 2.9;");
}

TEST(Contour, is_read_and_a_bad_one_named) {
    const testing::TemporaryFolder folder;
    FateSettings fates = *good_settings().fates;
    fates.contour = folder.write("contour.csv", "z_m,r_m\n-0.485,0\n-0.4,0.2\n0,0.4\n");
    EXPECT_NEAR(read_contour(fates).radius_at(-0.2), 0.3, 1e-15);
    fates.contour = folder.write("down.csv", "z_m,r_m\n0,0.4\n-0.4,0.2\n");
    EXPECT_THROW(read_contour(fates), UserError);
    fates.contour = folder.path() / "absent.csv";
    EXPECT_THROW(read_contour(fates), UserError);
}

}  // namespace
}  // namespace cutterflow::coupling
