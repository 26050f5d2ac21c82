// A fed head whose rates are known by hand: 10 kg/s of 2000 kg/m3 of soil, 60 % delivered.
#include "postproc/analysis/dredging.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "postproc/analysis/best_speed.hpp"
#include "postproc/pages/comparison_page.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using testing::read_text;
using testing::SmallRun;
using testing::write_text;

constexpr double k_swing = 0.1, k_step = 0.16, k_bulking = 1.4;  // [m/s], [m]

/// Adds keys at the end of the section that they belong to.
void add_to_study(const fs::path& directory, const std::string& section, const std::string& keys) {
    std::string study = read_text(directory / "study.resolved.toml");
    const std::string title = "[" + section + "]\n";
    const std::size_t at = study.find(title);
    ASSERT_NE(at, std::string::npos) << title;
    study.insert(at + title.size(), keys);
    write_text(directory / "study.resolved.toml", study);
}

/// In the window of the production one rock leaves through the gap, where radial velocities go inwards, and one of eight times its mass
/// through 120-150mm, where they go outwards; one comes back and one is sucked up. In the small run's own story 11 masses left before.
void let_rock_leave(const fs::path& directory) {
    testing::add_events(directory, {{10.0, 101, "head", "out", "gap", 1.6},
                                    {11.0, 102, "head", "out", "120-150mm", 4.7, 0.04},
                                    {12.0, 103, "head", "out", "gap", 1.6},
                                    {13.0, 103, "head", "in", "gap", 1.6},
                                    {14.0, 104, "head", "out", "gap", 1.6},
                                    {15.0, 104, "mouth", "in", ""}});
}

fs::path at_work(const std::string& name, double rpm = 60.0, double stuck = 0.0) {
    SmallRun run(name);
    run.speed_rpm = rpm;
    run.write();
    testing::make_fed(run, 5.0, stuck);
    let_rock_leave(run.directory);
    add_to_study(run.directory, "swing", fmt::format("speed_m_min = {}\n", 60.0 * k_swing));
    add_to_study(run.directory, "bank", fmt::format("step_m = {}\ncut_height_m = 0.32\n", k_step));
    add_to_study(run.directory, "soil", fmt::format("bulking = {}\nspecific_energy_mj_m3 = 0.5\n", k_bulking));
    return run.directory;
}

TEST(Dredging, has_the_rates_of_the_swing) {
    const RunData run = read_run(at_work("dredging"));
    const Results results = compute_results(run);
    ASSERT_TRUE(results.dredging);
    const Dredging& work = *results.dredging;
    EXPECT_NEAR(*work.cut_in_situ, 10.0 / 2000.0, 1e-6);
    EXPECT_NEAR(*work.delivered_in_situ, 6.0 / 2000.0, 5e-5);
    EXPECT_NEAR(results.fed->losses.mixing, 0.4, 0.01);
    EXPECT_EQ(results.fed->losses.cutting, 0.0);
    EXPECT_EQ(results.fed->losses.left_behind, 0.0);
    // Of 0.12 m3/s of mixture.
    double mass = 0.0, volume = 0.0;
    for (const RockClass& rock : run.feed->classes) {
        const double one = k_pi / 6.0 * std::pow(rock.diameter, 3);
        volume += rock.count * one;
        mass += rock.count * one * rock.density;
    }
    EXPECT_NEAR(*work.concentration, 6.0 * volume / mass / 0.12, 1e-3);
    EXPECT_NEAR(*work.mixture_density, run.operating_point.fluid_density * (1.0 - *work.concentration) + 6.0 / 0.12, 1.0);
    // 4 kg/s are 2 l/s of soil, 2.8 l/s loose; the swing passes 0.016 m2/s of bed.
    EXPECT_NEAR(*work.spill_layer, 0.002 * k_bulking / (k_swing * k_step), 0.005);
    EXPECT_NEAR(*work.cutting_power, 0.5e6 * 0.005, 1.0);
    EXPECT_NEAR(*work.cutting_energy, 0.5e6 / 0.6, 1e4);
    EXPECT_NEAR(*work.energy, results.rotor.power->mean / *work.delivered_in_situ, 1e-6);
    ASSERT_TRUE(work.ways_out);
    EXPECT_NEAR(work.ways_out->against_inflow, 1.0 / 9.0, 1e-6);
    EXPECT_NEAR(work.ways_out->with_outflow, 8.0 / 9.0, 1e-6);
    EXPECT_NEAR(*work.ways_out->by_cutting, 0.0, 1e-12);
    EXPECT_NE(limits_text(results).find("88.9 % went through bins along the axis where the water flows outwards in the mean "
                                        "around the head (outflow), 11.1 % through bins where it flows inwards in that mean"),
              std::string::npos)
        << limits_text(results);
    Results full = results;
    full.fed->is_full = true;
    full.fed->owed_share = 0.02;
    EXPECT_NE(limits_text(full).find("though little: in the mean 2.0 % of what"), std::string::npos) << limits_text(full);
    full.fed->owed_share = 0.2;
    EXPECT_NE(limits_text(full).find("it cannot take what it cuts; of the rock that left"), std::string::npos) << limits_text(full);
}

