#include "postproc/analysis/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "geometry/base/error.hpp"
#include "geometry/base/run_files.hpp"
#include "postproc/pages/comparison_figures.hpp"
#include "postproc/pages/comparison_page.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::SmallRun;

const Quantity& quantity_of(const Comparison& comparison, const std::string& key) {
    for (const Quantity& quantity : comparison.quantities)
        if (quantity.key == key) return quantity;
    throw std::runtime_error("no quantity " + key);
}

/// The small run in which the given rocks, sucked up in the original, leave by the gap instead.
fs::path variant(const std::string& name, const std::vector<int>& spilled_instead, double length_ratio = 1.0) {
    SmallRun run(name);
    run.length_ratio = length_ratio;
    for (testing::Event& event : run.events)
        for (const int id : spilled_instead)
            if (event.id == id && event.surface == "mouth") {
                event.surface = "head";
                event.direction = "out";
                event.bin = "gap";
            }
    run.write();
    return run.directory;
}

TEST(Comparison, takes_runs_of_one_setting_for_repeats_and_gives_students_interval) {
    const Comparison comparison = compare_runs({variant("repeat_1", {}), variant("repeat_2", {4}), variant("repeat_3", {4, 5})});
    ASSERT_EQ(comparison.settings.size(), 1u);
    EXPECT_EQ(comparison.settings[0].runs.size(), 3u);
    // By mass of 16 small rocks: 11 spilled and 3 sucked up, 12 and 2, 13 and 1.
    const double r[] = {11.0 / 14.0, 12.0 / 14.0, 13.0 / 14.0};
    const Estimate& ratio = quantity_of(comparison, "ratio").settings[0];
    EXPECT_NEAR(*ratio.value, r[1], 1e-9);
    EXPECT_NEAR(*ratio.half_width, 4.302653 * (r[1] - r[0]) / std::sqrt(3.0), 1e-6);
    EXPECT_NEAR(*ratio.low, 12.0 / 16.0, 1e-9);
    EXPECT_NEAR(*ratio.high, 14.0 / 16.0, 1e-9);
}

TEST(Comparison, of_single_runs_has_bounds_and_no_interval) {
    const Comparison comparison = compare_runs({variant("single_a", {}), variant("single_b", {4, 5, 6}, 2.0)});
    ASSERT_EQ(comparison.settings.size(), 2u);
    const Quantity& ratio = quantity_of(comparison, "ratio");
    EXPECT_FALSE(ratio.settings[0].half_width);
    const Difference difference = difference_of(comparison, ratio, 1);
    EXPECT_NEAR(*difference.estimate.value, 1.0 - 11.0 / 14.0, 1e-9);
    EXPECT_NEAR(*difference.estimate.low, 14.0 / 16.0 - 13.0 / 16.0, 1e-9);
    EXPECT_NEAR(*difference.estimate.high, 1.0 - 11.0 / 16.0, 1e-9);
    EXPECT_EQ(difference.verdict, ComparisonVerdict::no_replicate);
    EXPECT_EQ(difference_of(comparison, quantity_of(comparison, "production"), 1).verdict, ComparisonVerdict::no_replicate);
    EXPECT_EQ(difference_of(comparison, quantity_of(comparison, "cells"), 1).verdict, ComparisonVerdict::no_interval);
}

fs::path fed(const std::string& name, double stuck, double length_ratio) {
    SmallRun run(name);
    run.length_ratio = length_ratio;
    run.write();
    testing::make_fed(run, 5.0, stuck);
    testing::add_events(run.directory, {{10.0, 101, "head", "out", "gap"}, {11.0, 102, "head", "out", "gap"}});
    return run.directory;
}

