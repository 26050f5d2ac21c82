#include "postproc/analysis/results.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <tuple>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "postproc/pages/report.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

using nlohmann::json;
using testing::small_rock_mass;
using testing::SmallRun;
namespace fs = std::filesystem;

json document_of(const SmallRun& run) {
    const RunData data = read_run(run.directory);
    return results_json(compute_results(data), data);
}

json document_of_small_run(const std::string& name) {
    SmallRun run(name);
    run.write();
    return document_of(run);
}

/// The contract's keys below `object`, each with the predicate its value must fulfil.
void expect_keys(const json& object, const std::vector<std::string>& keys, const std::string& where) {
    for (const std::string& key : keys) EXPECT_TRUE(object.contains(key)) << where << "." << key;
}

TEST(ResultsJson, has_every_key_of_the_contract) {
    const json results = document_of_small_run("contract");
    EXPECT_EQ(results.at("schema"), "cutterflow.results/1");
    expect_keys(results,
                {"warnings", "rock", "spillage", "conservation", "rotor", "operation", "scale", "cost", "models", "not_modelled", "mesh",
                 "versions"},
                "");
    expect_keys(results.at("rock"), {"requested", "placed", "rejected", "fates"}, "rock");
    for (const char* fate : {"sucked_up", "spilled", "in_cutter", "never_entered"}) {
        EXPECT_TRUE(results.at("rock").at("fates").at(fate).at("count").is_number_integer());
        EXPECT_TRUE(results.at("rock").at("fates").at(fate).at("mass_kg").is_number());
    }
    expect_keys(results.at("spillage"), {"ratio", "ratio_min", "ratio_max", "undecided", "replicates", "bins"}, "spillage");
    for (const json& bin : results.at("spillage").at("bins")) {
        expect_keys(bin, {"name", "z_min_m", "z_max_m", "count", "mass_kg", "radial_velocity_mean_m_s"}, "bin");
    }
    for (const char* key : {"solid_volume_max_error", "momentum_max_error", "momentum_interface_max_error", "momentum_carried_max",
                            "momentum_carried_median", "flow_balance_max_error", "interface_imbalance_max", "interface_mismatch_max"}) {
        EXPECT_TRUE(results.at("conservation").at(key).is_number()) << key;
    }
    for (const char* key : {"speed_rpm", "revolutions", "torque_flow_mean_n_m", "torque_rock_mean_n_m", "power_mean_w"}) {
        EXPECT_TRUE(results.at("rotor").at(key).is_number()) << key;
    }
    for (const char* key : {"pipe_velocity_m_s", "delivered_concentration", "mixture_density_kg_m3"}) {
        EXPECT_TRUE(results.at("operation").at(key).is_number()) << key;
    }
    for (const char* key : {"flow_number", "froude", "settling_ratio", "size_ratio"})
        EXPECT_TRUE(results.at("scale").at(key).is_number()) << key;
    for (const char* key : {"wall_s", "core_s", "steps", "cells", "ranks", "core_s_per_revolution"}) {
        EXPECT_TRUE(results.at("cost").at(key).is_number()) << key;
    }
    for (const char* key : {"fluid", "mesh_motion", "mapping", "dem", "output"}) {
        EXPECT_TRUE(results.at("cost").at("share").at(key).is_number()) << key;
    }
    ASSERT_FALSE(results.at("models").empty());
    for (const json& model : results.at("models")) expect_keys(model, {"name", "why"}, "model");
    EXPECT_FALSE(results.at("not_modelled").empty());
    EXPECT_EQ(results.at("mesh").at("cells"), 61240);
    EXPECT_EQ(results.at("versions").at("OpenFOAM"), "1912");
    EXPECT_EQ(results.at("versions").at("cutterflow"), "0.1.0");
}

