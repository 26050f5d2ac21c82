/// Rock between the blades of a turning rotor, in small: 2,928 cells, 20 rocks, a sliding interface, walls that push both. What must hold
/// in every step of every run is held here: volume, momentum and flow balances, a batch that enters without a blow, a killed run that
/// resumes.
#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cases/runner/solver_run.hpp"
#include "cases/testing/tiny_rotor_mesh.hpp"
#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/head/head_names.hpp"
#include "geometry/io/write_stl.hpp"
#include "postproc/draw/head/head_series.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/momentum_carried.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/killed_run.hpp"
#include "validation/harness/scenes/rotor_case.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

constexpr int k_rocks = 20;
constexpr double k_rock_diameter = 0.02;
constexpr double k_release = 0.05;  // [s]
constexpr double k_end = 0.3;

/// Rock in the gap ahead of a lump of steel and in its lee.
std::string feed_table() {
    std::string text = "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n";
    for (int i = 0; i < k_rocks; ++i) {
        const double azimuth = (66.0 + 26.0 * (i % 4)) * k_pi / 180.0 + 2.0 * k_pi * k_release;
        const double radius = 0.1275;
        text += fmt::format("{},{},{},{},{},{},2650\n", i + 1, k_release, radius * std::cos(azimuth), radius * std::sin(azimuth),
                            -0.2 + 0.045 * (i / 4), k_rock_diameter);
    }
    return text;
}

fs::path rotor_case(const std::string& name, const std::string& feed = feed_table(), double end = k_end) {
    const fs::path folder = scratch_folder(name);
    cases::CaseInputs inputs = cases::test::tiny_inputs();
    inputs.times.end = end;
    inputs.checkpoint.interval = 0.05;
    inputs.times.write_interval = 0.1;
    inputs.rock.emplace();
    coupling::use_preset(inputs.rock->contact, coupling::k_paper_pairs);
    write_rotor_case(folder, inputs, feed);
    return folder;
}

using Table = std::map<std::string, std::vector<double>>;

Table table_of(const fs::path& folder, const std::string& name) {
    const std::string file = name.substr(name.find('/') + 1);
    return read_columns(folder / "postProcessing" / name.substr(0, name.find('/')) / "0" / file);
}

class Rotor : public ::testing::TestWithParam<int> {};

TEST_P(Rotor, conserves_volume_momentum_and_flow_with_rock_between_its_blades) {
    const fs::path folder = rotor_case(fmt::format("rotor_{}", GetParam()));
    run_cutter_foam(folder, GetParam());
    const Table balance = table_of(folder, "balance/balance.csv");
    ASSERT_NEAR(balance.at("time_s").back(), k_end, 1e-9);
    EXPECT_EQ(balance.at("rocks").back(), k_rocks);
    EXPECT_GT(largest(balance.at("contacts")), 0);
    EXPECT_LE(largest(balance.at("solid_volume_error")), 1e-12);
    EXPECT_LE(largest(balance.at("momentum_error")), 1e-5);
    EXPECT_LE(median_carried(balance), k_most_carried);

    double flow_balance = 0.0;
    const auto& time = balance.at("time_s");
    for (std::size_t i = 0; i < time.size(); ++i)
        if (time[i] > k_release) flow_balance = std::max(flow_balance, balance.at("flow_balance_error")[i]);
    EXPECT_LE(flow_balance, 1e-6);

    const Table fates = table_of(folder, "rock/fates.csv");
    double placed = 0.0;
    for (const char* fate : {"sucked_up_count", "spilled_count", "in_cutter_count", "never_entered_count"}) placed += fates.at(fate).back();
    EXPECT_EQ(placed, k_rocks);
    // test_paraview opens this run, with soil beside it that nobody felt; surfaceMeshExtract wrote text where a run has a binary file.
    run_in_case(folder, {"surfaceConvert", names::cutter_surface, "geometry/binary.stlb"});
    fs::rename(folder / "geometry/binary.stlb", folder / names::cutter_surface);
    geometry::write_stl(bank_beside_rotor(cases::test::tiny_inputs().contour).soil(k_reach_beside_rotor), folder / names::bank_surface);
    postproc::write_head_series(folder);
    fmt::print(
        "rotor on {} rank(s): {} steps, solid volume error {:.1e}, momentum error {:.1e}, owed {:.1e} (at most {:.1e}), flow balance "
        "{:.1e} of Q, spilled {}\n",
        GetParam(), time.size(), largest(balance.at("solid_volume_error")), largest(balance.at("momentum_error")), median_carried(balance),
        largest(balance.at("momentum_carried")), flow_balance, fates.at("spilled_count").back());
}