// 60 % of what goes on is delivered: of all that is fed, of four fifths in a head that fills, of a tenth less.
TEST(Comparison, of_fed_heads_has_shares_with_their_intervals_and_hold_up) {
    const Comparison comparison = compare_runs({fed("fed_a", 0.0, 1.0), fed("fed_b", 0.2, 2.0), fed("fed_c", 0.04, 3.0)});
    const Quantity &spillage = quantity_of(comparison, "ratio"), &production = quantity_of(comparison, "production");
    EXPECT_NEAR(*spillage.settings[0].value, 0.4, 0.01);
    EXPECT_GT(*spillage.settings[0].half_width, 0.0);
    EXPECT_FALSE(spillage.settings[0].low);
    EXPECT_NEAR(*production.settings[0].value, 0.6, 0.01);
    EXPECT_FALSE(spillage.settings[1].value) << "it still fills";
    EXPECT_NEAR(*spillage.settings[1].low, 0.32, 0.01);
    EXPECT_NEAR(*spillage.settings[1].high, 0.52, 0.01);
    EXPECT_NEAR(*production.settings[1].value, 0.48, 0.01);
    const Quantity& held = quantity_of(comparison, "hold_up_kg");
    EXPECT_NEAR(*held.settings[0].value, 5.0, 1e-6);
    EXPECT_GT(*held.settings[1].value, 10.0);
    EXPECT_NEAR(*quantity_of(comparison, "hold_up_change_share").settings[1].value, 0.2, 0.01);
    // 6 kg/s of soil with 2000 kg/m3 of grains; 2 times as long: 2^2.5 times as much.
    EXPECT_NEAR(*quantity_of(comparison, "delivered_in_situ_m3_h").settings[0].value, 10.8, 0.2);
    EXPECT_NEAR(*quantity_of(comparison, "prototype_delivered_in_situ_m3_h").settings[1].value,
                5.656854 * *quantity_of(comparison, "delivered_in_situ_m3_h").settings[1].value, 1e-3);
    const Difference difference = difference_of(comparison, production, 1);
    EXPECT_NEAR(*difference.estimate.half_width, std::hypot(*production.settings[0].half_width, *production.settings[1].half_width), 1e-12);
    EXPECT_EQ(difference.verdict, ComparisonVerdict::differs);
    EXPECT_THAT(comparison_text(comparison), HasSubstr("[0.3"));
    for (const Quantity& quantity : comparison.quantities)
        for (const Estimate& estimate : quantity.settings) {
            EXPECT_EQ(estimate.low.has_value(), estimate.high.has_value()) << quantity.key;
            if (estimate.low) EXPECT_LE(*estimate.low, *estimate.high) << quantity.key;
        }
    for (const Quantity& quantity : comparison.quantities) {
        EXPECT_NE(quantity.key, "ratio_at_equal_time");
        EXPECT_NE(quantity.key, "energy_per_volume_j_m3") << "it is over the whole time, start-up included";
    }
    // Two rocks in the window, over what was fed in it: not the four of the start, and not over what was placed.
    const Quantity& gap = quantity_of(comparison, "spilled_gap_share");
    EXPECT_EQ(gap.name, "spilled / fed, gap");
    EXPECT_NEAR(*gap.settings[0].value, 2.0 * testing::small_rock_mass() / comparison.runs[0].results.fed->production.fed, 1e-9);
    EXPECT_EQ(*quantity_of(comparison, "spilled_0-30mm_share").settings[0].value, 0.0);
    for (const Figure& figure : comparison_figures(comparison))
        if (figure.plot.name == "spilled") EXPECT_EQ(figure.plot.x.title, "spilled, % of the fed mass");
}

/// A placement of its own of the fed head.
fs::path fed_repeat(const std::string& name, double stuck, int seed) {
    const fs::path directory = fed(name, stuck, 1.0);
    const fs::path study = directory / names::resolved_study;
    testing::write_text(study, testing::read_text(study) + fmt::format("seed = {}\n", seed));
    return directory;
}

// 40 % are spilled where the hold-up is settled, 32 to 52 % where a fifth of the feed stays in the head.
TEST(Comparison, of_fed_repeats_of_which_one_still_fills_has_bounds) {
    const std::vector<fs::path> runs{fed_repeat("settled_1", 0.0, 1), fed_repeat("settled_2", 0.0, 2), fed_repeat("filling_3", 0.2, 3)};
    const Comparison mixed = compare_runs(runs);
    ASSERT_EQ(mixed.settings.size(), 1u);
    const Estimate& spillage = quantity_of(mixed, "ratio").settings[0];
    EXPECT_FALSE(spillage.value) << "of one repeat it is not known";
    EXPECT_FALSE(spillage.half_width);
    ASSERT_TRUE(spillage.low && spillage.high);
    EXPECT_NEAR(*spillage.low, (0.4 + 0.4 + 0.32) / 3.0, 0.01);
    EXPECT_NEAR(*spillage.high, (0.4 + 0.4 + 0.52) / 3.0, 0.01);
    EXPECT_TRUE(quantity_of(mixed, "production").settings[0].value);
    EXPECT_FALSE(quantity_of(mixed, "production").settings[0].low) << "it has no bounds in any repeat";
    EXPECT_THAT(comparison_text(mixed), HasSubstr("| spillage: 1 - delivered / fed | [0.37"));
    const Comparison settled = compare_runs({runs[0], runs[1]});
    EXPECT_FALSE(quantity_of(settled, "ratio").settings[0].low) << "no bounds where every repeat is settled";
}

/// The small run with a torque that is noted often.
fs::path pushed(const std::string& name, double torque, double length_ratio) {
    const fs::path directory = variant(name, {}, length_ratio);
    std::string rows = "time_s,rotor_angle_rad,torque_pressure_n_m,torque_viscous_n_m,torque_rock_n_m,power_w\n";
    for (int step = 1; step <= 2000; ++step) {
        const double time = 0.001 * step;
        rows += fmt::format("{:.9g},{:.9g},{:.9g},0,0,60\n", time, 2.0 * k_pi * time, torque + std::sin(17.0 * time));
    }
    testing::write_text(directory / "postProcessing/loads/0/loads.csv", rows);
    return directory;
}

TEST(Comparison, of_flows_has_intervals_and_no_bounds) {
    const Comparison comparison = compare_runs({pushed("pushed_a", -10.0, 1.0), pushed("pushed_b", -20.0, 2.0)});
    const Quantity& torque = quantity_of(comparison, "torque_flow_mean_n_m");
    ASSERT_EQ(comparison.settings.size(), 2u);
    ASSERT_TRUE(torque.settings[0].half_width);
    EXPECT_NEAR(*torque.settings[0].half_width, *comparison.runs[0].results.rotor.torque_flow->half_interval, 1e-12);
    EXPECT_FALSE(torque.settings[0].low || torque.settings[0].high);
    EXPECT_EQ(difference_of(comparison, torque, 1).verdict, ComparisonVerdict::differs);
}