TEST(ResultsJson, counts_add_up_to_placed_and_bins_to_spilled) {
    const json results = document_of_small_run("adding_up");
    int count = 0;
    double mass = 0.0;
    for (const json& fate : results.at("rock").at("fates")) count += fate.at("count").get<int>();
    EXPECT_EQ(count, results.at("rock").at("placed"));
    EXPECT_EQ(results.at("rock").at("requested"), 11);
    EXPECT_EQ(results.at("rock").at("rejected"), 2);
    count = 0;
    for (const json& bin : results.at("spillage").at("bins")) {
        count += bin.at("count").get<int>();
        mass += bin.at("mass_kg").get<double>();
    }
    const json& spilled = results.at("rock").at("fates").at("spilled");
    EXPECT_EQ(count, spilled.at("count"));
    EXPECT_NEAR(mass, spilled.at("mass_kg").get<double>(), 1e-6 * mass);
    EXPECT_NEAR(mass, 11.0 * small_rock_mass(), 1e-6 * mass);
}

TEST(ResultsJson, bins_carry_names_limits_and_outflow) {
    const json results = document_of_small_run("bins");
    const json& bins = results.at("spillage").at("bins");
    ASSERT_EQ(bins.size(), 17u);
    EXPECT_EQ(bins[0].at("name"), "gap");
    EXPECT_EQ(bins[0].at("z_min_m"), 0.0);
    EXPECT_EQ(bins[0].at("z_max_m"), 0.03);
    EXPECT_EQ(bins[3].at("name"), "60-90mm");
    EXPECT_NEAR(bins[3].at("z_min_m").get<double>(), -0.09, 1e-12);
    EXPECT_EQ(bins[16].at("name"), "below_hub");
    EXPECT_TRUE(bins[16].at("z_min_m").is_null());
    for (std::size_t k = 0; k < bins.size(); ++k) {
        EXPECT_NEAR(bins[k].at("radial_velocity_mean_m_s").get<double>(), 0.1 * static_cast<double>(k) - 0.3, 1e-9) << k;
    }
    EXPECT_EQ(results.at("outflow").at("window_start_s"), 1.0);
    EXPECT_EQ(results.at("spillage").at("replicates"), "no replicate");
}

TEST(ResultsJson, loads_are_means_over_whole_revolutions_with_rock) {
    SmallRun run("loads");
    run.end_time = 2.6;  // the last 0.6 revolutions do not count
    run.write();
    const json rotor = document_of(run).at("rotor");
    EXPECT_EQ(rotor.at("averaged_revolutions"), 1);
    EXPECT_NEAR(rotor.at("revolutions").get<double>(), 2.6, 1e-9);
    EXPECT_NEAR(rotor.at("torque_flow_mean_n_m").get<double>(), -11.0, 1e-9);
    EXPECT_NEAR(rotor.at("torque_rock_mean_n_m").get<double>(), -2.0, 1e-9);
    EXPECT_NEAR(rotor.at("power_mean_w").get<double>(), 13.0 * 2.0 * k_pi, 1e-6);
}

TEST(ResultsJson, operation_and_scale_follow_their_formulas) {
    const json results = document_of_small_run("operation");
    const double omega = 2.0 * k_pi, volume = small_rock_mass() / 2650.0;
    const double concentration = 3.0 * volume / (0.12 * 1.0);
    EXPECT_NEAR(results.at("operation").at("pipe_velocity_m_s").get<double>(), 0.12 / (k_pi * 0.01), 1e-12);
    EXPECT_NEAR(results.at("operation").at("delivered_concentration").get<double>(), concentration, 1e-9 * concentration);
    EXPECT_NEAR(results.at("operation").at("mixture_density_kg_m3").get<double>(), 998.2 + concentration * (2650.0 - 998.2), 1e-6);
    EXPECT_NEAR(results.at("scale").at("flow_number").get<double>(), 0.12 / (omega * 0.064), 1e-12);
    EXPECT_NEAR(results.at("scale").at("froude").get<double>(), omega * omega * 0.4 / 9.81, 1e-12);
    EXPECT_NEAR(results.at("scale").at("settling_ratio").get<double>(), 1.036 / (omega * 0.4), 1e-12);
    EXPECT_NEAR(results.at("scale").at("size_ratio").get<double>(), 0.05, 1e-12);
}

