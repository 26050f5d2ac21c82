#include "geometry/base/at_work/usual_ranges.hpp"

#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/file_content.hpp"

namespace cutterflow {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(UsualRanges, take_the_prototypes_values_by_froudes_law) {
    // A model at 1:4: lengths four times as long, speeds and times twice.
    EXPECT_THAT(outside_usual_ranges({{at_work::k_ring_diameter, 0.8},
                                      {at_work::k_rotor_speed, 60.0},
                                      {at_work::k_tip_speed, 2.5},
                                      {at_work::k_swing_speed, 6.0},
                                      {at_work::k_step, 0.16},
                                      {at_work::k_cut_height, 0.6},
                                      {at_work::k_ladder, 45.0},
                                      {at_work::k_mouth_speed, 2.0}},
                                     4.0),
                IsEmpty());
    EXPECT_THAT(outside_usual_ranges({{at_work::k_ring_diameter, 0.8}, {at_work::k_rotor_speed, 60.0}, {at_work::k_swing_speed, 6.0}}, 1.0),
                ElementsAre("ring diameter 0.8 m (1.5 to 3.5)", "rotor speed 60 rpm (20 to 40)", "swing speed 6 m/min (10 to 25)"));
    EXPECT_THAT(outside_usual_ranges({{at_work::k_rotor_speed, 90.0}, {at_work::k_step, 0.6}, {at_work::k_ladder, 20.0}}, 4.0),
                ElementsAre("rotor speed 45 rpm (20 to 40)", "step 2.4 m (0.5 to 2)", "ladder 20 degrees (25 to 45)"));
}

TEST(UsualRanges, do_not_scale_densities_and_shares) {
    EXPECT_THAT(outside_usual_ranges({{at_work::k_mixture_density, 1150.0}, {at_work::k_spillage, 35.0}}, 4.0), IsEmpty());
    EXPECT_THAT(outside_usual_ranges({{at_work::k_mixture_density, 1030.0}, {at_work::k_spillage, 95.0}}, 4.0),
                ElementsAre("mixture density 1030 kg/m3 (1050 to 1200)", "spillage 95 % (20 to 50)"));
}

TEST(UsualRanges, each_have_their_ends_in_order_and_a_source) {
    std::set<std::string> keys;
    for (const UsualRange& range : usual_ranges()) {
        EXPECT_LT(range.from, range.to) << range.key;
        EXPECT_FALSE(range.source.empty()) << range.key;
        EXPECT_TRUE(keys.insert(range.key).second) << range.key;
        EXPECT_THAT(outside_usual_ranges({{range.key, range.from}}, 1.0), IsEmpty()) << range.key;
        EXPECT_THAT(outside_usual_ranges({{range.key, range.to}}, 1.0), IsEmpty()) << range.key;
    }
}

TEST(UsualRanges, are_those_of_the_manual) {
    const std::string manual = read_file(std::string(CUTTERFLOW_SOURCE_DIR) + "/docs/user/head_at_work.md");
    const std::size_t table = manual.find("What usual practice in rock is");
    for (const UsualRange& range : usual_ranges()) {
        const std::size_t row = manual.find("| " + range.name, table);
        ASSERT_NE(row, std::string::npos) << range.name;
        const std::string line = manual.substr(row, manual.find('\n', row) - row), from = fmt::format("| {:g}", range.from),
                          to = fmt::format("| {:g}", range.to);
        EXPECT_THAT(line, ::testing::ContainsRegex("\\" + from + "[ °].*\\" + to + "[ °]"));
    }
}

}  // namespace
}  // namespace cutterflow