// Radial velocities say otherwise: water that crosses a tapering contour along the axis is in the fluxes alone.
TEST(Dredging, takes_the_ways_out_by_fluxes_where_there_are_some) {
    const fs::path directory = at_work("dredging_flux");
    const std::vector<geometry::AxialBin> bins = read_run(directory).bins;
    std::string text = "time_s";
    for (const geometry::AxialBin& bin : bins) text += "," + bin.name;
    for (int step = 1; step <= 200; ++step) {
        text += fmt::format("\n{:.9g}", 0.01 * step);
        for (const geometry::AxialBin& bin : bins) text += bin.name == "gap" ? ",0.02" : ",-0.01";
    }
    write_text(directory / "postProcessing/outflow/0/contour_flux.csv", text + "\n");
    const Results results = compute_results(read_run(directory));
    ASSERT_TRUE(results.dredging->ways_out);
    EXPECT_NEAR(results.dredging->ways_out->with_outflow, 1.0 / 9.0, 1e-6);
}

TEST(Dredging, tells_that_nothing_was_spilled_in_the_window) {
    RunData run = read_run(at_work("dredging_none_left"));
    std::vector<bool> before(run.rock->events.rows());
    for (std::size_t row = 0; row < before.size(); ++row) before[row] = run.rock->events.number("time_s")[row] < 3.0;
    run.rock->events.keep_rows(before);
    EXPECT_EQ(limits_text(compute_results(run)), "What limits: nothing was spilled.");
}

/// Writes what is spilled as 10 % within reach after mixing, 20 % within reach never taken in, 70 % left behind, of which `never_in`.
/// \param never_in  none: as an earlier program, without the column
void leave_behind(const fs::path& directory, std::optional<double> never_in) {
    const fs::path file = directory / "postProcessing/rock/0/ledger.csv";
    const Table ledger = read_ledger(directory);
    const auto at = [&](const char* column, std::size_t row) { return ledger.number(column)[row]; };
    std::string text =
        fmt::format("time_s,fed_kg,owed_kg,in_head_kg,delivered_kg,spilled_mixing_kg,spilled_cutting_kg,on_bed_kg,left_behind_kg{},error\n",
                    never_in ? ",left_behind_cutting_kg" : "");
    for (std::size_t row = 0; row < ledger.rows(); ++row) {
        const double spilled = at("spilled_mixing_kg", row);
        text += fmt::format("{:.9g},{:.12g},0,{:.12g},{:.12g},{:.12g},{:.12g},0,{:.12g}{},0\n", at("time_s", row), at("fed_kg", row),
                            at("in_head_kg", row), at("delivered_kg", row), 0.1 * spilled, 0.2 * spilled, 0.7 * spilled,
                            never_in ? fmt::format(",{:.12g}", *never_in * 0.7 * spilled) : "");
    }
    write_text(file, text);
}

TEST(Dredging, knows_the_cause_of_what_was_left_behind) {
    const fs::path directory = at_work("dredging_cause");
    leave_behind(directory, 0.5);
    const RunData run = read_run(directory);
    const Results results = compute_results(run);
    EXPECT_NEAR(results.fed->losses.left_behind, 0.7 * 0.4, 0.01);
    EXPECT_NEAR(*results.fed->losses.left_behind_cutting, 0.35 * 0.4, 0.005);
    EXPECT_NEAR(*results.dredging->ways_out->by_cutting, 0.2 + 0.35, 1e-9);
    EXPECT_NEAR(results.dredging->ways_out->cause_known, 1.0, 1e-12);
    EXPECT_NE(limits_text(results).find("; 55.0 % of what was spilled had never been taken in (lost in cutting)"), std::string::npos)
        << limits_text(results);
    EXPECT_NEAR(results_json(results, run).at("dredging").at("left_behind_cutting_share").get<double>(), 0.14, 0.005);
}

