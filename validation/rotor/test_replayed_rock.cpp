/// One small rock, which hardly moves the water, goes the same way coupled and in a replay. The water of the small rotor is run to the
/// second revolution; from its checkpoint it is run on without rock and recorded, and again with one rock, which is released within the
/// recorded revolution: what of the flow changes from one revolution to the next is the same for both.
///
/// What was expected to differ, for a rock of 8 mm and 1050 kg/m3 that slips by s = 0.1 m/s (drag D s = 1.4e-4 N), laid with sigma =
/// 0.05 m:
///   its wake, which is not in the replay    D/(20 rho s sigma^2) of the slip: 0.03 %, most of which own_trace takes out of the coupled one
///   water that makes way for it             V/(30 sigma^3) of the slip: 0.01 %
///   the flow between phases                 (n 2.5 deg)^2 5/24 of the n-th wave of a turn: 0.2 % of that of two blades
///   the length of steps                     a rock feels the flow of a step's beginning, here for 12.5 ms instead of 2.8: it lags by
///                                           half the difference, 5 ms of a way of 0.8 s: 0.6 % of the way
///   one node that looks past steel          0.7 % of the slip in the mean of a head's rocks
/// In all 1 % of the way, of which the rock's own doing is less than a twentieth. 0.49 % came, 1.3 % of the speed. Where the view is cut by
/// steel that is hardly thicker than a cell of this coarse mesh, one node counts for more: 14 % of the way of a rock that began 20 mm
/// beside a lump, 2 % of it when steel hid nothing.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cases/scenes/cutter/case_builder.hpp"
#include "cases/testing/tiny_rotor_mesh.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/head/head_names.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/rotor_case.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

constexpr double k_period = 1.0;                                        // 60 rpm [s]
constexpr double k_begin = 2.0 * k_period, k_end = k_begin + k_period;  // of the recording
constexpr double k_release = k_begin + 0.1, k_followed = 0.8;           // [s]
constexpr double k_later = 0.15;                                        // of a replay for comparison [s]
constexpr double k_picture = 0.05;                                      // [s]
constexpr double k_interface_radius = 0.2;                              // [m]
constexpr double k_tolerance = 0.02;                                    // of the way

/// Beside the turning cells, into which the water takes it, behind a lump of steel and ahead of the other.
std::string feed(double release) {
    const double azimuth = 264.0 * k_pi / 180.0, radius = 0.21;
    return fmt::format("id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n1,{},{},{},-0.15,0.008,1050\n", release, radius * std::cos(azimuth),
                       radius * std::sin(azimuth));
}

cases::CaseInputs inputs_until(double end) {
    cases::CaseInputs inputs = cases::test::tiny_inputs();
    inputs.discharge = 0.1;
    inputs.times.end = inputs.checkpoint.interval = end;
    inputs.times.write_interval = k_picture;
    inputs.rock.emplace();
    inputs.rock->density = 1050.0;
    coupling::use_preset(inputs.rock->contact, coupling::k_paper_pairs);
    return inputs;
}

/// The water until it is recorded.
fs::path begun_flow() {
    const fs::path folder = scratch_folder("replayed_rock_begun");
    cases::CaseInputs inputs = inputs_until(k_begin);
    inputs.times.write_interval = k_begin;
    inputs.times.development_end = k_begin - k_period;
    write_rotor_case(folder, inputs, feed(k_release));
    run_cutter_foam(folder);
    return folder;
}

/// Goes on with a run to `end`. \param inputs  without the steel, which every case of the rotor has
void go_on(const fs::path& folder, cases::CaseInputs inputs, double end, const std::string& rock) {
    inputs.times.end = end;
    inputs.rock->walls = cases::standard_walls();
    cases::fill_scaled_defaults(inputs);
    cases::write_case(folder, inputs);
    write_file(folder / names::rock_feed, rock);
    run_cutter_foam(folder);
}

fs::path copy_of(const fs::path& run, const std::string& name) {
    const fs::path folder = scratch_folder(name);
    fs::copy(run, folder, fs::copy_options::recursive);
    return folder;
}

/// With rock that would come after the recording. Its phases are twice as long as those of a head of six blades.
/// \param ends  one after the other, of runs that go on from each other's checkpoint
fs::path recorded(const fs::path& begun, const std::string& name, const std::vector<double>& ends) {
    const fs::path folder = copy_of(begun, name);
    cases::CaseInputs inputs = inputs_until(k_end);
    inputs.record.emplace();
    inputs.record->start_time = k_begin;
    inputs.record->end_time = k_end;
    inputs.record->phases = 144;
    for (const double end : ends) go_on(folder, inputs, end, feed(2.0 * k_end));
    return folder;
}