/// The small run with a drive of a constant power.
fs::path driven(const std::string& name, const std::vector<int>& spilled_instead, double power) {
    const fs::path directory = variant(name, spilled_instead);
    std::string rows = "time_s,rotor_angle_rad,torque_pressure_n_m,torque_viscous_n_m,torque_rock_n_m,power_w\n";
    for (int step = 1; step <= 2000; ++step) rows += fmt::format("{:.9g},{:.9g},-10,0,0,{}\n", 0.001 * step, 0.002 * k_pi * step, power);
    testing::write_text(directory / "postProcessing/loads/0/loads.csv", rows);
    return directory;
}

TEST(Comparison, of_a_drive_that_rock_loads_has_the_interval_of_its_repeats) {
    const Comparison comparison =
        compare_runs({driven("power_1", {}, 60.0), driven("power_2", {4}, 66.0), driven("power_3", {4, 5}, 72.0)});
    const Estimate& power = quantity_of(comparison, "power_mean_w").settings.at(0);
    EXPECT_NEAR(*power.value, 66.0, 1e-9);
    EXPECT_NEAR(*power.half_width, 4.302653 * 6.0 / std::sqrt(3.0), 1e-5) << "each run's own power does not scatter";
}

fs::path swinging(const std::string& name, double swing_m_min) {
    const fs::path directory = fed(name, 0.0, 1.0);
    testing::set_swing_speed(directory, swing_m_min);
    return directory;
}

TEST(Comparison, of_fed_heads_is_drawn_against_the_swing_speed) {
    const Comparison comparison = compare_runs({swinging("swing_8", 8.0), swinging("swing_4", 4.0), swinging("swing_6", 6.0)});
    EXPECT_NEAR(*quantity_of(comparison, "swing_speed_m_min").settings[0].value, 8.0, 1e-12);
    int drawn = 0;
    for (const Figure& figure : comparison_figures(comparison)) {
        if (figure.plot.name == "delivered_swing_speed") {
            ++drawn;
            EXPECT_THAT(figure.plot.series.at(0).x, ::testing::ElementsAre(4.0, 6.0, 8.0));
            EXPECT_NEAR(figure.plot.series[0].y[0], 10.8, 0.2);
            EXPECT_GT(figure.plot.series[0].y_high[0], figure.plot.series[0].y[0]);
        }
        if (figure.plot.name != "swing_speed") continue;
        ++drawn;
        ASSERT_EQ(figure.plot.series.size(), 2u) << "one curve of spillage, one of production";
        EXPECT_THAT(figure.plot.series[1].x, ::testing::ElementsAre(4.0, 6.0, 8.0));
        EXPECT_NEAR(figure.plot.series[1].y[0], 60.0, 1.0);
    }
    EXPECT_EQ(drawn, 2);
}

/// A fed head of a sweep, its mouth elsewhere.
fs::path of_sweep(const std::string& name, double rpm, double mouth_azimuth_deg, double stuck = 0.0) {
    SmallRun run(name);
    run.study_name = fmt::format("heads: {:g}rpm_mouth_azimuth_deg_{:g}", rpm, mouth_azimuth_deg);
    run.speed_rpm = rpm;
    run.write();
    testing::make_fed(run, 5.0, stuck);
    std::string study = testing::read_text(run.directory / names::resolved_study);
    const std::string key = "mouth_azimuth_deg = 0";
    study.replace(study.find(key), key.size(), fmt::format("mouth_azimuth_deg = {:g}", mouth_azimuth_deg));
    testing::write_text(run.directory / names::resolved_study, study);
    return run.directory;
}

TEST(Comparison, joins_settings_of_a_sweep_that_differ_in_one_key_alone) {
    const Comparison comparison = compare_runs(
        {of_sweep("mouth_a", 45.0, 0.0), of_sweep("mouth_b", 45.0, 90.0), of_sweep("mouth_c", 60.0, 0.0), of_sweep("mouth_d", 45.0, 45.0)});
    std::vector<std::string> labels;
    for (const ComparedSetting& setting : comparison.settings) labels.push_back(setting.label);
    EXPECT_THAT(labels, ::testing::ElementsAre("45 rpm, suction.mouth_azimuth_deg = 0", "45 rpm, suction.mouth_azimuth_deg = 90",
                                               "60 rpm, suction.mouth_azimuth_deg = 0", "45 rpm, suction.mouth_azimuth_deg = 45"));
    std::map<std::string, std::vector<double>> speed, mouth;
    for (const Figure& figure : comparison_figures(comparison))
        for (const Series& series : figure.plot.series) {
            if (figure.plot.name == "speed") speed[series.name] = series.x;
            if (figure.plot.name == "suction_mouth_azimuth_deg") mouth[series.name] = series.x;
        }
    EXPECT_THAT(speed["production, suction.mouth_azimuth_deg = 0"], ::testing::ElementsAre(45.0, 60.0));
    EXPECT_THAT(speed["production, suction.mouth_azimuth_deg = 90"], ::testing::ElementsAre(45.0));
    EXPECT_THAT(mouth["production, 45 rpm"], ::testing::ElementsAre(0.0, 45.0, 90.0));
    EXPECT_THAT(mouth["production, 60 rpm"], ::testing::ElementsAre(0.0));
}

