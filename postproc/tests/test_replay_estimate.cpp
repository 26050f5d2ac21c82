#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "postproc/analysis/replays/replay_estimate.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

constexpr double k_truth = 0.90;
constexpr double k_bias = -0.03;   // of replays
constexpr double k_spread = 0.02;  // of a placement
constexpr double k_noise = 0.005;  // of a pair

/// Replays that are off by k_bias; a pair shares what its placement does.
class Synthetic {
public:
    explicit Synthetic(unsigned seed, double noise = k_noise) : random_(seed), noise_(noise) {}
    double replay() { return k_truth + k_bias + k_spread * normal_(random_); }
    ReplayPair pair() {
        const double of_placement = k_spread * normal_(random_);
        return {k_truth + of_placement, k_truth + k_bias + of_placement + noise_ * normal_(random_)};
    }
    ReplayEstimate estimate(int replays, int pairs) {
        std::vector<double> values;
        std::vector<ReplayPair> of_both;
        for (int i = 0; i < replays; ++i) values.push_back(replay());
        for (int i = 0; i < pairs; ++i) of_both.push_back(pair());
        return estimate_spillage(values, of_both);
    }

private:
    std::mt19937 random_;
    double noise_;
    std::normal_distribution<double> normal_;
};

/// Share of trials whose interval holds the truth.
double coverage(Synthetic& synthetic, int pairs) {
    int held = 0;
    constexpr int trials = 4000;
    for (int i = 0; i < trials; ++i) {
        const ReplayEstimate estimate = synthetic.estimate(20, pairs);
        if (std::abs(estimate.spillage - k_truth) <= *estimate.interval) ++held;
    }
    return held / static_cast<double>(trials);
}

TEST(ReplayEstimate, is_unbiased_although_replays_are_not) {
    Synthetic synthetic(1);
    double both = 0.0, replays = 0.0;
    constexpr int trials = 2000;
    for (int i = 0; i < trials; ++i) {
        const ReplayEstimate estimate = synthetic.estimate(20, 3);
        both += estimate.spillage / trials;
        replays += estimate.replays.mean / trials;
    }
    // Standard error of the mean of all trials.
    const double error = std::sqrt((k_spread * k_spread / 20.0 + k_noise * k_noise / 3.0) / trials);
    EXPECT_NEAR(both, k_truth, 4.0 * error);
    EXPECT_NEAR(replays, k_truth + k_bias, 4.0 * error);
}

TEST(ReplayEstimate, interval_holds_the_truth_in_19_of_20_trials_or_more) {
    // Standard error of a share of 4,000 trials: 0.0034. By Welch's degrees of freedom two pairs hold it in 0.87 to 0.91 of them.
    for (const int pairs : {2, 3, 5})
        for (const double noise : {0.25 * k_spread, 0.5 * k_spread, k_spread, 3.0 * k_spread}) {
            Synthetic synthetic(2, noise);
            EXPECT_GT(coverage(synthetic, pairs), 0.94) << pairs << " pairs, noise " << noise;
        }
    Synthetic many(6, k_spread);
    EXPECT_LT(coverage(many, 20), 0.975) << "and not much more often where both have many values";
}

TEST(ReplayEstimate, interval_of_the_replays_alone_does_not_hold_it) {
    Synthetic synthetic(3);
    int held = 0;
    constexpr int trials = 500;
    for (int i = 0; i < trials; ++i) {
        const ReplayEstimate estimate = synthetic.estimate(20, 0);
        if (std::abs(estimate.spillage - k_truth) <= *estimate.replay_interval) ++held;
    }
    EXPECT_LT(held, 0.02 * trials);
}

TEST(ReplayEstimate, has_no_interval_of_one_pair) {
    const ReplayEstimate estimate = Synthetic(4).estimate(5, 1);
    EXPECT_TRUE(estimate.replay_interval);
    EXPECT_FALSE(estimate.interval);
    EXPECT_NE(replay_text(estimate, std::nullopt).find("two coupled runs"), std::string::npos);
}

TEST(ReplayEstimate, without_a_coupled_run_says_that_its_bias_is_unknown) {
    const std::string text = replay_text(Synthetic(5).estimate(5, 0), std::nullopt);
    EXPECT_NE(text.find("is not known"), std::string::npos);
}

TEST(ReplayEstimate, by_hand) {
    const ReplayEstimate estimate = estimate_spillage({0.8, 0.9, 1.0}, {{0.85, 0.80}, {0.95, 0.92}});
    EXPECT_NEAR(estimate.spillage, 0.9 + 0.04, 1e-12);
    EXPECT_NEAR(estimate.replays.variance, 0.01, 1e-12);
    EXPECT_NEAR(estimate.corrections.variance, 0.0002, 1e-12);
    // Student's factors of two and of one degree of freedom.
    EXPECT_NEAR(*estimate.interval, std::hypot(4.302653 * std::sqrt(0.01 / 3.0), 12.706205 * std::sqrt(0.0002 / 2.0)), 1e-6);
}

FedHead head(double fed, double delivered, double spilled, bool is_steady) {
    FedHead head;
    head.production.from = 3.0;
    head.production.to = 5.0;
    head.production.fed = fed;
    head.production.delivered = delivered;
    head.production.spilled = spilled;
    head.production.held = 2.0;
    head.production.is_steady = is_steady;
    std::tie(head.production.spillage_min, head.production.spillage_max) = std::minmax({spilled / fed, 1.0 - delivered / fed});
    return head;
}