/// A small run whose head takes in 0.24 m3/s and lets 0.12 m3/s out by its gap, times `lie`; the discharge is 0.12 m3/s.
fs::path with_fluxes(const std::string& name, double lie) {
    const SmallRun run(name);
    run.write();
    const fs::path folder = run.directory / "postProcessing/outflow/0";
    std::istringstream velocities(testing::read_text(folder / "contour_velocity.csv"));
    std::string line, fluxes;
    std::getline(velocities, line);
    fluxes = line + "\n";
    const auto bins = static_cast<double>(std::count(line.begin(), line.end(), ','));
    while (std::getline(velocities, line)) {
        fluxes += fmt::format("{},{}", line.substr(0, line.find(',')), lie * 0.12);
        for (int bin = 1; bin < bins; ++bin) fluxes += fmt::format(",{:.12g}", -0.24 / (bins - 1.0));
        fluxes += "\n";
    }
    testing::write_text(folder / "contour_flux.csv", fluxes);
    return run.directory;
}

TEST(ResultsJson, fluxes_give_the_outflow_and_have_to_close) {
    const auto document = [](const fs::path& directory) {
        const RunData run = read_run(directory);
        return results_json(compute_results(run), run);
    };
    const json honest = document(with_fluxes("fluxes_honest", 1.0)), lying = document(with_fluxes("fluxes_lying", 1.5));
    EXPECT_NEAR(honest.at("mixing").at("outflow_over_discharge").get<double>(), 1.0, 1e-9);
    EXPECT_NEAR(honest.at("mixing").at("well_mixed_spillage").get<double>(), 0.5, 1e-9);
    EXPECT_NEAR(honest.at("mixing").at("balance_error").get<double>(), 0.0, 1e-9);
    EXPECT_NEAR(lying.at("mixing").at("balance_error").get<double>(), 0.5, 1e-9);
    EXPECT_NEAR(honest.at("outflow").at("bins")[0].at("flux_mean_m3_s").get<double>(), 0.12, 1e-9);
    EXPECT_TRUE(document_of_small_run("fluxes_none").at("mixing").at("balance_error").is_null());
}

TEST(Report, says_when_the_flux_through_the_heads_boundary_does_not_close) {
    for (const double lie : {1.0, 1.05, 1.5}) {
        const fs::path directory = with_fluxes(fmt::format("closes_{:g}", lie), lie);
        write_report(directory);
        const std::string page = testing::read_text(directory / "report/index.html");
        EXPECT_EQ(page.find("do not trust q") != std::string::npos, lie > 1.1) << lie;
    }
}

// Mean radial velocity of bin k is 0.1 k - 0.3 m/s: outwards from the fourth on, inwards above. The last bin, below the hub, is not beside
// the head.
TEST(ResultsJson, spillage_of_well_mixed_rock_follows_from_the_outflow) {
    const json mixing = document_of_small_run("mixing").at("mixing");
    const geometry::Contour contour({-0.44, -0.40, -0.25, -0.10, 0.0}, {0.10, 0.20, 0.32, 0.39, 0.40}, 0.40, 0.03);  // the small run's
    double out = 0.0;
    for (int k = 4; k < 16; ++k) {
        const double top = -0.03 * (k - 1), bottom = k == 15 ? contour.z_hub() : top - 0.03;
        for (double z = bottom + 0.5e-5; z < top; z += 1e-5) out += (0.1 * k - 0.3) * 2.0 * k_pi * contour.radius_at(z) * 1e-5;
    }
    const double q = out / 0.12;
    EXPECT_NEAR(mixing.at("outflow_over_discharge").get<double>(), q, 1e-3 * q);
    EXPECT_NEAR(mixing.at("well_mixed_spillage").get<double>(), q / (1.0 + q), 1e-3);
}