/// A fed head at a speed of rotor and swing. \param stuck  of what is fed: less is delivered
fs::path at_point(const std::string& name, double rpm, double swing_m_min, double stuck, double mouth_azimuth_deg = 0.0) {
    const fs::path directory = of_sweep(name, rpm, mouth_azimuth_deg, stuck);
    testing::set_swing_speed(directory, swing_m_min);
    return directory;
}

std::vector<Figure> maps_of(const std::vector<fs::path>& runs) {
    std::vector<Figure> maps;
    for (const Figure& figure : comparison_figures(compare_runs(runs)))
        if (figure.plot.name.rfind("delivered_map", 0) == 0) maps.push_back(figure);
    return maps;
}

TEST(DeliveredMap, has_a_cell_for_every_setting_and_none_where_nothing_was_run) {
    const std::vector<Figure> maps =
        maps_of({at_point("map_a", 30.0, 4.0, 0.045), at_point("map_b", 60.0, 4.0, 0.045), at_point("map_c", 30.0, 8.0, 0.045),
                 at_point("map_d", 60.0, 8.0, 0.0), at_point("map_e", 120.0, 10.0, 0.045)});
    ASSERT_EQ(maps.size(), 1u);
    const Plot& plot = maps[0].plot;
    ASSERT_EQ(plot.bars.size(), 5u) << "of nine places";
    const Bar& best = plot.bars[3];  // half-way to 30 and 120 rpm, to 4 and 10 m/min
    EXPECT_EQ(best.from, 45.0);
    EXPECT_EQ(best.to, 90.0);
    EXPECT_NEAR(best.at, 7.5, 1e-12);
    EXPECT_NEAR(best.thickness, 3.0, 1e-12);
    EXPECT_THAT(best.tip, ::testing::MatchesRegex("60 rpm, 8 m/min: 10\\.[789][0-9]* ± 0\\.[0-9]+ m³/h"));
    EXPECT_EQ(best.colour, palette::field[4]) << "the largest value is the darkest";
    EXPECT_EQ(plot.bars[4].from, 90.0);
    EXPECT_EQ(plot.bars[4].to, 150.0);
    EXPECT_NEAR(*plot.y.to, 11.0, 1e-12);
    EXPECT_THAT(maps[0].caption,
                HasSubstr("Of these points 60 rpm with a swing of 8 m/min delivers most: its 95 % interval is apart from all "
                          "others."));
}

TEST(DeliveredMap, names_no_best_point_where_intervals_overlap) {
    const std::vector<Figure> maps = maps_of({at_point("even_a", 30.0, 4.0, 0.045), at_point("even_b", 60.0, 4.0, 0.001),
                                              at_point("even_c", 30.0, 8.0, 0.045), at_point("even_d", 60.0, 8.0, 0.0)});
    ASSERT_EQ(maps.size(), 1u);
    EXPECT_THAT(maps[0].caption,
                HasSubstr("No best point within the error: the 95 % interval of 1 other point overlaps that of the largest "
                          "value."));
    EXPECT_THAT(maps_of({at_point("fill_a", 30.0, 4.0, 0.2), at_point("fill_b", 60.0, 4.0, 0.2), at_point("fill_c", 30.0, 8.0, 0.0),
                         at_point("fill_d", 60.0, 8.0, 0.2)})
                    .at(0)
                    .caption,
                HasSubstr("delivery is not steady"));
}

TEST(DeliveredMap, says_that_the_best_point_is_at_the_edge) {
    EXPECT_THAT(maps_of({at_point("edge_a", 30.0, 4.0, 0.045), at_point("edge_b", 60.0, 4.0, 0.045), at_point("edge_c", 30.0, 8.0, 0.045),
                         at_point("edge_d", 60.0, 8.0, 0.0)})
                    .at(0)
                    .caption,
                HasSubstr("apart from all others, but it lies at the edge of what was run"));
}

TEST(DeliveredMap, joins_no_settings_that_differ_in_anything_else) {
    EXPECT_TRUE(maps_of({at_point("other_a", 30.0, 4.0, 0.0), at_point("other_b", 60.0, 4.0, 0.0), at_point("other_c", 30.0, 8.0, 0.0),
                         at_point("other_d", 60.0, 8.0, 0.0, 90.0)})
                    .empty());
    EXPECT_TRUE(maps_of({swinging("alone_2", 2.0), swinging("alone_4", 4.0), swinging("alone_6", 6.0), swinging("alone_8", 8.0)}).empty())
        << "one speed of the rotor";
}

