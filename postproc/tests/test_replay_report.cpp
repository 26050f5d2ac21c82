// Replays in reports and comparisons: their own rock in another run's flow.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "postproc/analysis/comparison.hpp"
#include "postproc/pages/report.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::SmallRun;

fs::path flow(const std::string& name) {
    SmallRun run(name + "_flow");
    run.with_rock = false;
    run.write();
    return run.directory;
}

/// The small run's rock in that flow, and nothing that a replay does not write.
fs::path replay(const std::string& name, const fs::path& flow, double revolutions) {
    SmallRun run(name);
    run.write();
    for (const char* of_the_flow :
         {"geometry", "mesh.json", "manifest.json", "postProcessing/outflow", "postProcessing/loads", "postProcessing/balance"})
        fs::remove_all(run.directory / of_the_flow);
    testing::write_text(run.directory / "replay.json",
                        fmt::format(R"({{"schema": "cutterflow.replay/1", "run": "{}", "flow_start_s": {}, "flow_end_s": {},
                                         "flow_change": 0.031}})",
                                    flow.string(), revolutions - 1.0, revolutions));
    return run.directory;
}

TEST(ReplayReport, has_its_own_rock_and_the_flow_of_its_run) {
    const fs::path folder = replay("replay_results", flow("replay_results"), 1.0);
    const RunData run = read_run(folder);
    const Results results = compute_results(run);
    EXPECT_TRUE(results.finished);
    EXPECT_NEAR(results.end_time, 2.0, 1e-9);
    EXPECT_NEAR(*results.spillage->ratios.ratio, 11.0 / 14.0, 1e-9);
    const double passing = 2.0 * k_pi / run.blades;  // of the wave, in which one blade passes
    EXPECT_NEAR(results.outflow.at(5).radial_velocity->mean, 0.2 + 0.5 * (1.0 - std::cos(passing)) / passing, 0.03);
    EXPECT_NEAR(results.rotor.torque_flow->mean, -11.0, 1e-6);
    EXPECT_TRUE(results.conservation.flow_balance);
    EXPECT_EQ(results.cost.steps, 200u);
    EXPECT_EQ(results_json(results, run).at("recorded_flow").at("change"), 0.031);
}

// What only a coupled run has.
TEST(ReplayReport, claims_nothing_of_what_rock_does_to_the_water) {
    const fs::path folder = replay("replay_claims", flow("replay_claims"), 6.0);
    const Results results = compute_results(read_run(folder));
    EXPECT_FALSE(results.rotor.torque_rock || results.rotor.power);
    EXPECT_FALSE(results.conservation.momentum || results.conservation.solid_volume);
    const std::string page = testing::read_text(write_report(folder).page_file);
    EXPECT_THAT(page, AllOf(HasSubstr("This is a replay"), HasSubstr("number 6 of"), HasSubstr("changed by 3.1"),
                            HasSubstr("reaction of rock on the water")));
}

TEST(ReplayReport, is_no_repeat_of_a_coupled_run_or_of_a_replay_in_another_flow) {
    SmallRun coupled("replay_coupled");
    coupled.write();
    const fs::path water = flow("replay_compared");
    const Comparison comparison = compare_runs({coupled.directory, replay("replay_sixth", water, 6.0), replay("replay_ninth", water, 9.0)});
    EXPECT_EQ(comparison.settings.size(), 3u);
    EXPECT_EQ(scope_of(comparison).replays, Replays::some);
    EXPECT_THAT(scope_sentence(scope_of(comparison)), HasSubstr("settings named replayed"));
    const Quantity& age = *find_quantity(comparison, "flow_revolutions");
    EXPECT_FALSE(age.settings.at(0).value);
    EXPECT_EQ(age.settings.at(2).value, 9.0);
}

// A coupled run's own rock moves the water after the recording.
TEST(ReplayReport, takes_torque_of_the_recorded_revolution_and_no_mean_of_later_water) {
    SmallRun coupled("replay_own_rock");
    coupled.write();
    testing::write_velocity_planes(coupled.directory, [](double, double) { return Vec3(1.0, 0.0, 0.0); });
    const RunData run = read_run(replay("replay_in_own_rock", coupled.directory, 1.0));
    EXPECT_TRUE(run.plane_axial.empty() && run.plane_under_ring.empty());
    const Results results = compute_results(run);
    EXPECT_NEAR(results.rotor.torque_flow->start, 0.0, 1e-9);
    EXPECT_NEAR(results.rotor.torque_flow->end, 1.0, 1e-9);
    EXPECT_LT(results.outflow.at(5).radial_velocity->end, 1.2);
}

void expect_refused(const fs::path& folder, const std::vector<const char*>& parts) {
    try {
        read_run(folder);
        ADD_FAILURE() << folder;
    } catch (const UserError& error) {
        for (const char* part : parts) EXPECT_THAT(error.what(), HasSubstr(part));
    }
}

TEST(ReplayReport, of_another_flow_or_cut_short_is_refused_with_its_own_remedy) {
    const fs::path water = flow("replay_refused");
    const fs::path other = replay("replay_other", water, 1.0), cut = replay("replay_cut", water, 1.0),
                   old = replay("replay_old", water, 1.0);
    const fs::path study = other / "study.resolved.toml";
    std::string text = testing::read_text(study);
    text.replace(text.find("speed_rpm = 60"), 14, "speed_rpm = 30");
    testing::write_text(study, text);
    expect_refused(other, {"rotor.speed_rpm = 30, the recorded flow has 60", "replay command with --resume"});
    testing::write_text(water / "recording/recording.json", R"({"end_s": 7.0, "change": 0.031})");
    expect_refused(cut, {"is not the one that was replayed"});
    fs::remove_all(water / "recording");
    fs::remove_all(cut / "postProcessing/cost");
    expect_refused(cut, {"contains no cost", "replay command with --resume"});
    for (const char* file : {"replay.json", "study.resolved.toml"}) fs::remove(old / file);
    testing::write_text(old / "constant/couplingProperties", "");
    expect_refused(old, {"there is no replay.json", "replay command with --resume"});
}

TEST(ReplayReport, without_its_run_tells_which_is_missing) {
    expect_refused(replay("replay_alone", "/no/such/run", 6.0), {"/no/such/run", "replay.json", "Move it back"});
}

}  // namespace
}  // namespace cutterflow::postproc