TEST(Dredging, says_of_what_part_an_earlier_programs_ledger_knows_the_cause) {
    const fs::path directory = at_work("dredging_no_cause");
    leave_behind(directory, {});
    const RunData run = read_run(directory);
    const Results results = compute_results(run);
    EXPECT_FALSE(results.fed->losses.left_behind_cutting);
    EXPECT_NEAR(*results.dredging->ways_out->by_cutting, 0.2 / 0.3, 1e-9);
    EXPECT_NEAR(results.dredging->ways_out->cause_known, 0.3, 1e-9);
    EXPECT_NE(limits_text(results).find("; 66.7 % of the part of what was spilled whose cause is known, 30.0 % of it"), std::string::npos)
        << limits_text(results);
    EXPECT_TRUE(results_json(results, run).at("dredging").at("left_behind_cutting_share").is_null());
}

// Six blades of 0.1 to 0.05 m depth below a ring that closes the circumference; rock settles at 1.036 m/s, the ladder is at 45 degrees.
TEST(ScaleNumbers, of_a_head_at_work_follow_their_definitions) {
    const fs::path directory = at_work("numbers");
    write_text(directory / "study.resolved.toml", read_text(directory / "study.resolved.toml") +
                                                      "\n[rock]\nfriction_rock = 0.5\nfriction_steel = 0.35\nfriction_soil = 0.6\n");
    nlohmann::json geometry = nlohmann::json::parse(read_text(directory / "geometry/geometry.json"));
    const auto slice = [](double angle, double coverage, double depth) {
        return nlohmann::json{{"z_m", 0.0}, {"angle_deg", angle}, {"coverage", coverage}, {"depth_m", depth}};
    };
    geometry["head"]["blade_slices"] = {slice(8.0, 0.3, 0.05), slice(36.0, 0.2, 0.1), slice(30.0, 0.2, 0.075), slice(80.0, 1.0, 0.3)};
    write_text(directory / "geometry/geometry.json", geometry.dump());
    const RunData run = read_run(directory);
    const Results results = compute_results(run);
    const nlohmann::json scale = results_json(results, run).at("scale");
    const auto number = [&](const char* key) { return scale.at(key).get<double>(); };
    EXPECT_NEAR(number("settling_number"), 1.036 / (0.12 / (k_pi * 0.16)), 1e-9);
    EXPECT_NEAR(number("fall_through"), 1.036 * std::sqrt(0.5) / 6.0 / 0.075, 1e-9);
    EXPECT_NEAR(number("swing_over_rotor_speed"), k_swing / (2.0 * k_pi * 0.4), 1e-9);
    EXPECT_NEAR(number("bite_over_blade_depth"), k_swing / 6.0 / 0.075, 1e-9);
    EXPECT_NEAR(number("cut_over_discharge"), 0.005 / 0.12, 1e-6);
    EXPECT_NEAR(number("blade_angle_less_ladder_deg"), 30.0 - 45.0, 1e-9);
    EXPECT_EQ(number("friction_rock"), 0.5);
    EXPECT_EQ(number("friction_steel"), 0.35);
    EXPECT_EQ(number("friction_soil"), 0.6);
    const Comparison comparison = compare_runs({directory, at_work("numbers_of_an_earlier_program", 30.0)});
    const Quantity& fall_through = *find_quantity(comparison, "fall_through");
    EXPECT_NEAR(*fall_through.settings[0].value, number("fall_through"), 1e-12);
    EXPECT_FALSE(fall_through.settings[1].value) << "its geometry.json tells nothing of the blades";
    EXPECT_NEAR(*find_quantity(comparison, "settling_number")->settings[1].value, number("settling_number"), 1e-9);
    EXPECT_NEAR(*find_quantity(comparison, "swing_over_rotor_speed")->settings[1].value, 2.0 * number("swing_over_rotor_speed"), 1e-9);
}