TEST(ResultsJson, settling_ratio_is_null_when_the_feed_has_no_settling_velocity) {
    SmallRun run("no_settling");
    run.write();
    testing::write_text(run.directory / "feed.json",
                        R"({"feeds": [{"requested": 9, "placed": 9, "rejected": 0,
                       "classes": [{"diameter_m": 0.02, "density_kg_m3": 2650, "count": 9}]}]})");
    const json scale = document_of(run).at("scale");
    EXPECT_TRUE(scale.at("settling_ratio").is_null());
    EXPECT_NEAR(scale.at("size_ratio").get<double>(), 0.05, 1e-12);
}

TEST(ResultsJson, conservation_is_the_largest_magnitude_of_all_steps) {
    const json conservation = document_of_small_run("conservation").at("conservation");
    EXPECT_DOUBLE_EQ(conservation.at("solid_volume_max_error").get<double>(), 4e-14);
    EXPECT_DOUBLE_EQ(conservation.at("momentum_max_error").get<double>(), 5e-12);
    EXPECT_DOUBLE_EQ(conservation.at("momentum_carried_max").get<double>(), 6.5);
    EXPECT_DOUBLE_EQ(conservation.at("momentum_carried_median").get<double>(), 0.01);
    EXPECT_DOUBLE_EQ(conservation.at("flow_balance_max_error").get<double>(), 3e-8);
    EXPECT_DOUBLE_EQ(conservation.at("interface_imbalance_max").get<double>(), 2e-5);
    EXPECT_DOUBLE_EQ(conservation.at("interface_mismatch_max").get<double>(), 4e-3);
    EXPECT_DOUBLE_EQ(conservation.at("domain_surplus_max").get<double>(), 3e-16);
    EXPECT_EQ(conservation.at("overfull_cells_max").get<double>(), 2.0);
    EXPECT_EQ(conservation.at("clipped_cells_max").get<double>(), 7.0);
}

TEST(ResultsJson, conservation_has_what_the_coupling_limited) {
    SmallRun run("limited");
    run.write();
    const char* const keys[] = {"swept_limited_cells_max", "wake_limited_rocks_max", "hidden_rocks_max", "cramped_rocks_max"};
    for (const char* key : keys) EXPECT_TRUE(document_of(run).at("conservation").at(key).is_null()) << "of an earlier program: " << key;
    const auto file = run.directory / "postProcessing/balance/0/balance.csv";
    std::istringstream lines(testing::read_text(file));
    std::string line, text;
    for (int i = 0; std::getline(lines, line); ++i) {
        const char* const counts = i == 50 ? ",3e-4,5,0,2,0\n" : ",1e-4,1,0,1,0\n";
        text += line + (i == 0 ? ",momentum_boundary,swept_limited_cells,wake_limited_rocks,hidden_rocks,cramped_rocks\n" : counts);
    }
    testing::write_text(file, text);
    const json conservation = document_of(run).at("conservation");
    const double expected[] = {5.0, 0.0, 2.0, 0.0};
    for (int i = 0; i < 4; ++i) EXPECT_EQ(conservation.at(keys[i]).get<double>(), expected[i]) << keys[i];
    EXPECT_EQ(conservation.at("overfull_cells_max").get<double>(), 2.0);
}

TEST(ResultsJson, cost_sums_the_steps) {
    const json cost = document_of_small_run("cost").at("cost");
    EXPECT_NEAR(cost.at("wall_s").get<double>(), 400.0, 1e-9);
    EXPECT_EQ(cost.at("steps"), 200);
    EXPECT_NEAR(cost.at("share").at("fluid").get<double>(), 0.6, 1e-12);
    EXPECT_NEAR(cost.at("share").at("dem").get<double>(), 0.03, 1e-12);
    EXPECT_TRUE(cost.at("predicted").is_null()) << "no prediction.json";
}

