// Where spilled rock left the head.
#include "postproc/analysis/exits/last_exits.hpp"
#include "postproc/analysis/replays/exits.hpp"

#include <cmath>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "postproc/run/run_reader.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

using ::testing::HasSubstr;
using testing::SmallRun;

Spillage evaluate(const SmallRun& run) {
    run.write();
    const RunData data = read_run(run.directory);
    return evaluate_spillage(data.rock->fates, data.rock->events, data.bins, data.operating_point.revolution_s(), data.finished);
}

/// Exits through two bins, all of it in one sector.
Exits through(double upper, std::size_t sector) {
    Exits exits{{"gap", "0-30mm"}, {upper, 1.0 - upper}, {}};
    exits.by_sector[sector] = 1.0;
    return exits;
}

// Two rocks of one mass by the gap, one by 0-30mm, one of eight times the mass by 60-90mm.
TEST(Exits, are_shares_of_the_spilled_mass) {
    const SmallRun run("exits");
    const Exits exits = *exits_of(evaluate(run));
    const std::map<std::string, double> spilled{{"gap", 2.0 / 11.0}, {"0-30mm", 1.0 / 11.0}, {"60-90mm", 8.0 / 11.0}};
    ASSERT_EQ(exits.bins.size(), exits.by_bin.size());
    for (std::size_t b = 0; b < exits.bins.size(); ++b) {
        const auto expected = spilled.find(exits.bins[b]);
        EXPECT_NEAR(exits.by_bin[b], expected == spilled.end() ? 0.0 : expected->second, 1e-6) << exits.bins[b];
    }
}

TEST(Exits, count_rocks_by_the_azimuth_of_their_first_exit) {
    SmallRun run("exit_azimuths");
    int left = 0;
    for (testing::Event& event : run.events)
        if (event.surface == "head" && event.direction == "out") event.azimuth = ++left == 1 ? 6.2831 : 1.6;  // last and third sector
    const Spillage spillage = evaluate(run);
    const Exits exits = *exits_of(spillage);
    const double share = 1.0 / static_cast<double>(spillage.first_exit_azimuths.size());
    EXPECT_NEAR(exits.by_sector[7], share, 1e-12);
    EXPECT_NEAR(exits.by_sector[2], 1.0 - share, 1e-12);
}

TEST(Exits, of_nothing_spilled_are_nothing) {
    EXPECT_FALSE(exits_of({}));
}

TEST(Exits, are_told_as_means_with_the_smallest_and_the_largest) {
    const std::vector<Exits> two{through(0.2, 7), through(0.4, 0)};
    const std::string csv = exits_csv(two);
    EXPECT_THAT(csv,
                HasSubstr("where,place,share,smallest,largest\nbin,gap,0.3,0.2,0.4\nbin,0-30mm,0.7,0.6,0.8\nazimuth_deg,0-45,0.5,0,1\n"));
    EXPECT_THAT(csv, HasSubstr("azimuth_deg,315-360,0.5,0,1\n"));
    EXPECT_EQ(exits_text(mean_exits(two)),
              "exits       70 % at 0-30mm, 30 % at gap of what is spilled; 100 % of the rocks from azimuth 225 to 45 deg (0 lowest)\n");
}

double mass_over_small(const RockAmount& amount) {
    return amount.mass / testing::small_rock_mass();
}

RunData small_run(const std::string& name) {
    const SmallRun run(name);
    run.write();
    return read_run(run.directory);
}

// Rock 1 left at 6 degrees, 2 at 96, 3 at 186 and after it had come back at 11, 9 of eight times the mass at 281; 6 was sucked up.
TEST(LastExits, are_masses_by_azimuth_and_by_the_sides_of_the_swing) {
    const RunData run = small_run("last_exits");
    OperatingPoint point = run.operating_point;
    const auto exits = [&] { return last_exits_of(run.rock->events, run.bins, point, 1.0, 2.0, 1.0); };
    const LastExits over_cut = exits();
    for (std::size_t s = 0; s < k_last_exit_sectors; ++s) {
        const double expected = s == 0 ? 2.0 : s == 3 ? 1.0 : s == 9 ? 8.0 : 0.0;
        EXPECT_NEAR(mass_over_small(over_cut.sectors[s]), expected, 1e-6) << s;
    }
    EXPECT_EQ(over_cut.sectors[0].count, 2);
    ASSERT_TRUE(over_cut.quarters);
    EXPECT_FALSE(over_cut.quarters->bank_at_90) << "over-cut of a right-handed rotor: blades beside the bank go down";
    EXPECT_NEAR(mass_over_small(over_cut.quarters->bank_side), 8.0, 1e-6);
    EXPECT_NEAR(mass_over_small(over_cut.quarters->trailing_side), 1.0, 1e-6);
    EXPECT_NEAR(mass_over_small(over_cut.quarters->bottom), 2.0, 1e-6);
    EXPECT_EQ(over_cut.quarters->top.count, 0);
    point.swing_direction = "under_cut";
    EXPECT_NEAR(mass_over_small(exits().quarters->bank_side), 1.0, 1e-6);
    point.rotor_direction = "left_handed";
    EXPECT_NEAR(mass_over_small(exits().quarters->bank_side), 8.0, 1e-6);
    point.swing_direction = "";
    EXPECT_FALSE(exits().quarters);
}

TEST(LastExits, are_of_their_window_as_its_end_finds_the_rock) {
    const RunData run = small_run("last_exits_window");
    const auto by_bin = [&](double from, double to) {
        std::map<std::string, double> masses;
        for (const BinSpillage& bin : last_exits_of(run.rock->events, run.bins, run.operating_point, from, to, 1.0).bins)
            if (bin.spilled.count > 0) masses[bin.bin.name] = std::round(mass_over_small(bin.spilled));
        return masses;
    };
    using Masses = std::map<std::string, double>;
    EXPECT_EQ(by_bin(1.0, 2.0), (Masses{{"gap", 2.0}, {"0-30mm", 1.0}, {"60-90mm", 8.0}}));
    EXPECT_EQ(by_bin(1.28, 1.35), (Masses{{"gap", 1.0}})) << "rock 3 is outside, rocks 1 and 2 left before";
    EXPECT_EQ(by_bin(1.28, 1.68), (Masses{{"60-90mm", 8.0}})) << "rock 3 came back, rock 6 too";
    EXPECT_EQ(by_bin(1.45, 1.55), (Masses{{"below_hub", 1.0}})) << "rock 6 has not come back yet";
}

}  // namespace
}  // namespace cutterflow::postproc