TEST(FedReplays, say_how_many_have_settled_and_what_bounds_the_others) {
    FedHead full = head(20.0, 12.0, 6.0, false);
    full.is_full = true;
    full.losses = {0.2, 0.1, 0.04};
    full.production.share.emplace();
    full.production.share->half_interval = 0.013;
    const FedReplays fed = fed_replays_of({head(20.0, 10.0, 10.0, true), full});
    EXPECT_EQ(fed.count, 2u);
    EXPECT_EQ(fed.steady, 1u);
    EXPECT_EQ(fed.full, 1u);
    EXPECT_NEAR(fed.fed, 10.0, 1e-12);
    EXPECT_NEAR(fed.held, 2.0, 1e-12);
    EXPECT_NEAR(fed.spillage_min, 0.5 * (0.5 + 0.3), 1e-12);
    const std::string text = replay_text(estimate_spillage({0.5, 0.4}, {}), fed);
    for (const char* part : {"settled in 1 of 2", "40.0 to 45.0 %", "cannot take what it cuts in 1 of 2", "+- 1.3 points (95 %) at most",
                             "10.0 % after mixing, 5.0 % where it was cut, 2.0 % left behind"})
        EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(FedReplays, say_what_of_the_left_behind_was_never_taken_in_where_all_know_it) {
    FedHead known = head(20.0, 10.0, 10.0, true), unknown = known;
    known.losses = {0.1, 0.1, 0.3, 0.12};
    unknown.losses = {0.1, 0.1, 0.3, {}};
    const auto text_of = [](const std::vector<FedHead>& heads) {
        return replay_text(estimate_spillage({0.5, 0.4}, {}), fed_replays_of(heads));
    };
    EXPECT_NE(text_of({known, known}).find("30.0 % left behind (12.0 % never taken in)\n"), std::string::npos);
    EXPECT_NE(text_of({known, unknown}).find("30.0 % left behind\n"), std::string::npos);
}

TEST(FedReplays, have_bounds_in_order_where_hold_up_falls) {
    const FedReplays fed = fed_replays_of({head(20.0, 12.0, 10.0, false)});
    const std::string text = replay_text(estimate_spillage({0.4}, {}), fed);
    EXPECT_NE(text.find("40.0 to 50.0 %"), std::string::npos) << text;
    EXPECT_EQ(text.find("above 100 %"), std::string::npos) << text;
    const FedReplays empties = fed_replays_of({head(20.0, 0.0, 24.0, false)});
    EXPECT_NE(replay_text(estimate_spillage({1.0}, {}), empties)
                  .find("100.0 to 120.0 %, spilled/fed and 1 - delivered/fed: hold-up has not "
                        "settled (above 100 %: it falls, more is spilled than fed)"),
              std::string::npos);
}

TEST(FedReplays, have_no_bounds_where_all_have_settled) {
    const FedReplays fed = fed_replays_of({head(20.0, 10.0, 10.0, true)});
    const std::string text = replay_text(estimate_spillage({0.5}, {}), fed);
    EXPECT_EQ(text.find("bounds"), std::string::npos) << text;
    EXPECT_EQ(text.find("full"), std::string::npos) << text;
}

constexpr double k_revolution = 1.0;  // of the small run [s]
constexpr int k_blades = 2;

/// In masses of a small rock: 3 and the large one's 8 are spilled, 3 are sucked up.
TEST(RockAnswer, of_a_batch_is_told_by_what_has_left) {
    const testing::SmallRun run("batch_answer");
    run.write();
    const RockAnswer answer = rock_answer(run.directory, false, k_revolution, k_blades);
    ASSERT_TRUE(answer.spillage);
    EXPECT_NEAR(*answer.spillage, 11.0 / 14.0, 1e-6);
    EXPECT_FALSE(answer.fed);
}

/// Fates alone would say 11/14: a head that is fed all the time is told by its own window, coupled or replayed.
TEST(RockAnswer, of_a_fed_head_is_one_less_what_is_delivered_in_its_window) {
    const testing::SmallRun run("fed_answer");
    run.write();
    testing::make_fed(run, 20.0);
    const RockAnswer answer = rock_answer(run.directory, true, k_revolution, k_blades);
    ASSERT_TRUE(answer.fed);
    ASSERT_TRUE(answer.spillage);
    EXPECT_NEAR(*answer.spillage, 0.4, 0.01);
}

TEST(RockAnswer, says_why_there_is_none) {
    testing::SmallRun run("no_answer");
    run.with_rock = false;
    run.write();
    EXPECT_EQ(rock_answer(run.directory, false, k_revolution, k_blades).reason, "no rock has come in yet");

    const testing::SmallRun fed("short_answer");
    fed.write();
    testing::make_fed(fed, 20.0);
    const RockAnswer answer = rock_answer(fed.directory, true, 100.0, k_blades);  // of a rotor that never came round
    EXPECT_FALSE(answer.spillage);
    EXPECT_NE(answer.reason.find("no whole revolution is left after the start-up: of 300 kg"), std::string::npos) << answer.reason;
}

}  // namespace
}  // namespace cutterflow::postproc