// On a busy machine ranks wait for each other: wall time times ranks is more than they worked.
TEST(ResultsJson, core_time_is_the_processor_time_of_all_starts) {
    SmallRun run("core_time");
    run.write();
    const fs::path cost = run.directory / "postProcessing/cost";
    const auto worked = [&](const char* start, double core_s) {
        json summary = json::parse(testing::read_text(cost / start / "cost.json"));
        summary["core_s"] = core_s;
        testing::write_text(cost / start / "cost.json", summary.dump());
    };
    worked("0", 500.0);
    EXPECT_NEAR(document_of(run).at("cost").at("core_s").get<double>(), 500.0, 1e-9);
    EXPECT_NEAR(document_of(run).at("cost").at("core_s_per_revolution").get<double>(), 250.0, 1e-6);
    fs::remove_all(run.directory / "postProcessing");
    run.write_tables("0", 0.0, 1.5);
    run.write_tables("1.5", 1.5, 2.0);
    worked("0", 300.0);
    worked("1.5", 90.0);
    EXPECT_NEAR(document_of(run).at("cost").at("core_s").get<double>(), 390.0, 1e-9);
    fs::remove(cost / "0/cost.json");  // killed after 150 steps of 2 s on 2 ranks
    EXPECT_NEAR(document_of(run).at("cost").at("core_s").get<double>(), 600.0 + 90.0, 1e-9);
    testing::write_text(run.directory / "replaced_starts.csv", "start_s,core_s\n1.5,42\n");
    EXPECT_NEAR(document_of(run).at("cost").at("core_s").get<double>(), 600.0 + 90.0 + 42.0, 1e-9);
}

TEST(ResultsJson, predicted_cost_is_that_of_the_time_that_the_run_went_through) {
    SmallRun run("predicted");
    run.write();  // two revolutions of 1 s in 200 steps, rock from 1 s on
    std::ofstream(run.directory / "prediction.json") << json{{"cells", 50000.0},
                                                             {"time_step_s", 0.01},
                                                             {"time_step_with_rock_s", 0.005},
                                                             {"first_release_s", 1.0},
                                                             {"core_hours_per_revolution", 0.1},
                                                             {"core_hours_per_revolution_with_rock", 0.2},
                                                             {"revolutions", 10.0}};
    const json predicted = document_of(run).at("cost").at("predicted");
    EXPECT_NEAR(predicted.at("core_s").get<double>(), 360.0 + 720.0, 1e-6);
    EXPECT_NEAR(predicted.at("steps").get<double>(), 100.0 + 200.0, 1e-9);
    EXPECT_NEAR(predicted.at("error").at("core_s").get<double>(), 1080.0 / 800.0 - 1.0, 1e-9);
    EXPECT_NEAR(predicted.at("error").at("steps").get<double>(), 0.5, 1e-9);
}

TEST(ResultsJson, predicted_cost_knows_the_longer_steps_of_a_flow_that_develops) {
    SmallRun run("predicted_development");
    run.write();  // two revolutions of 1 s, rock from 1 s on
    std::ofstream(run.directory / "prediction.json") << json{{"cells", 50000.0},
                                                             {"time_step_s", 0.01},
                                                             {"time_step_with_rock_s", 0.005},
                                                             {"first_release_s", 1.0},
                                                             {"development_end_s", 0.6},
                                                             {"development_step_ratio", 3.0},
                                                             {"core_hours_per_revolution", 0.1},
                                                             {"core_hours_per_revolution_with_rock", 0.2},
                                                             {"revolutions", 10.0}};
    const json predicted = document_of(run).at("cost").at("predicted");
    EXPECT_NEAR(predicted.at("steps").get<double>(), 20.0 + 40.0 + 200.0, 1e-9);
    EXPECT_NEAR(predicted.at("core_s").get<double>(), 0.6 * 360.0 + 720.0, 1e-6);
}