/// Whether a recording tells by how much its flow changed in the revolution.
bool knows_its_change(const fs::path& run) {
    return nlohmann::json::parse(read_file(run / names::recording / "recording.json")).at("change").is_number();
}

/// Pictures of a run from the rock's release on.
std::vector<RockSnapshot> path_in(const fs::path& folder) {
    std::vector<RockSnapshot> path = all_rocks(folder);
    path.erase(std::remove_if(path.begin(), path.end(), [](const RockSnapshot& picture) { return picture.position.empty(); }), path.end());
    return path;
}

std::vector<RockSnapshot> replayed(const fs::path& recording, const std::string& name, double release = k_release) {
    const fs::path folder = scratch_folder(name);
    cases::CaseInputs inputs = inputs_until(release + k_followed);
    inputs.replay = recording / names::recording;
    inputs.rock->walls = cases::standard_walls();
    for (coupling::WallSettings& wall : inputs.rock->walls) wall.file = recording / wall.file;
    cases::fill_scaled_defaults(inputs);
    cases::write_replay_case(folder, inputs);
    write_file(folder / names::rock_feed, feed(release));
    run_cutter_foam(folder);
    return path_in(folder);
}

double way_of(const std::vector<RockSnapshot>& path) {
    double way = 0.0;
    for (std::size_t i = 1; i < path.size(); ++i) way += (path[i].position[0] - path[i - 1].position[0]).norm();
    return way;
}

/// Of another path, at the same times after its release, from one: over the way of that.
struct Deviation {
    double place = 0.0;  ///< largest distance
    double speed = 0.0;  ///< largest difference of the speeds, over the largest of them
};

Deviation deviation(const std::vector<RockSnapshot>& other, const std::vector<RockSnapshot>& one) {
    EXPECT_EQ(other.size(), one.size());
    double place = 0.0, difference = 0.0, speed = 0.0;
    for (std::size_t i = 0; i < std::min(one.size(), other.size()); ++i) {
        const double of_one = one[i].velocity[0].norm();
        place = larger(place, (other[i].position[0] - one[i].position[0]).norm());
        difference = larger(difference, std::abs(other[i].velocity[0].norm() - of_one));
        speed = larger(speed, of_one);
    }
    return {place / way_of(one), difference / speed};
}

double radius(const RockSnapshot& picture) {
    return picture.position[0].head<2>().norm();
}

TEST(ReplayedRock, goes_the_way_of_a_coupled_one) {
    const fs::path begun = begun_flow();
    const fs::path recording = recorded(begun, "replayed_rock_recorded", {k_end});
    ASSERT_TRUE(knows_its_change(recording));
    const fs::path coupled_run = copy_of(begun, "replayed_rock_coupled");
    go_on(coupled_run, inputs_until(k_release + k_followed), k_release + k_followed, feed(k_release));

    const std::vector<RockSnapshot> coupled = path_in(coupled_run), replay = replayed(recording, "replayed_rock");
    ASSERT_EQ(coupled.size(), static_cast<std::size_t>(std::lround(k_followed / k_picture)));
    EXPECT_GT(radius(coupled.front()), k_interface_radius);
    EXPECT_LT(radius(coupled.back()), k_interface_radius) << "it comes to both kinds of cells";
    EXPECT_EQ(largest(read_columns(coupled_run / "postProcessing/balance/2/balance.csv").at("contacts")), 0.0);

    const Deviation off = deviation(replay, coupled);
    EXPECT_LE(off.place, k_tolerance);
    EXPECT_LE(off.speed, k_tolerance);
    const Deviation turned = deviation(replayed(recording, "replayed_rock_later", k_release + k_later), coupled);
    EXPECT_GT(turned.place, 2.0 * k_tolerance) << "else the rotor's angle would not matter";
    fmt::print(
        "a way of {:.3f} m, replay off by {:.2f} % of it and {:.2f} % of the speed; of a rotor {:.0f} degrees on {:.1f} and {:.1f} "
        "%\n",
        way_of(coupled), 100.0 * off.place, 100.0 * off.speed, 360.0 * k_later / k_period, 100.0 * turned.place, 100.0 * turned.speed);

    const Deviation again = deviation(replayed(recording, "replayed_rock_again"), replay);
    EXPECT_EQ(again.place, 0.0);
    EXPECT_EQ(again.speed, 0.0);
    const fs::path resumed = recorded(begun, "replayed_rock_resumed", {k_begin + 0.4 * k_period, k_end});
    EXPECT_FALSE(knows_its_change(resumed)) << "it was resumed while it recorded";
    EXPECT_LE(deviation(replayed(resumed, "replayed_rock_of_resumed"), replay).place, 1e-6);
}

}  // namespace
}  // namespace cutterflow::validation