TEST_P(Rotor, takes_a_batch_of_rock_without_a_blow) {
    // What the step of insertion changes outlet flow and pressure by is no more than what steps with the same rock change them by later.
    const fs::path folder = rotor_case(fmt::format("rotor_batch_{}", GetParam()));
    run_cutter_foam(folder, GetParam());
    const Table balance = table_of(folder, "balance/balance.csv");
    const auto& time = balance.at("time_s");
    const auto& pressure = balance.at("outlet_pressure_m2_s2");
    double at_insertion = 0.0, later = 0.0;
    for (std::size_t i = 1; i < time.size(); ++i) {
        const double change = std::abs(pressure[i] - pressure[i - 1]);
        if (balance.at("rocks")[i - 1] == 0 && balance.at("rocks")[i] > 0) at_insertion = change;
        if (balance.at("rocks")[i - 1] > 0) later = std::max(later, change);
        EXPECT_NEAR(balance.at("outlet_flow_m3_s")[i], 0.01, 1e-8);
    }
    fmt::print("change of outlet pressure in a step: {:.3g} at insertion, up to {:.3g} later [m2/s2]\n", at_insertion, later);
    EXPECT_GT(at_insertion, 0.0);
    EXPECT_LE(at_insertion, later);
    EXPECT_LE(later, 0.9);  // of the order of the tip speed squared: no step of these is a blow itself
}

INSTANTIATE_TEST_SUITE_P(Ranks, Rotor, ::testing::Values(1, 2));

/// Samples of a point at rest during which a lump of steel covers it, of `samples` over the first `turned` degrees: the lumps are 45
/// degrees long and begin at 0 and 180 degrees.
double covered_samples(double azimuth_deg, double turned, double samples) {
    const double from = std::clamp(azimuth_deg - 45.0, 0.0, turned), to = std::clamp(azimuth_deg, 0.0, turned);
    return samples * (to - from) / turned;
}

TEST(FlowAlone, has_dry_samples_where_steel_covers_a_point) {
    constexpr double k_turned = 45.0, k_radius = 0.125, k_z = -0.1;
    cases::CaseInputs inputs = cases::test::tiny_inputs();
    inputs.times.end = inputs.times.write_interval = inputs.checkpoint.interval = k_turned / 360.0;
    const double still[] = {20.0, 50.0, 60.0, 75.0, 89.0, 100.0, 225.0}, turning[] = {22.0, 60.0};
    cases::VelocitySetInput set;
    set.name = "path";
    const auto place = [&](double azimuth_deg) {
        return Vec3(k_radius * std::cos(azimuth_deg * k_pi / 180.0), k_radius * std::sin(azimuth_deg * k_pi / 180.0), k_z);
    };
    for (const double azimuth : still) set.points.push_back({place(azimuth), false});
    for (const double azimuth : turning) set.points.push_back({place(azimuth), true});
    inputs.velocity_sets = {set};
    const fs::path folder = scratch_folder("rotor_dry");
    write_rotor_case(folder, inputs, "");
    run_cutter_foam(folder);

    const Table table = table_of(folder, "velocity/path.csv");
    const std::vector<double>&samples = table.at("samples"), &dry = table.at("dry_samples");
    ASSERT_EQ(dry.size(), std::size(still) + std::size(turning));
    EXPECT_GE(samples[0], 14.0);
    for (std::size_t i = 0; i < std::size(still); ++i) {
        const double azimuth = std::fmod(still[i], 180.0);
        EXPECT_NEAR(dry[i], covered_samples(azimuth, k_turned, samples[i]), 1.5) << still[i];
    }
    EXPECT_EQ(dry[std::size(still)], samples[0]) << "a point within a lump, which turns with it";
    EXPECT_EQ(dry[std::size(still) + 1], 0.0) << "a point between the lumps, which turns with them";
}