TEST(ResultsJson, a_resumed_run_gives_the_numbers_of_an_uninterrupted_one) {
    const json whole = document_of_small_run("whole");
    SmallRun run("resumed");
    run.write();
    // Killed at 1.73 s, resumed from the checkpoint of 1.3 s (rock 3 leaves in its very step). After it the killed part went another way.
    const auto post = run.directory / "postProcessing";
    std::filesystem::remove_all(post);
    SmallRun killed = run;
    killed.finished = false;
    killed.events.push_back({1.71, 7, "mouth", "in", ""});
    killed.write_tables("0", 0.0, 1.73);
    run.write_tables("1.3", 1.3, 2.0);
    for (const char* file : {"rock/0/fates.csv", "loads/0/loads.csv", "outflow/0/contour_velocity.csv", "balance/0/balance.csv"}) {
        std::string text = testing::read_text(post / file);
        text.resize(text.size() - 7);  // killed in the middle of a line
        testing::write_text(post / file, text);
    }
    json resumed = document_of(run), same = whole;
    EXPECT_NEAR(resumed.at("cost").at("core_s").get<double>(), 173 * 2.0 * 2 + 800.0, 1e-9) << "what was computed twice was paid twice";
    for (json* document : {&resumed, &same})
        for (const char* key : {"core_s", "core_s_per_revolution"}) (*document)["cost"].erase(key);
    same["run"]["name"] = "small run";
    EXPECT_EQ(resumed.dump(2), same.dump(2));
}

// The last start may have had nothing to warn of.
TEST(ResultsJson, warnings_are_those_of_all_starts) {
    SmallRun run("warnings");
    run.write();
    EXPECT_EQ(document_of(run).at("warnings"), json::array());
    fs::remove_all(run.directory / "postProcessing");
    run.write_tables("0", 0.0, 1.5);
    run.write_tables("1.5", 1.5, 2.0);
    const fs::path cost = run.directory / "postProcessing/cost";
    const auto warn = [&](const char* start, const std::vector<std::string>& texts) {
        json summary = json::parse(testing::read_text(cost / start / "cost.json"));
        summary["warnings"] = texts;
        testing::write_text(cost / start / "cost.json", summary.dump());
    };
    warn("0", {"time 0.5 s: 64 cells hold <much> rock"});
    warn("1.5", {"time 1.9 s: the end"});
    EXPECT_EQ(document_of(run).at("warnings"), json::array({"time 0.5 s: 64 cells hold <much> rock", "time 1.9 s: the end"}));
    write_report(run.directory);
    EXPECT_THAT(testing::read_text(run.directory / "report/index.html"),
                ::testing::HasSubstr("<p class=\"notice\">time 0.5 s: 64 cells hold &lt;much&gt; rock.</p>"));
    warn("1.5", std::vector<std::string>(12, "time 1.9 s: again"));
    EXPECT_EQ(document_of(run).at("warnings").size(), 11u);
    EXPECT_EQ(document_of(run).at("warnings").back(), "3 more are in postProcessing/cost/*/warnings.txt");
}

TEST(ResultsJson, pure_flow_has_outflow_and_no_rock) {
    SmallRun run("pure_flow");
    run.with_rock = false;
    run.end_time = 3.0;
    run.write();
    const json results = document_of(run);
    EXPECT_TRUE(results.at("rock").is_null());
    EXPECT_TRUE(results.at("spillage").is_null());
    EXPECT_NEAR(results.at("outflow").at("bins")[5].at("radial_velocity_mean_m_s").get<double>(), 0.2, 1e-9);
    EXPECT_EQ(results.at("rotor").at("averaged_revolutions"), 2);
    EXPECT_NEAR(results.at("rotor").at("torque_flow_mean_n_m").get<double>(), -11.0, 1e-9);
    EXPECT_TRUE(results.at("rotor").at("torque_rock_mean_n_m").is_null());
    EXPECT_TRUE(results.at("operation").at("delivered_concentration").is_null());
    EXPECT_TRUE(results.at("conservation").at("solid_volume_max_error").is_null());
    EXPECT_NEAR(results.at("conservation").at("flow_balance_max_error").get<double>(), 3e-8, 1e-20);
}