/// Gives its feed fines, the layers that a swing may leave and the friction of rock on soil; one rock of 40 mm comes to the mouth.
void know_all(const fs::path& directory) {
    const std::string feed = "kind = \"cut_face\"\n";
    std::string study = read_text(directory / "study.resolved.toml");
    study.insert(study.find(feed), "disintegration = 0.8\n");
    write_text(directory / "study.resolved.toml", study + "\n[rock]\nfriction_soil = 0.6\n");
    nlohmann::json report = nlohmann::json::parse(read_text(directory / "feed.json"));
    for (const double thickness : {0.2, 0.4, 0.6})
        report["feeds"][0]["layers"].push_back({{"thickness_m", thickness}, {"section_m2", thickness * k_step}});
    write_text(directory / "feed.json", report.dump());
    testing::add_events(directory, {{9.0, 105, "feed", "in", "", 0.0, 0.04}, {11.0, 105, "mouth", "in", "", 0.0, 0.04}});
}

TEST(Dredging, of_several_heads_stands_beside_each_other_with_all_that_a_report_has) {
    const fs::path known = at_work("compared_known"), earlier = at_work("compared_earlier", 30.0);
    know_all(known);
    const Comparison comparison = compare_runs({known, earlier});
    const Results& results = comparison.runs[0].results;
    const Dredging& work = *results.dredging;
    const auto value = [&](const char* key, std::size_t setting) { return quantity_of(comparison, key, setting).value; };
    ASSERT_TRUE(work.next_layer && work.spillage_with_fines && work.largest_delivered && work.cutting_power);
    EXPECT_EQ(*value("next_layer_m", 0), *work.next_layer);
    EXPECT_FALSE(value("next_layer_m", 1)) << "its feed.json tells no layers";
    EXPECT_EQ(*value("spillage_with_fines", 0), *work.spillage_with_fines);
    EXPECT_EQ(*value("largest_delivered_m", 0), 0.04);
    EXPECT_FALSE(value("largest_delivered_m", 1)) << "nothing came to its mouth in the window";
    EXPECT_EQ(*value("cutting_power_w", 0), *work.cutting_power);
    EXPECT_NEAR(*value("froude", 0), std::pow(2.0 * k_pi, 2) * 0.4 / 9.81, 1e-9);
    EXPECT_NEAR(*value("settling_ratio", 1), 1.036 / (k_pi * 0.4), 1e-9);
    EXPECT_NEAR(*value("size_ratio", 0), 0.02 / 0.4, 1e-12);
    EXPECT_EQ(*value("friction_soil", 0), 0.6);
    EXPECT_FALSE(value("friction_soil", 1)) << "earlier programs did not write it";
    const std::string page = read_text(write_comparison(comparison, testing::fresh_directory("compared_page") / "page"));
    for (const char* column : {"next swing’s layer, m", "largest rock, mm", "power cutting, kW", "spillage with fines, %", "ω²R/g",
                               "u<sub>t</sub>/(ωR)", "d/R", "μ rock on soil"})
        EXPECT_NE(page.find(fmt::format("<th scope=\"col\">{}</th>", column)), std::string::npos) << column;
}

TEST(Dredging, tells_no_layer_and_no_total_while_the_head_fills) {
    const RunData run = read_run(at_work("dredging_filling", 60.0, 0.2));
    const Results results = compute_results(run);
    ASSERT_TRUE(results.dredging);
    EXPECT_FALSE(results.dredging->spill_layer);
    EXPECT_FALSE(results.dredging->spillage_with_fines);
    EXPECT_TRUE(results.dredging->delivered_in_situ);
}

TEST(Dredging, counts_fines_as_neutral_rock_and_the_layer_as_not_cut) {
    const RunData plain = read_run(at_work("dredging_plain"));
    RunData run = plain;
    run.operating_point.rock_share = 0.8;
    run.feed->left_share = 0.25;
    const Results results = compute_results(run);
    const Dredging& work = *results.dredging;
    // 7.5 of 10 kg/s are cut rock, 80 % of what is cut.
    EXPECT_NEAR(*work.cut_in_situ, 7.5 / 0.8 / 2000.0, 1e-6);
    ASSERT_TRUE(results.mixing && work.spillage_with_fines);
    const double fines = 7.5 / 0.8 * 0.2, spilled = results.fed->production.undelivered * 10.0;
    EXPECT_NEAR(*work.spillage_with_fines, (spilled + results.mixing->well_mixed_spillage * fines) / (10.0 + fines), 1e-6);
    EXPECT_EQ(work.layer_share, 0.25);
    // What is fed is cut or lay there; it is delivered or spilled, fines as rock.
    EXPECT_NEAR(*work.fed_in_situ, (10.0 + fines) / 2000.0, 1e-6);
    EXPECT_NEAR(*work.delivered_in_situ, (1.0 - *work.spillage_with_fines) * *work.fed_in_situ, 1e-6);
    EXPECT_NEAR(results_json(results, run).at("production").at("delivered_in_situ_m3_h").get<double>(), 3600.0 * *work.delivered_in_situ,
                1e-3);
    // The mouth takes the same soil: its mass displaces water.
    const Production& window = results.fed->production;
    const double taken = *work.delivered_in_situ * run.operating_point.in_situ_density / run.operating_point.discharge;
    EXPECT_NEAR(*work.mixture_density, run.operating_point.fluid_density * (1.0 - *work.concentration) + taken, 1e-6);
    const Dredging rock_alone = *compute_results(plain).dredging;
    EXPECT_NEAR(*work.concentration - *rock_alone.concentration,
                *work.delivered_fines / (window.to - window.from) / run.operating_point.grain_density / run.operating_point.discharge,
                1e-9);
    EXPECT_GT(*work.delivered_fines, 0.0);
}