// 60 % of what goes on are delivered: 48 % of all where a fifth of the feed stays in the head.
TEST(Comparison, marks_heads_that_still_fill_in_every_curve) {
    const Comparison comparison =
        compare_runs({of_sweep("fills_a", 30.0, 0.0), of_sweep("fills_b", 60.0, 0.0, 0.2), of_sweep("fills_c", 90.0, 0.0)});
    int drawn = 0;
    for (const Figure& figure : comparison_figures(comparison)) {
        std::map<std::string, Series> by_name;
        for (const Series& series : figure.plot.series) by_name[series.name] = series;
        for (const std::string name : {"production", "delivered"}) {
            if (by_name.count(name) == 0) continue;
            ++drawn;
            const Series &settled = by_name[name], &changing = by_name[name + ", hold-up still changes"];
            EXPECT_EQ(settled.x.size(), 2u) << figure.plot.name;
            EXPECT_EQ(settled.mark, Mark::disc) << figure.plot.name;
            ASSERT_EQ(changing.x.size(), 1u) << figure.plot.name;
            EXPECT_EQ(changing.mark, Mark::ring) << figure.plot.name;
            EXPECT_EQ(changing.line_width, 0.0) << figure.plot.name;
            EXPECT_EQ(changing.colour, settled.colour) << figure.plot.name;
            EXPECT_THAT(changing.point_names.at(0), HasSubstr("60 rpm"));
            if (name == "production") EXPECT_NEAR(changing.y[0], 48.0, 1.0) << figure.plot.name;
            EXPECT_THAT(figure.caption, HasSubstr("Open marks, joined by no line: the hold-up still changes"));
        }
    }
    EXPECT_EQ(drawn, 4) << "by setting, against the speed, soil against it, against the flow number";
    for (const Figure& figure : comparison_figures(compare_runs({of_sweep("fills_d", 30.0, 0.0), of_sweep("fills_e", 60.0, 0.0)})))
        EXPECT_EQ(figure.caption.find("Open marks"), std::string::npos) << figure.plot.name;
}

TEST(Comparison, names_a_key_only_where_it_tells_settings_apart) {
    const Comparison comparison = compare_runs({of_sweep("both_a", 45.0, 0.0), of_sweep("both_b", 60.0, 90.0)});
    EXPECT_EQ(comparison.settings[1].label, "60 rpm");
    for (const Figure& figure : comparison_figures(comparison)) {
        EXPECT_NE(figure.plot.name, "suction_mouth_azimuth_deg") << "no two settings differ in it alone";
        if (figure.plot.name != "speed") continue;
        EXPECT_EQ(figure.plot.series.size(), 4u) << "no curve joins settings with other mouths";
    }
}

TEST(Comparison, of_a_batch_and_a_fed_head_is_refused) {
    EXPECT_THROW(compare_runs({variant("batch", {}), fed("not_a_batch", 0.0, 2.0)}), UserError);
}

TEST(Comparison, gives_settings_of_equal_names_labels_of_their_own) {
    std::vector<fs::path> directories;
    for (const char* name : {"labels/a", "labels/b", "labels/other/a", "labels/c"}) {
        SmallRun run(name);
        run.length_ratio = 1.0 + static_cast<double>(directories.size());
        if (directories.size() == 3) run.study_name = "another";
        run.write();
        directories.push_back(run.directory);
    }
    const std::vector<ComparedSetting> settings = compare_runs(directories).settings;
    ASSERT_EQ(settings.size(), 4u);
    EXPECT_EQ(settings[0].label, "small run (a) (" + directories[0].string() + ")");
    EXPECT_EQ(settings[1].label, "small run (b)");
    EXPECT_EQ(settings[2].label, "small run (a) (" + directories[2].string() + ")");
    EXPECT_EQ(settings[3].label, "another");
}

TEST(Comparison, says_when_bounds_or_scatter_hide_a_difference) {
    // One rock more spilled, two undecided: the bounds hold zero.
    const Comparison bounded = compare_runs({variant("bounds_a", {}), variant("bounds_b", {4}, 2.0)});
    EXPECT_EQ(difference_of(bounded, quantity_of(bounded, "ratio"), 1).verdict, ComparisonVerdict::undecided);
    // Three repeats each; the same mean within their scatter in what has no bounds.
    const Comparison scattered =
        compare_runs({variant("scatter_a1", {}), variant("scatter_a2", {4}), variant("scatter_a3", {4, 5}), variant("scatter_b1", {4}, 2.0),
                      variant("scatter_b2", {}, 2.0), variant("scatter_b3", {4, 5}, 2.0)});
    ASSERT_EQ(scattered.settings.size(), 2u);
    EXPECT_EQ(difference_of(scattered, quantity_of(scattered, "spilled_at_equal_time"), 1).verdict, ComparisonVerdict::equal);
    // All repeats apart from all others.
    const Comparison apart =
        compare_runs({variant("apart_a1", {}), variant("apart_a2", {}), variant("apart_a3", {}), variant("apart_b1", {4, 5, 6}, 2.0),
                      variant("apart_b2", {4, 5, 6}, 2.0), variant("apart_b3", {4, 5, 6}, 2.0)});
    EXPECT_EQ(difference_of(apart, quantity_of(apart, "spilled_at_equal_time"), 1).verdict, ComparisonVerdict::differs);
}

TEST(Comparison, is_made_at_the_time_and_the_revolutions_that_all_runs_reached) {
    SmallRun longer("longer"), shorter("shorter");
    shorter.end_time = 1.5;
    shorter.finished = false;
    shorter.length_ratio = 2.0;
    longer.write();
    shorter.write();
    const Comparison comparison = compare_runs({longer.directory, shorter.directory});
    EXPECT_NEAR(*comparison.equal_time, 0.5, 1e-9);
    EXPECT_NEAR(*comparison.equal_revolutions, 0.5, 1e-9);
    const Quantity& spilled = quantity_of(comparison, "spilled_at_equal_time");
    EXPECT_DOUBLE_EQ(*spilled.settings[0].value, *spilled.settings[1].value);
}

TEST(Comparison, has_no_equal_point_when_a_run_has_yet_to_release_its_rock) {
    SmallRun done("released"), waiting("unreleased");
    waiting.end_time = 1.0;  // the feed's
    waiting.finished = false;
    done.write();
    waiting.write();
    const Comparison comparison = compare_runs({done.directory, waiting.directory});
    EXPECT_FALSE(comparison.equal_time);
    EXPECT_FALSE(comparison.equal_revolutions);
}