TEST(ResultsJson, loads_are_means_over_passings_of_a_blade_before_there_is_a_whole_revolution) {
    SmallRun run("passings");
    run.finished = false;
    run.end_time = 1.6;  // three of six passings and a part of the fourth
    run.write();
    const json rotor = document_of(run).at("rotor");
    EXPECT_DOUBLE_EQ(rotor.at("averaged_revolutions").get<double>(), 0.5);
    EXPECT_NEAR(rotor.at("torque_flow_mean_n_m").get<double>(), -11.0 - 4.0 * 2.0 / k_pi, 0.01);
    run.end_time = 1.1;
    run.write();
    const json early = document_of(run).at("rotor");
    EXPECT_TRUE(early.at("torque_flow_mean_n_m").is_null());
    EXPECT_FALSE(early.at("mean_reason").get<std::string>().empty());
}

TEST(ResultsJson, an_unfinished_run_says_so) {
    SmallRun run("unfinished");
    run.finished = false;
    run.end_time = 1.5;
    run.write();
    const json results = document_of(run);
    EXPECT_EQ(results.at("run").at("finished"), false);
    EXPECT_TRUE(results.at("cost").at("core_s").is_null());
    EXPECT_EQ(results.at("rock").at("fates").at("sucked_up").at("count"), 2);
}

TEST(ResultsJson, nothing_decided_leaves_the_ratio_null_with_its_reason) {
    SmallRun run("undecided");
    run.end_time = 1.2;
    run.finished = false;
    run.write();
    const json spillage = document_of(run).at("spillage");
    EXPECT_TRUE(spillage.at("ratio").is_null());
    EXPECT_EQ(spillage.at("ratio_min"), 0.0);
    EXPECT_EQ(spillage.at("ratio_max"), 1.0);
    EXPECT_EQ(spillage.at("undecided"), 1.0);
    EXPECT_EQ(spillage.at("ratio_reason"), "no rock was spilled or sucked up yet");
}

TEST(ReadRun, names_every_missing_key_of_the_study) {
    SmallRun run("missing_keys");
    run.write();
    testing::write_text(run.directory / "study.resolved.toml", "[rotor]\nspeed_rpm = 0\n");
    try {
        read_run(run.directory);
        FAIL();
    } catch (const UserError& error) {
        const std::string text = error.what();
        for (const char* part :
             {"rotor.speed_rpm = 0 is not positive", "suction.discharge_m3_s", "report.bin_width_m", "fluid.density_kg_m3"}) {
            EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
        }
    }
}

TEST(ReadRun, refuses_a_directory_without_a_computed_step) {
    SmallRun run("not_started");
    run.write();
    std::filesystem::remove_all(run.directory / "postProcessing");
    try {
        read_run(run.directory);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("contains no computed time step"), std::string::npos);
    }
    EXPECT_THROW(read_run(run.directory / "elsewhere"), UserError);
}