/// Rock, surface and direction of an event.
std::string what_happened(const std::string& event) {
    const std::size_t first = event.find(',');
    std::size_t end = first;
    for (int field = 0; field < 3; ++field) end = event.find(',', end + 1);
    return event.substr(first, end - first);
}

TEST(KilledRun, resumes_with_the_same_rock_and_no_event_twice) {
    const fs::path whole = rotor_case("rotor_whole");
    run_cutter_foam(whole);
    const fs::path killed = rotor_case("rotor_killed");
    run_and_kill_after(killed, "0.1", 1);
    run_cutter_foam(killed);

    const std::vector<std::string> events = rows_of_all_starts(killed / "postProcessing/rock", "events.csv");
    EXPECT_EQ(std::set<std::string>(events.begin(), events.end()).size(), events.size());
    const std::vector<std::string> uninterrupted_events = rows_of_all_starts(whole / "postProcessing/rock", "events.csv");
    ASSERT_EQ(events.size(), uninterrupted_events.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
        EXPECT_EQ(what_happened(events[i]), what_happened(uninterrupted_events[i]));
        EXPECT_NEAR(std::stod(events[i]), std::stod(uninterrupted_events[i]), 1e-6);
    }
    EXPECT_EQ(rows_of_all_starts(killed / "postProcessing/rock", "fates.csv").size(),
              rows_of_all_starts(whole / "postProcessing/rock", "fates.csv").size());

    const RockSnapshot resumed = last_rocks(killed), uninterrupted = last_rocks(whole);
    ASSERT_EQ(resumed.position.size(), static_cast<std::size_t>(k_rocks));
    double apart = 0.0;
    for (std::size_t p = 0; p < resumed.position.size(); ++p)
        apart = std::max(apart, (resumed.position[p] - uninterrupted.position[p]).norm());
    fmt::print("resumed and uninterrupted run end {:.1e} m apart\n", apart);
    EXPECT_LE(apart, 1e-3 * k_rock_diameter);
}

/// The run at its checkpoint of 0.1 s, resumed on another number of ranks.
RockSnapshot gone_on_with(const fs::path& whole, int ranks) {
    const fs::path folder = scratch_folder(fmt::format("rotor_on_{}_ranks", ranks));
    fs::copy(whole, folder, fs::copy_options::recursive);
    fs::remove_all(folder / names::checkpoints / "0.14");
    drop_times_after_checkpoint(folder);
    EXPECT_EQ(cases::move_checkpoint_to_ranks(folder, ranks).from, 2);
    run_cutter_foam(folder, ranks);
    EXPECT_TRUE(fs::exists(folder / "postProcessing/rock/0.1/fates.csv"));
    return last_rocks(folder);
}

TEST(Restart, goes_on_on_another_number_of_ranks) {
    // Two rocks that touch nothing.
    const std::string feed = fmt::format(
        "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n1,{0},0,0.18,-0.1,0.02,2650\n2,{0},-0.05,0.23,0,0.02,2650\n", k_release);
    const fs::path whole = rotor_case("rotor_two_rocks", feed, 0.14);
    run_cutter_foam(whole, 2);
    const RockSnapshot uninterrupted = last_rocks(whole);
    ASSERT_EQ(uninterrupted.position.size(), 2u);
    for (const int ranks : {1, 2}) {
        const RockSnapshot resumed = gone_on_with(whole, ranks);
        ASSERT_EQ(resumed.position.size(), 2u);
        double apart = 0.0;
        for (std::size_t p = 0; p < 2; ++p) apart = std::max(apart, (resumed.position[p] - uninterrupted.position[p]).norm());
        fmt::print("begun on 2 ranks, resumed on {}: rock ends {:.1e} m apart\n", ranks, apart);
        EXPECT_LE(apart, 1e-10 * 2.0 * cases::test::k_tiny_tank_radius);
    }
}

}  // namespace
}  // namespace cutterflow::validation