TEST(Comparison, takes_no_run_for_a_repeat_of_itself) {
    const fs::path run = variant("itself", {}), other = variant("another", {}, 2.0), link = testing::fresh_directory("links") / "link";
    fs::create_directory_symlink(run, link);
    for (const fs::path& again : {run, run / "", link}) EXPECT_THROW(compare_runs({run, again, other}), UserError) << again;
    const auto release = [](const fs::path& directory, int seed) {
        std::string study = testing::read_text(directory / names::resolved_study);
        testing::write_text(directory / names::resolved_study, study + fmt::format("[[feed]]\nseed = {}\nstart_revolution = 1\n", seed));
    };
    const fs::path first = variant("release_1", {}), copy = variant("release_1_again", {}), repeat = variant("release_2", {});
    release(first, 1);
    release(copy, 1);
    release(repeat, 2);
    EXPECT_THROW(compare_runs({first, copy}), UserError);
    EXPECT_EQ(compare_runs({first, repeat}).settings.size(), 1u);
}

TEST(Comparison, knows_settings_by_values_and_files_by_content) {
    const auto edited = [](const fs::path& directory, const std::string& from, const std::string& to) {
        std::string study = testing::read_text(directory / names::resolved_study);
        study.replace(study.find(from), from.size(), to);
        testing::write_text(directory / names::resolved_study, study);
        return directory;
    };
    const auto with_file = [](const char* stage, const char* key, char digit) {
        const fs::path directory = variant(fmt::format("{}_{}", stage, digit), {});
        auto manifest = nlohmann::json::parse(testing::read_text(directory / names::manifest));
        manifest["stages"][stage]["inputs"][key] = std::string(64, digit);
        testing::write_text(directory / names::manifest, manifest.dump());
        return directory;
    };
    const fs::path plain = variant("value_plain", {}),
                   same = edited(variant("value_same", {}), "inclination_deg = 45", "inclination_deg = 45.0");
    EXPECT_EQ(compare_runs({plain, same}).settings.size(), 1u);
    const Comparison other = compare_runs({plain, edited(variant("value_other", {}), "gap_m = 0.03", "gap_m = 0.04")});
    const std::map<std::string, std::vector<std::string>> differing{{"suction.gap_m", {"0.03", "0.04"}}};
    EXPECT_EQ(differing_keys(other), differing);
    const auto settings_of = [&](const char* stage, const char* key) {
        return compare_runs({with_file(stage, key, 'a'), with_file(stage, key, 'b')}).settings.size();
    };
    EXPECT_EQ(settings_of("geometry", "cutter.file"), 2u);
    EXPECT_EQ(settings_of("case", "bank.file"), 2u);
    EXPECT_EQ(settings_of("case", "overrides/system/fvSchemes"), 2u);
    EXPECT_EQ(settings_of("case", "report.adv_points"), 1u) << "places of measurement change no result";
}

TEST(Comparison, refuses_a_finished_run_that_lost_a_part_of_its_tables) {
    for (const char* table : {"rock/0/fates.csv", "loads/0/loads.csv", "cost/0/cost.csv", "balance/0/balance.csv"}) {
        const fs::path whole = variant("whole", {}), broken = variant("broken", {}, 2.0);
        std::string text = testing::read_text(broken / "postProcessing" / table);
        text.resize(text.find('\n', text.size() / 2) + 1);
        testing::write_text(broken / "postProcessing" / table, text);
        EXPECT_THROW(compare_runs({whole, broken}), UserError) << table;
    }
}

fs::path measured_file(const std::string& name, const std::string& text) {
    const fs::path file = fs::path(::testing::TempDir()) / (name + ".csv");
    std::ofstream(file) << text;
    return file;
}

TEST(Measured, points_stand_beside_the_settings_of_their_speed) {
    Comparison comparison =
        compare_runs({variant("test_1", {}), variant("test_2", {4}), variant("test_3", {4, 5}), variant("other", {}, 2.0)});
    const double speed = comparison.runs[0].run.operating_point.speed_rpm;
    const auto tests = measured_file(
        "tests", fmt::format("# by hand\nspeed_rpm,spillage,spillage_error\n{},0.5,0.01\n{},0.4,0.1\n", 1.004 * speed, 1.01 * speed));
    add_measured(comparison, {tests});
    const auto differences = measured_differences(comparison);
    ASSERT_EQ(differences.size(), 2u) << "the second test is 1 % faster than both settings";
    EXPECT_EQ(differences[0].series, "tests");
    EXPECT_EQ(differences[0].key, "ratio");
    const Estimate& ratio = quantity_of(comparison, "ratio").settings[0];
    const Estimate& difference = differences[0].difference.estimate;
    EXPECT_NEAR(*difference.value, *ratio.value - 0.5, 1e-12);
    EXPECT_NEAR(*difference.low, 12.0 / 16.0 - 0.5, 1e-9);
    EXPECT_NEAR(*difference.high, 14.0 / 16.0 - 0.5, 1e-9);
    EXPECT_NEAR(*difference.half_width, std::hypot(*ratio.half_width, 0.01), 1e-12);
    EXPECT_EQ(differences[0].difference.verdict, ComparisonVerdict::differs);
    EXPECT_EQ(differences[1].difference.verdict, ComparisonVerdict::no_replicate) << "one run: its scatter is not known";
    EXPECT_EQ(comparison_json(comparison)["measured"].size(), 2u);
    EXPECT_THAT(comparison_text(comparison), HasSubstr("ratio of tests"));
    for (const Figure& figure : comparison_figures(comparison)) {
        if (figure.plot.name != "speed") continue;
        const Series& series = figure.plot.series.back();
        EXPECT_EQ(series.name, "spillage, tests");
        EXPECT_NEAR(series.x.at(1), 1.01 * speed, 1e-3);
        EXPECT_NEAR(series.y.at(1), 40.0, 1e-12);
        EXPECT_NEAR(series.y_high.at(1), 50.0, 1e-12);
        return;
    }
    FAIL() << "no figure against the speed";
}