TEST(Dredging, lays_what_is_spilled_on_all_that_the_head_passed) {
    RunData run = read_run(at_work("dredging_layer"));
    EXPECT_FALSE(compute_results(run).dredging->next_layer) << "a feed of an earlier program";
    // Of a layer on a floor twice as wide as the step the next swing takes the half.
    for (const double thickness : {0.1, 0.2, 0.3}) {
        run.feed->layer_thickness.push_back(thickness);
        run.feed->layer_section.push_back(thickness * k_step);
    }
    const Dredging work = *compute_results(run).dredging;
    ASSERT_TRUE(work.next_layer);
    EXPECT_NEAR(*work.next_layer, 0.5 * *work.spill_layer, 1e-12);
    for (double& section : run.feed->layer_section) section = 0.0;
    run.feed->layer_thickness = {0.01, 0.02, 0.03};
    EXPECT_FALSE(compute_results(run).dredging->next_layer) << "no layer of the bank's height holds it";
}

TEST(Dredging, follows_delivered_rock_from_cut_to_mouth) {
    const fs::path directory = at_work("dredging_time");
    RunData run = read_run(directory);
    const Results results = compute_results(run);
    EXPECT_FALSE(results.dredging->residence_time) << "no rock came to the mouth in the window";
    const std::string header =
        "time_s,id,surface,direction,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,rotor_angle_rad,azimuth_rad,axial_m,diameter_m,density_kg_m3,bin\n";
    const auto row = [](double time, int id, const char* surface, double diameter) {
        return fmt::format("{},{},{},in,0,0,0,0,0,0,0,0,0,{},2650,\n", time, id, surface, diameter);
    };
    // 20 mm after 2 s, 40 mm (8 times the mass) after 3 s; one that came before the window does not count.
    write_text(directory / "events.csv", header + row(1, 1, "feed", 0.02) + row(2, 1, "mouth", 0.02) + row(10, 2, "feed", 0.02) +
                                             row(10, 3, "feed", 0.04) + row(12, 2, "mouth", 0.02) + row(13, 3, "mouth", 0.04));
    run.rock->events =
        read_table(directory / "events.csv", {{"time_s", "id", "diameter_m", "density_kg_m3"}, {"surface", "direction", "bin"}, {}, ""});
    const Dredging work = dredging_of(results, run);
    EXPECT_NEAR(*work.residence_time, (2.0 + 8.0 * 3.0) / 9.0, 1e-9);
    EXPECT_EQ(*work.largest_delivered, 0.04);
}

/// Of what is held up, `owed` kg wait for a place at any time.
void let_rock_wait(const fs::path& directory, double owed) {
    const Table ledger = read_ledger(directory);
    const auto at = [&](const char* column, std::size_t row) { return ledger.number(column)[row]; };
    std::string text =
        "time_s,fed_kg,owed_kg,in_head_kg,delivered_kg,spilled_mixing_kg,spilled_cutting_kg,on_bed_kg,left_behind_kg,"
        "left_behind_cutting_kg,error\n";
    for (std::size_t row = 0; row < ledger.rows(); ++row) {
        const double held = at("in_head_kg", row), waiting = std::min(owed, held);
        text += fmt::format("{:.9g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},0,0,0,0,0\n", at("time_s", row), at("fed_kg", row), waiting,
                            held - waiting, at("delivered_kg", row), at("spilled_mixing_kg", row));
    }
    write_text(directory / "postProcessing/rock/0/ledger.csv", text);
}

