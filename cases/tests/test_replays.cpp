// Whose rock may be replayed in a recorded flow.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cases/replay/replay.hpp"
#include "cases/study/study.hpp"
#include "geometry/base/error.hpp"

namespace cutterflow::cases {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

ParameterValues study(const std::string& more) {
    return parse_parameters(study_table(),
                            "[cutter]\nfile = \"/head.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n"
                            "mouth_offset_m = 0.22\n" +
                                more,
                            "study.toml");
}

TEST(SameFlow, other_rock_another_ladder_and_a_longer_run_are_the_same_flow) {
    const ParameterValues other = study(
        "[ladder]\ninclination_deg = 30\n[run]\nmax_revolutions = 5\nmax_courant = 0.5\n[kernel]\ngamma = 2\n"
        "[[feed]]\ncount = 7\n[[feed.class]]\ndiameter_m = 0.002\ndensity_kg_m3 = 1050\n");
    EXPECT_THAT(check_same_flow(study(""), other, "other.toml"), ::testing::IsEmpty());
}

TEST(SameFlow, every_key_of_another_flow_is_named) {
    ParameterValues other = study("[fluid]\ndensity_kg_m3 = 1025\n[mesh]\npreset = \"standard\"\n");
    other.set("rotor.speed_rpm", 59.0);
    other.set("cutter.file", std::string("/other.stl"));
    other.set("suction.mouth_offset_m", 0.22 * (1.0 + 1e-12));  // written as text and read again
    std::string all;
    for (const Mistake& mistake : check_same_flow(study(""), other, "other.toml")) all += mistake.text() + "\n";
    for (const char* part : {"rotor.speed_rpm = 59", "fluid.density_kg_m3 = 1025", "mesh.preset = \"standard\"",
                             "cutter.file = \"/other.stl\"", "as the run recorded it, with 60"})
        EXPECT_THAT(all, ::testing::HasSubstr(part));
    EXPECT_THAT(all, ::testing::Not(::testing::HasSubstr("mouth_offset")));
}

TEST(SameFlow, a_recorded_flow_keeps_its_bank_and_its_hauling) {
    const std::string bank = "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n";
    EXPECT_THAT(check_same_flow(study(bank), study(bank), "other.toml"), ::testing::IsEmpty());
    const std::vector<Mistake> mistakes = check_same_flow(study(bank), study(""), "other.toml");
    ASSERT_EQ(mistakes.size(), 1u);
    EXPECT_THAT(mistakes.front().text(), ::testing::HasSubstr("bank.model = \"none\""));
    EXPECT_EQ(check_same_flow(study(bank), study(bank + "[hauling]\nwater = true\n"), "other.toml").size(), 1u);
}

// Soil stands to one side and is level; only hauled water knows the swing's speed.
TEST(SameFlow, beside_a_bank_swing_and_ladder_belong_to_the_flow) {
    const auto beside_bank = [](const std::string& swing, const std::string& more) {
        return study("[swing]\n" + swing + "[bank]\nmodel = \"wall\"\n" + more);
    };
    const ParameterValues slow = beside_bank("speed_m_min = 6\n", "");
    EXPECT_THAT(check_same_flow(slow, beside_bank("speed_m_min = 12\n", ""), "other.toml"), ::testing::IsEmpty());
    const auto other = beside_bank("speed_m_min = 6\ndirection = \"under_cut\"\n", "[ladder]\ninclination_deg = 30\n");
    EXPECT_EQ(check_same_flow(slow, other, "other.toml").size(), 2u);
    const std::string hauling = "[hauling]\nwater = true\n";
    EXPECT_EQ(check_same_flow(beside_bank("speed_m_min = 6\n", hauling), beside_bank("speed_m_min = 12\n", hauling), "other.toml").size(),
              1u);
}

TEST(Replays, of_a_sweep_are_a_table_of_its_settings) {
    ReplayedSetting fed{"45rpm", {}}, batch{"60rpm", {}};
    fed.results.estimate = postproc::estimate_spillage({0.9, 0.94}, {});
    fed.results.fed = postproc::FedReplays{2, 1, 2, 0.85, 0.92, 11.5, 11.25, 0.012, {0.3, 0.2, 0.42}};
    fed.results.replays.resize(2);
    for (Replay& replay : fed.results.replays) replay.core_s = 300.0;
    batch.results.estimate = postproc::estimate_spillage({0.97}, {{0.95, 0.96}});
    const std::string half = fmt::format("{:.6g}", *fed.results.estimate.replay_interval);
    EXPECT_EQ(replays_csv({fed, batch}),
              "setting,placements,spillage,half_interval_95,own_half_interval_95,spillage_min,fed_kg_s,hold_up_kg,settled,head_is_full,"
              "spilled_mixing,spilled_"
              "cutting,left_behind,core_s\n"
              "45rpm,2,0.92," +
                  half +
                  ",0.012,0.85,11.5,11.25,1,2,0.3,0.2,0.42,600\n"
                  "60rpm,1,0.96,,,,,,,,,,,0\n");
}

TEST(Replays, of_a_run_from_before_the_key_sample_as_that_run) {
    EXPECT_EQ(study_as_recorded(study("")).text("kernel.sampling"), "quadratic");
    EXPECT_EQ(study_as_recorded(study("[kernel]\nsampling = \"gaussian\"\n")).text("kernel.sampling"), "gaussian");
}

TEST(Replays, of_a_run_from_before_unused_keys_were_refused_leave_them_out) {
    const ParameterValues recorded =
        study_as_recorded(study("[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n[[feed]]\nkind = \"cut_face\"\ndepth_to_m = 0.3\n"
                                "[[feed.class]]\ndiameter_m = 0.02\n"));
    EXPECT_FALSE(recorded.tables("feed").at(0).has("feed.depth_to_m"));
    EXPECT_THAT(check_file_rules(recorded, "study.toml"), ::testing::IsEmpty());
}

// Pairs are of a coupled run and the replay of its placement.
TEST(Replays, are_refused_where_rock_changes_the_flow) {
    const auto estimate = [](double spilled, double correction) {
        return postproc::estimate_spillage({spilled - 0.001, spilled + 0.001}, {{spilled + correction, spilled}, {0.6 + correction, 0.6}});
    };
    EXPECT_NO_THROW(require_weak_coupling(postproc::estimate_spillage({0.5, 0.52}, {}), "replays"));
    EXPECT_NO_THROW(require_weak_coupling(estimate(0.5, 0.049), "replays"));
    struct Case {
        double spilled, correction;
        const char *says, *rule;
    };
    for (const Case& strong :
         {Case{0.5, 0.07, "+7.0 points", "at most 5 points"}, Case{0.5, -0.07, "-7.0 points", "at most 5 points"},
          Case{0.98, -0.02, "-2.0 points", "at most 0.5 points"}, Case{0.02, 0.02, "+2.0 points", "at most 0.5 points"}}) {
        try {
            require_weak_coupling(estimate(strong.spilled, strong.correction), "replays");
            FAIL() << strong.spilled << " " << strong.correction;
        } catch (const CheckFailure& failure) {
            EXPECT_THAT(failure.what(), AllOf(HasSubstr(strong.says), HasSubstr(strong.rule), HasSubstr("coupled")));
        }
    }
    EXPECT_NO_THROW(require_weak_coupling(estimate(0.98, -0.004), "replays"));
}

}  // namespace
}  // namespace cutterflow::cases