TEST(Measured, points_of_another_discharge_are_not_compared) {
    Comparison comparison = compare_runs({variant("discharge_1", {}), variant("discharge_2", {}, 2.0)});
    const OperatingPoint& run = comparison.runs[0].run.operating_point;
    add_measured(comparison, {measured_file("points", fmt::format("speed_rpm,discharge_m3_s,production\n{0},{1},0.5\n{0},{2},0.5\n",
                                                                  run.speed_rpm, run.discharge, 1.2 * run.discharge))});
    const auto differences = measured_differences(comparison);
    ASSERT_FALSE(differences.empty());
    for (const MeasuredDifference& difference : differences) EXPECT_EQ(difference.key, "production");
    EXPECT_LE(differences.size(), 2u);
}

/// What the figure against the speed draws dashed.
std::vector<Series> dashed_lines(const Comparison& comparison) {
    std::vector<Series> dashed;
    for (const Figure& figure : comparison_figures(comparison))
        for (const Series& series : figure.plot.series)
            if (figure.plot.name == "speed" && series.dashed) dashed.push_back(series);
    return dashed;
}

// Of the runs 40 % are spilled at every speed; the tests fall through below 30 rpm.
TEST(Measured, points_and_not_the_runs_are_what_the_hypothesis_of_fall_through_is_fitted_to) {
    const std::vector<fs::path> runs{of_sweep("fall_a", 20.0, 0.0), of_sweep("fall_b", 40.0, 0.0), of_sweep("fall_c", 80.0, 0.0)};
    Comparison comparison = compare_runs(runs);
    EXPECT_TRUE(dashed_lines(comparison).empty()) << "a curve fitted to the runs beside it cannot disagree with them";
    const double outflow = *quantity_of(comparison, "well_mixed_spillage").settings[0].value,
                 discharge = comparison.runs[0].run.operating_point.discharge;
    const auto spillage = [&](double speed) { return 1.0 - (1.0 - outflow) * std::exp(-900.0 / (speed * speed)); };
    std::string text = "speed_rpm,discharge_m3_s,production\n";
    for (const double speed : {25.0, 50.0, 75.0}) text += fmt::format("{},{},{}\n", speed, discharge, 1.0 - spillage(speed));
    text += fmt::format("200,{},0.9\n50,{},0.01\n", discharge, 2.0 * discharge);  // beyond the runs' speeds; of another discharge
    add_measured(comparison, {measured_file("fall", text)});
    const std::vector<Series> dashed = dashed_lines(comparison);
    ASSERT_EQ(dashed.size(), 1u);
    EXPECT_THAT(dashed[0].name, HasSubstr("n₀ = 30 rpm from the measured points"));
    EXPECT_EQ(dashed[0].x.front(), 20.0);
    EXPECT_NEAR(dashed[0].y.front(), 100.0 * spillage(20.0), 0.01);
    EXPECT_NEAR(dashed[0].y.back(), 100.0 * spillage(80.0), 0.01);

    Comparison with_one = compare_runs(runs);
    add_measured(with_one, {measured_file("one", "speed_rpm,spillage\n50,0.5\n")});
    EXPECT_TRUE(dashed_lines(with_one).empty()) << "one parameter goes through any one point";
}

TEST(Measured, files_name_every_mistake) {
    const auto wrong = measured_file("wrong", "speed_rpm,spillage,production_error\n0,35,0.1\n60,0.3,-0.1\n");
    try {
        read_measured_points(wrong);
        FAIL();
    } catch (const UserError& error) {
        // An error without its share, speed 0, percent, a negative error.
        EXPECT_EQ(error.mistakes().size(), 4u) << error.what();
        EXPECT_THAT(error.what(), HasSubstr("Divide percent by 100"));
    }
    EXPECT_THROW(read_measured_points("no_such.csv"), UserError);
    EXPECT_THROW(read_measured_points(measured_file("empty", measured_template())), UserError) << "a template has no points";
    const auto filled = read_measured_points(measured_file("filled", measured_template() + "60,0.12,0.3,0.02,0.7,0.02\n"));
    EXPECT_EQ(filled.points.at(0).production->value, 0.7);
}

