// Replays in reports and comparisons: their own rock in another run's flow.
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
                        fmt::format(R"({{"run": "{}", "flow_revolutions": {}, "flow_change": 0.031}})", flow.string(), revolutions));
    return run.directory;
}

TEST(ReplayReport, has_its_own_rock_and_the_flow_of_its_run) {
    const fs::path folder = replay("replay_results", flow("replay_results"), 6.0);
    const Results results = compute_results(read_run(folder));
    EXPECT_TRUE(results.finished);
    EXPECT_NEAR(results.end_time, 2.0, 1e-9);
    EXPECT_NEAR(*results.spillage->ratios.ratio, 11.0 / 14.0, 1e-9);
    EXPECT_NEAR(results.outflow.at(5).radial_velocity->mean, 0.2, 1e-6);
    EXPECT_NEAR(results.rotor.torque_flow->mean, -11.0, 1e-6);
    EXPECT_TRUE(results.conservation.flow_balance);
    EXPECT_EQ(results.cost.steps, 200u);
    EXPECT_EQ(results_json(results, read_run(folder)).at("recorded_flow").at("change"), 0.031);
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
    EXPECT_TRUE(scope_of(comparison).is_replay);
    const Quantity& age = *find_quantity(comparison, "flow_revolutions");
    EXPECT_FALSE(age.settings.at(0).value);
    EXPECT_EQ(age.settings.at(2).value, 9.0);
}

TEST(ReplayReport, without_its_run_tells_which_is_missing) {
    const fs::path folder = replay("replay_alone", "/no/such/run", 6.0);
    try {
        read_run(folder);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("/no/such/run"));
    }
}

}  // namespace
}  // namespace cutterflow::postproc