/// Each of these ended as a defect of the program, or as another number, before it was checked.
TEST(ReadRun, refuses_values_of_another_kind_with_file_value_rule_and_remedy) {
    const std::vector<std::tuple<const char*, const char*, json, const char*>> wrong{
        {"feed.json", "/feeds/0/requested", "eleven", "feeds[0].requested = \"eleven\""},
        {"feed.json", "/feeds/0/requested", 1e300, "feeds[0].requested = 1e+300"},
        {"feed.json", "/feeds/0/rejected", -1, "feeds[0].rejected = -1"},
        {"feed.json", "/feeds/0/reasons", {1}, "feeds[0].reasons[0] = 1"},
        {"feed.json", "/feeds/0/classes/0", "round", "feeds[0].classes[0] = \"round\""},
        {"feed.json", "/feeds", 7, "feeds = 7"},
        {"geometry/geometry.json", "/head/blades", 4294967296, "head.blades = 4294967296"},
        {"geometry/geometry.json", "/head/ring_radius_m", "wide", "head.ring_radius_m = \"wide\""},
        {"geometry/geometry.json", "/file", json::object(), "file = {}"},
        {"mesh.json", "/gates/0/passed", "yes", "gates[0].passed = \"yes\""},
        {"mesh.json", "/gates/1", 1, "gates[1] = 1"},
        {"mesh.json", "/cells", 1e300, "cells = 1e+300"},
        {"manifest.json", "/stages", "mesh", "stages = \"mesh\""},
        {"manifest.json", "/versions", 2, "versions = 2"},
        {"postProcessing/cost/0/cost.json", "/models/0", nullptr, "models[0] = null"},
        {"postProcessing/cost/0/cost.json", "/ranks", -2, "ranks = -2"},
        {"postProcessing/cost/0/cost.json", "/versions", {1}, "versions = [1]"}};
    for (const auto& [file, place, value, what] : wrong) {
        SmallRun run("wrong_kind");
        run.write();
        json document = json::parse(testing::read_text(run.directory / file));
        document[json::json_pointer(place)] = value;
        testing::write_text(run.directory / file, document.dump());
        try {
            const RunData data = read_run(run.directory);
            results_json(compute_results(data), data);
            ADD_FAILURE() << file << " " << place << " = " << value << " is accepted";
        } catch (const UserError& error) {
            ASSERT_EQ(error.mistakes().size(), 1u) << error.what();
            const Mistake& mistake = error.mistakes().front();
            EXPECT_EQ(mistake.where, (run.directory / file).string());
            EXPECT_EQ(mistake.what, what);
            EXPECT_FALSE(mistake.rule.empty() || mistake.remedy.empty()) << error.what();
        }
    }
}

TEST(ReadRun, counts_of_several_feeds_add_up_beyond_the_range_of_one) {
    SmallRun run("many_rocks");
    run.write();
    json report = json::parse(testing::read_text(run.directory / "feed.json"));
    report["feeds"][0]["requested"] = 2147483647;
    report["feeds"].push_back(report["feeds"][0]);
    testing::write_text(run.directory / "feed.json", report.dump());
    EXPECT_EQ(read_run(run.directory).feed->requested, 4294967294);
}

TEST(ReadRun, refuses_a_bin_width_that_would_fill_the_memory) {
    SmallRun run("narrow_bins");
    run.write();
    const auto file = run.directory / "study.resolved.toml";
    std::string text = testing::read_text(file);
    const std::string key = "bin_width_m = 0.03";
    text.replace(text.find(key), key.size(), "bin_width_m = 1e-300");
    testing::write_text(file, text);
    EXPECT_THROW(read_run(run.directory), UserError);
}

TEST(Results, of_a_rotor_too_fast_for_its_time_steps_end) {
    SmallRun run("fast");
    run.speed_rpm = 1e300;
    run.write();
    const Spillage spillage = *compute_results(read_run(run.directory)).spillage;
    EXPECT_LE(spillage.at_revolutions.size(), 200u);  // rows of the tables
}

TEST(ReadRun, refuses_outflow_of_another_bin_width) {
    SmallRun run("other_bins");
    run.write();
    const auto file = run.directory / "study.resolved.toml";
    std::string text = testing::read_text(file);
    const std::string key = "bin_width_m = ";
    text.replace(text.find(key) + key.size(), 4, "0.05");
    testing::write_text(file, text);
    try {
        read_run(run.directory);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("report.bin_width_m"), std::string::npos);
    }
}

}  // namespace
}  // namespace cutterflow::postproc