TEST(Comparison, draws_one_curve_along_the_discharges_of_one_speed) {
    std::vector<fs::path> runs;
    for (const char* discharge : {"0.08", "0.12", "0.16"}) {
        runs.push_back(variant(std::string("discharge_") + discharge, {}));
        std::string study = testing::read_text(runs.back() / names::resolved_study);
        const std::string key = "discharge_m3_s = ";
        study.replace(study.find(key), key.size() + 4, key + discharge);
        testing::write_text(runs.back() / names::resolved_study, study);
    }
    const Comparison comparison = compare_runs(runs);
    ASSERT_EQ(comparison.settings.size(), 3u);
    for (const Figure& figure : comparison_figures(comparison)) {
        if (figure.plot.name != "flow_number") continue;
        ASSERT_EQ(figure.plot.series.size(), 2u);  // spillage ratio and production
        for (const Series& series : figure.plot.series) {
            EXPECT_EQ(series.x.size(), 3u);
            EXPECT_TRUE(std::is_sorted(series.x.begin(), series.x.end()));
        }
        return;
    }
    FAIL() << "no plot against the flow number";
}

TEST(Comparison, gives_shares_by_bin_and_ratios_at_equal_points) {
    const Comparison comparison = compare_runs({variant("bins_a", {}), variant("bins_b", {4}, 2.0)});
    // Of 16 small rocks' mass: one through 0-30mm, eight through 60-90mm; rock 4 leaves by the gap in the second run alone.
    EXPECT_NEAR(*quantity_of(comparison, "spilled_0-30mm_share").settings[0].value, 1.0 / 16.0, 1e-9);
    EXPECT_NEAR(*quantity_of(comparison, "spilled_60-90mm_share").settings[0].value, 8.0 / 16.0, 1e-9);
    const Quantity& gap = quantity_of(comparison, "spilled_gap_share");
    EXPECT_NEAR(*gap.settings[1].value - *gap.settings[0].value, 1.0 / 16.0, 1e-9);
    EXPECT_NEAR(*quantity_of(comparison, "ratio_at_equal_revolutions").settings[0].value, 11.0 / 14.0, 1e-9);
    EXPECT_NEAR(*quantity_of(comparison, "sucked_up_at_equal_revolutions").settings[1].value, 2.0 / 16.0, 1e-9);
    EXPECT_NEAR(*quantity_of(comparison, "undecided_at_equal_time").settings[0].value, 2.0 / 16.0, 1e-9);
}

TEST(Comparison, says_when_the_batches_differ) {
    const fs::path same = variant("batch_a", {}), other = variant("batch_b", {}, 2.0);
    EXPECT_TRUE(differing_batches(compare_runs({same, other})).empty());
    auto feed = nlohmann::json::parse(testing::read_text(other / "feed.json"));
    feed["feeds"][0]["classes"][0]["diameter_m"] = 0.03;
    testing::write_text(other / "feed.json", feed.dump());
    const std::vector<std::string> batches = differing_batches(compare_runs({same, other}));
    ASSERT_EQ(batches.size(), 2u);
    EXPECT_THAT(batches[0], HasSubstr("20 mm"));
    EXPECT_THAT(batches[1], HasSubstr("30 mm"));
    const fs::path folder = testing::fresh_directory("batch_page") / "page";
    const std::string page = testing::read_text(write_comparison(compare_runs({same, other}), folder));
    EXPECT_LT(page.find("Different batches of rock"), page.find("<table"));
}

TEST(Comparison, names_every_directory_that_holds_no_run) {
    EXPECT_THROW(compare_runs({variant("alone", {})}), UserError);
    try {
        compare_runs({"/nowhere/a", variant("there", {}), "/nowhere/b"});
        FAIL() << "accepted";
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().size(), 2u);
    }
}

TEST(ComparisonPage, holds_every_setting_and_escapes_names) {
    SmallRun first("page_first"), second("page_second");
    first.study_name = "deep <b>head</b>";
    second.length_ratio = 2.0;
    first.write();
    second.write();
    const fs::path folder = testing::fresh_directory("comparison_page") / "page";
    std::string page = testing::read_text(write_comparison(compare_runs({first.directory, second.directory}), folder));
    page.resize(page.find("<script>"));  // what follows is not ours
    EXPECT_THAT(page, HasSubstr("deep &lt;b&gt;head&lt;/b&gt;"));
    EXPECT_THAT(page, HasSubstr("No replicate"));
    EXPECT_EQ(page.find("http:"), page.find("http://www.w3.org"));
    EXPECT_EQ(page.find("https:"), std::string::npos);
    const auto document = nlohmann::json::parse(testing::read_text(folder / "comparison.json"));
    EXPECT_EQ(document.at("schema"), k_comparison_schema);
    EXPECT_EQ(document.at("settings").size(), 2u);
    const Comparison comparison = compare_runs({first.directory, second.directory});
    EXPECT_NO_THROW(require_own_comparison(comparison, folder));
    EXPECT_THROW(require_own_comparison(compare_runs({first.directory, variant("page_third", {})}), folder), UserError);
    const fs::path taken = testing::fresh_directory("comparison_taken");
    EXPECT_NO_THROW(require_own_comparison(comparison, taken));
    testing::write_text(taken / "thesis.tex", "mine");
    EXPECT_THROW(require_own_comparison(comparison, taken), UserError);
    for (const char* mine : {"{}", "{\"schema\": 1, \"settings\": 2}", "[]", "mine"}) {
        testing::write_text(taken / "comparison.json", mine);
        EXPECT_THROW(require_own_comparison(comparison, taken), UserError) << mine;
    }
}

}  // namespace
}  // namespace cutterflow::postproc