// Of 10 kg/s always 2 kg wait: 0.2 s before a rock has the place from which it takes 2 s to the mouth.
TEST(Dredging, counts_the_wait_for_a_place_to_the_time_from_cut_to_mouth) {
    const fs::path directory = at_work("dredging_wait", 30.0);
    let_rock_wait(directory, 2.0);
    testing::add_events(directory, {{10.0, 105, "feed", "in", ""}, {12.0, 105, "mouth", "in", ""}});
    const RunData run = read_run(directory);
    const Results results = compute_results(run);
    EXPECT_NEAR(results.dredging->waiting_time, 0.2, 1e-6);
    ASSERT_TRUE(results.dredging->residence_time);
    EXPECT_NEAR(*results.dredging->residence_time, 2.2, 1e-6);
    const nlohmann::json written = results_json(results, run).at("dredging");
    EXPECT_NEAR(written.at("residence_time_s").get<double>() - written.at("waiting_time_s").get<double>(), 2.0, 1e-6);
    const Comparison comparison = compare_runs({directory, at_work("dredging_no_wait")});
    EXPECT_NEAR(*quantity_of(comparison, "waiting_time_s", 0).value, 0.2, 1e-6);
    EXPECT_EQ(*quantity_of(comparison, "waiting_time_s", 1).value, 0.0);
}

// Ring radius 0.4 m, 60 rpm, 0.12 m3/s through a mouth of 0.1 m radius; 40 % are spilled.
TEST(UsualPractice, is_that_of_the_prototype_and_leaves_out_what_is_not_steady) {
    const auto outside = [](const fs::path& directory) {
        const RunData run = read_run(directory);
        const Results results = compute_results(run);
        EXPECT_EQ(results_json(results, run).at("outside_usual_practice"), results.outside_usual_practice);
        return fmt::format("{}", fmt::join(results.outside_usual_practice, ", "));
    };
    const std::string as_is = outside(at_work("practice_1", 60.0));
    EXPECT_NE(as_is.find("ring diameter 0.8 m (1.5 to 3.5), rotor speed 60 rpm (20 to 40)"), std::string::npos) << as_is;
    EXPECT_EQ(as_is.find("spillage"), std::string::npos) << "40 % are usual";
    EXPECT_NE(outside(at_work("practice_2", 60.0, 0.049)).find("mixture density"), std::string::npos);
    EXPECT_EQ(outside(at_work("practice_3", 60.0, 0.2)).find("mixture density"), std::string::npos) << "the head still fills";
    testing::SmallRun batch("practice_batch");
    batch.write();
    EXPECT_EQ(outside(batch.directory), "") << "no head at work";
}

/// Three speeds; production is 0.6 times what does not stay in the head. \param stuck  shares that stay at each speed
std::string sentence_for(const std::string& name, const std::vector<double>& stuck) {
    std::vector<fs::path> runs;
    const double speeds[] = {30.0, 60.0, 90.0};
    for (std::size_t i = 0; i < stuck.size(); ++i) runs.push_back(at_work(fmt::format("{}_{}", name, i), speeds[i], stuck[i]));
    const std::vector<std::string> sentences = best_speed_text(compare_runs(runs));
    EXPECT_EQ(sentences.size(), 1u);
    return sentences.empty() ? "" : sentences.front();
}

TEST(BestSpeed, is_named_only_where_its_interval_is_apart_from_its_neighbours) {
    EXPECT_EQ(sentence_for("best_middle", {0.045, 0.0, 0.045}),
              "Of these speeds 60 rpm delivers most of what is fed: its interval is apart from "
              "its neighbours'.");
    EXPECT_EQ(sentence_for("best_end", {0.0, 0.02, 0.045}),
              "No optimum found within the error: production is highest at the end of the range, 30 rpm.");
    EXPECT_EQ(sentence_for("best_within", {0.01, 0.0, 0.01}),
              "No optimum found within the error: production is highest at 60 rpm, but its interval is not apart from its neighbours'.");
}

TEST(BestSpeed, is_not_named_while_a_head_fills) {
    EXPECT_EQ(sentence_for("best_filling", {0.2, 0.0, 0.045}),
              "No optimum found within the error: production is not steady, or has no interval, at every speed.");
}

TEST(BestSpeed, is_not_asked_of_two_speeds) {
    EXPECT_TRUE(best_speed_text(compare_runs({at_work("best_two_a", 30.0), at_work("best_two_b", 60.0)})).empty());
}

}  // namespace
}  // namespace cutterflow::postproc
