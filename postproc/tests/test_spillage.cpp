#include "postproc/analysis/spillage.hpp"

#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "postproc/run/run_reader.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

using testing::small_rock_mass;
using testing::SmallRun;

Spillage evaluate(const SmallRun& run) {
    const RunData data = read_run(run.directory);
    return evaluate_spillage(data.rock->fates, data.rock->events, data.bins, data.operating_point.revolution_s(), data.finished);
}

double bin_mass(const Spillage& spillage, const std::string& name) {
    for (const BinSpillage& bin : spillage.bins) {
        if (bin.bin.name == name) return bin.spilled.mass / small_rock_mass();
    }
    return -1.0;
}

TEST(RatiosOf, follow_their_definitions_by_mass) {
    const Fates fates{0.0, {10, 16.0}, {3, 3.0}, {4, 11.0}, {1, 1.0}, {2, 1.0}};
    const SpillageRatios ratios = ratios_of(fates);
    EXPECT_DOUBLE_EQ(*ratios.ratio, 11.0 / 14.0);
    EXPECT_DOUBLE_EQ(*ratios.ratio_min, 11.0 / 16.0);
    EXPECT_DOUBLE_EQ(*ratios.ratio_max, 13.0 / 16.0);
    EXPECT_DOUBLE_EQ(*ratios.undecided, 2.0 / 16.0);
    EXPECT_TRUE(ratios.reason.empty());
}

TEST(RatiosOf, are_undefined_with_a_reason) {
    const SpillageRatios undecided = ratios_of({0.0, {5, 5.0}, {0, 0.0}, {0, 0.0}, {5, 5.0}, {0, 0.0}});
    EXPECT_FALSE(undecided.ratio);
    EXPECT_DOUBLE_EQ(*undecided.ratio_min, 0.0);
    EXPECT_DOUBLE_EQ(*undecided.ratio_max, 1.0);
    EXPECT_EQ(undecided.reason, "no rock was spilled or sucked up yet");
    const SpillageRatios none = ratios_of({});
    EXPECT_FALSE(none.ratio || none.ratio_min || none.ratio_max || none.undecided);
    EXPECT_EQ(none.reason, "no rock was placed");
}

TEST(EvaluateSpillage, tells_the_story_of_the_small_run) {
    SmallRun run("spillage");
    run.write();
    const Spillage spillage = evaluate(run);
    EXPECT_EQ(spillage.fates.placed.count, 9);
    EXPECT_EQ(spillage.fates.spilled.count, 4);
    EXPECT_EQ(spillage.fates.sucked_up.count, 3);
    EXPECT_EQ(spillage.fates.in_cutter.count, 1);
    EXPECT_EQ(spillage.fates.never_entered.count, 1);
    EXPECT_NEAR(*spillage.ratios.ratio, 11.0 / 14.0, 1e-9);
    EXPECT_NEAR(bin_mass(spillage, "gap"), 2.0, 1e-6);  // rock 3 left there first and came back
    EXPECT_NEAR(bin_mass(spillage, "0-30mm"), 1.0, 1e-6);
    EXPECT_NEAR(bin_mass(spillage, "60-90mm"), 8.0, 1e-6);
    EXPECT_EQ(bin_mass(spillage, "below_hub"), 0.0);  // rock 6 came back and was sucked up
    EXPECT_DOUBLE_EQ(spillage.feed_start, 1.0);
    EXPECT_EQ(spillage.first_exit_azimuths.size(), 4u);
    EXPECT_NEAR(spillage.sucked_volume, 3.0 * small_rock_mass() / 2650.0, 1e-12);
}

TEST(EvaluateSpillage, gives_ratios_at_equal_revolutions_and_times) {
    SmallRun run("spillage_series");
    run.end_time = 3.4;
    run.events.push_back({2.5, 7, "mouth", "in", ""});
    run.write();
    const Spillage spillage = evaluate(run);
    ASSERT_EQ(spillage.at_revolutions.size(), 2u);
    EXPECT_DOUBLE_EQ(spillage.at_revolutions[0].time, 2.0);
    EXPECT_NEAR(*spillage.at_revolutions[0].ratios.ratio, 11.0 / 14.0, 1e-9);
    EXPECT_NEAR(*spillage.at_revolutions[1].ratios.ratio, 11.0 / 15.0, 1e-9);
    ASSERT_EQ(spillage.at_seconds.size(), 2u);
    EXPECT_NEAR(*spillage.at_seconds[1].ratios.undecided, 1.0 / 16.0, 1e-9);
}

TEST(EvaluateSpillage, refuses_fates_that_do_not_add_up) {
    SmallRun run("spillage_lost");
    run.write();
    const auto file = run.directory / "postProcessing/rock/0/fates.csv";
    std::string text = testing::read_text(file);
    const std::size_t last = text.rfind('\n', text.size() - 2) + 1;
    const std::size_t count = text.find(',', last) + 1;
    text.replace(count, 1, "8");  // placed 9 -> 8
    testing::write_text(file, text);
    try {
        evaluate(run);
        FAIL();
    } catch (const CheckFailure& failure) {
        EXPECT_NE(std::string(failure.what()).find("add up"), std::string::npos) << failure.what();
        EXPECT_EQ(failure.code(), ExitCode::check_failed);
    }
}

TEST(EvaluateSpillage, refuses_events_that_contradict_the_fates_of_a_finished_run) {
    SmallRun run("spillage_contradiction");
    run.write();
    const auto file = run.directory / "postProcessing/rock/0/events.csv";
    std::string text = testing::read_text(file);
    text.resize(text.rfind('\n', text.size() - 2) + 1);  // the last event, a sucked up rock, is lost
    testing::write_text(file, text);
    EXPECT_THROW(evaluate(run), CheckFailure);
}

TEST(EvaluateSpillage, of_a_killed_run_stands_at_the_last_time_that_both_tables_know) {
    SmallRun run("spillage_killed");
    run.finished = false;
    run.write();
    const auto file = run.directory / "postProcessing/rock/0/events.csv";
    std::string text = testing::read_text(file);
    text.resize(text.rfind('\n', text.size() - 2) + 1);
    testing::write_text(file, text);
    const Spillage spillage = evaluate(run);
    EXPECT_NEAR(spillage.fates.time, 1.79, 1e-9);  // rock 6 was sucked up at 1.8 s
    EXPECT_EQ(spillage.fates.sucked_up.count, 2);
}

TEST(EvaluateSpillage, before_the_feed_nothing_is_placed) {
    SmallRun run("spillage_before_feed");
    run.end_time = 0.5;
    run.finished = false;
    run.write();
    const Spillage spillage = evaluate(run);
    EXPECT_EQ(spillage.fates.placed.count, 0);
    EXPECT_EQ(spillage.ratios.reason, "no rock was placed");
}

}  // namespace
}  // namespace cutterflow::postproc
