/// Rooms from their study file to their report, through the program itself.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cases/runner/machine.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/process/child_process.hpp"
#include "postproc/run/run_table.hpp"
#include "solver/physics/settling.hpp"

using namespace cutterflow;
namespace fs = std::filesystem;

namespace {

const fs::path k_cutterflow = fs::path(CUTTERFLOW_BUILD_DIR) / "bin/cutterflow";

class RoomRuns : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "cutterflow_rooms_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// \return what the program said
    std::string call(std::vector<std::string> arguments, int exit_code = 0) {
        arguments.insert(arguments.begin(), k_cutterflow.string());
        const fs::path log = folder_ / "output";
        const ChildResult result = run_child({arguments, folder_, log, {}});
        const std::string text = read_file(log);
        fs::remove(log);
        EXPECT_EQ(result.exit_code, exit_code) << text;
        return text;
    }
    nlohmann::json json_of(const fs::path& file) const { return nlohmann::json::parse(read_file(folder_ / file)); }

    fs::path folder_;
};

const char* const k_materials = R"(
[[material]]
name = "plastic"
youngs_modulus_pa = 5e6
[[contact]]
pair = ["plastic", "plastic"]
friction = 0.5
rolling = 0.1
restitution = 0.6
[[contact]]
pair = ["plastic", "steel"]
friction = 0.3
rolling = 0.1
restitution = 0.6
[[grains]]
name = "grains"
material = "plastic"
density_kg_m3 = 828
diameter_m = { uniform_by_number = [0.0045, 0.0055] }
)";

double largest(const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
}

/// A tube is lifted from a disc.
const char* const k_heap = R"(
name = "a small heap"
[scene]
kind = "room"
[room]
size_m = [0.10, 0.10, 0.12]
[[solid]]
name = "disc"
generate = "disc_with_rim"
centre_m = [0, 0, 0.02]
radius_m = 0.035
thickness_m = 0.01
rim_height_m = 0.005
rim_wall_m = 0.003
[[solid]]
name = "tube"
generate = "tube"
from_m = [0, 0, 0.0202]
to_m = [0, 0, 0.11]
inner_radius_m = 0.015
wall_m = 0.003
velocity_m_s = [0, 0, 0.1]
from_s = 0.0
to_s = 0.5
[[prepare]]
do = "pour"
grains = "grains"
count = 120
region = { cylinder = { from_m = [0, 0, 0.02], to_m = [0, 0, 0.11], radius_m = 0.015 } }
[[prepare]]
do = "settle"
[[measure]]
name = "on_disc"
what = "mass_in"
region = { cylinder = { from_m = [0, 0, 0.02], to_m = [0, 0, 0.12], radius_m = 0.038 } }
[[measure]]
name = "height"
what = "profile"
base_m = 0.02
region = { cylinder = { from_m = [0, 0, 0.02], to_m = [0, 0, 0.12], radius_m = 0.038 } }
[run]
end_s = 3
stop = { settled = true }
write_interval_s = 0.25
)";

/// Grains run through a narrow waist below a piston that comes down after them.
const char* const k_hourglass = R"(
name = "an hourglass with a piston"
[scene]
kind = "room"
[room]
size_m = [0.08, 0.08, 0.20]
[[solid]]
name = "waist"
generate = "funnel"
centre_m = [0, 0, 0.06]
inlet_radius_m = 0.025
outlet_radius_m = 0.016
cone_height_m = 0.02
spout_length_m = 0.005
wall_m = 0.003
[[solid]]
name = "chamber"
generate = "tube"
from_m = [0, 0, 0.0851]
to_m = [0, 0, 0.18]
inner_radius_m = 0.025
wall_m = 0.003
[[solid]]
name = "stopper"
generate = "box"
lower_m = [-0.02, -0.02, 0.05]
upper_m = [0.02, 0.02, 0.0595]
removed_at_s = 0.45
[[solid]]
name = "piston"
generate = "box"
lower_m = [-0.017, -0.017, 0.185]
upper_m = [0.017, 0.017, 0.19]
velocity_m_s = [0, 0, -0.25]
from_s = 0
to_s = 0.4
[[prepare]]
do = "pour"
grains = "grains"
count = 400
region = { cylinder = { from_m = [0, 0, 0.09], to_m = [0, 0, 0.17], radius_m = 0.025 } }
[[measure]]
name = "sand"
what = "passed_mass"
gate = { disc_m = [0, 0, 0.055], radius_m = 0.03, normal = [0, 0, -1] }
[[measure]]
name = "pressed"
what = "wall_force"
wall = "piston"
component = "z"
from_s = 0.3
to_s = 0.4
[run]
end_s = 1.8
write_interval_s = 0.25
)";

/// Water is drawn through a pipe of another size than any example has, beside a plate that leans over the bed.
const char* const k_sheltered_bed = R"(
name = "a pipe beside a tilted plate"
[scene]
kind = "room"
[room]
size_m = [0.16, 0.12, 0.14]
medium = "water"
cell_m = 0.02
[[room.refine]]
cylinder = { from_m = [-0.035, 0, 0.0], to_m = [-0.035, 0, 0.14], radius_m = 0.035 }
cell_m = 0.01
[[solid]]
name = "intake"
generate = "pipe"
from_m = [-0.035, 0, 0.04]
to_m = [-0.035, 0, 0.14]
inner_radius_m = 0.019
wall_m = 0.009
[[solid]]
name = "shelter"
generate = "plate"
centre_m = [0.04, 0, 0.06]
length_m = 0.05
width_m = 0.07
thickness_m = 0.015
tilt_deg = 25
[[boundary]]
on = "top"
name = "mouth"
inside = "intake"
flow = { outflow_m_s = 0.4, ramp_s = 0.05 }
[[boundary]]
on = "sides"
above_m = 0.04
flow = "pressure"
[[prepare]]
do = "pour"
grains = "grains"
count = 200
region = { box = { lower_m = [-0.075, -0.04, 0], upper_m = [0.07, 0.04, 0.038] } }
[[event]]
do = "ramp"
boundary = "mouth"
speed_m_s = 0.9
from_s = 0.1
to_s = 0.2
[[measure]]
name = "lifted"
what = "passed_mass"
gate = { disc_m = [-0.035, 0, 0.07], radius_m = 0.019 }
[run]
end_s = 0.4
write_interval_s = 0.2
)";

/// A lid is pressed on a bed and stands in the run.
const char* const k_pressed_bed = R"(
name = "a bed under a lid"
[scene]
kind = "room"
[room]
size_m = [0.03, 0.03, 0.08]
[[solid]]
name = "lid"
generate = "box"
lower_m = [-0.0148, -0.0148, 0.05]
upper_m = [0.0148, 0.0148, 0.055]
[[prepare]]
do = "pour"
grains = "grains"
count = 120
region = { box = { lower_m = [-0.015, -0.015, 0], upper_m = [0.015, 0.015, 0.05] } }
[[prepare]]
do = "compress"
solid = "lid"
pressure_pa = 2000
[[measure]]
name = "on_lid"
what = "wall_force"
wall = "lid"
component = "z"
[run]
end_s = 0.2
write_interval_s = 0.1
)";

/// Rows of one wall.
std::vector<Vec3> of_wall(const postproc::Table& rows, const std::string& wall, const std::array<const char*, 3>& columns) {
    std::vector<Vec3> values;
    for (std::size_t n = 0; n < rows.rows(); ++n)
        if (rows.text("wall")[n] == wall)
            values.emplace_back(rows.number(columns[0])[n], rows.number(columns[1])[n], rows.number(columns[2])[n]);
    return values;
}

// The lid comes to bear pressure times area at the end of its part of the preparation; in the run it stands there, on a bed that holds it.
TEST_F(RoomRuns, a_lid_is_pressed_on_a_bed_and_stands_in_the_run) {
    write_file(folder_ / "bed.toml", std::string(k_pressed_bed) + k_materials);
    const double force = 2000.0 * 0.0296 * 0.0296;
    EXPECT_NE(call({"check", "bed.toml"}).find("lid is pressed on the grains with 1.752 N"), std::string::npos);
    call({"run", "bed.toml", "-o", "bed"});
    const std::array<const char*, 3> forces{"force_x_n", "force_y_n", "force_z_n"}, ways{"pressed_x_m", "pressed_y_m", "pressed_z_m"};
    const auto walls = [&](const fs::path& run) {
        return postproc::read_joined_table(run, "rock", "walls.csv", {{"time_s"}, {"wall"}, {}, ""});
    };
    const postproc::Table poured = walls(folder_ / "bed/bed/1"), pressed = walls(folder_ / "bed/bed/2"), run = walls(folder_ / "bed");
    for (const Vec3& way : of_wall(poured, "lid", ways)) ASSERT_EQ(way, Vec3(Vec3::Zero()));
    EXPECT_NEAR(of_wall(pressed, "lid", forces).back().z(), force, 0.01 * force);
    const Vec3 way = of_wall(pressed, "lid", ways).back();
    EXPECT_GT(way.z(), -0.05 + 0.01);
    EXPECT_LT(way.z(), -0.05 + 0.02);
    for (const Vec3& in_run : of_wall(run, "lid", ways)) ASSERT_NEAR((in_run - way).norm(), 0.0, 1e-9);
    EXPECT_NEAR(of_wall(run, "lid", forces).back().z(), force, 0.05 * force);
    EXPECT_NEAR(json_of("bed/room.json").at("solids")[0].at("pressed_m")[2].get<double>(), way.z(), 1e-9);
    EXPECT_NEAR(json_of("bed/report/measures.json").at("on_lid").at("value").get<double>(), force, 0.05 * force);
    EXPECT_NE(read_file(folder_ / "bed/report/index.html").find("pressed by"), std::string::npos);

    // The same bed for a run that prepares nothing else; another one is made.
    EXPECT_NE(call({"run", "bed.toml", "-o", "again", "--start-from", "bed"}).find("the bed is that of bed, copied from there"),
              std::string::npos);
    EXPECT_EQ(read_file(folder_ / "again/postProcessing/rock/0/walls.csv"), read_file(folder_ / "bed/postProcessing/rock/0/walls.csv"));
    EXPECT_FALSE(fs::exists(folder_ / "again/bed/1"));
    std::string other = std::string(k_pressed_bed) + k_materials;
    other.replace(other.find("2000"), 4, "1000");
    write_file(folder_ / "other.toml", other);
    EXPECT_NE(
        call({"run", "other.toml", "-o", "other", "--start-from", "bed"}).find("the bed of bed is not taken, other values of prepare"),
        std::string::npos);

    // Upwards there is nothing to press on.
    std::string upwards = std::string(k_pressed_bed) + k_materials;
    upwards.replace(upwards.find("pressure_pa = 2000"), 18, "pressure_pa = 2000\ndirection = [0, 0, 1]\nlongest_s = 0.2");
    write_file(folder_ / "upwards.toml", upwards);
    const std::string refused = call({"mesh", "upwards.toml", "-o", "upwards"}, 4);
    EXPECT_NE(refused.find("bear 0 N of the 1.752 N with which lid is pressed; it went 0.01 m"), std::string::npos) << refused;
}

TEST_F(RoomRuns, heap_goes_from_its_study_to_its_report) {
    write_file(folder_ / "heap.toml", std::string(k_heap) + k_materials);
    call({"check", "heap.toml"});
    call({"run", "heap.toml", "-o", "heap"});
    const nlohmann::json room = json_of("heap/room.json"), results = json_of("heap/report/results.json"),
                         measures = json_of("heap/report/measures.json");
    EXPECT_EQ(room.at("bed").at("poured"), 120);
    EXPECT_TRUE(fs::exists(folder_ / "heap/bed/checkpoints" / room.at("bed").at("name").get<std::string>()));
    EXPECT_TRUE(results.at("finished").get<bool>());
    EXPECT_EQ(results.at("grains"), 120);  // the room has a floor and walls
    const double poured = room.at("bed").at("poured_kg").get<double>();
    EXPECT_NEAR(results.at("grains_kg").get<double>(), poured, 1e-6 * poured);
    // It ends before its end, when all is at rest and the tube stands; most of the grains are a heap on the disc, one layer at least.
    EXPECT_LT(results.at("time_s").get<double>(), 3.0);
    EXPECT_GE(results.at("time_s").get<double>(), 0.4);
    // The last picture is of the run's end.
    const std::string account = read_file(folder_ / "heap/postProcessing/rock/0/account.csv");
    EXPECT_NEAR(results.at("time_s").get<double>(), std::stod(account.substr(account.rfind('\n', account.size() - 2) + 1)), 1e-6);
    EXPECT_EQ(results.at("account").at("in_run").at("count"), 120);
    EXPECT_EQ(results.at("account").at("left_domain").at("count"), 0);
    // Grains that lie on each other press; stiff ones do not sink into each other.
    EXPECT_GT(results.at("largest_overlap").get<double>(), 1e-5);
    EXPECT_LT(results.at("largest_overlap").get<double>(), 0.1);
    EXPECT_NE(read_file(folder_ / "heap/report/index.html").find("What became of the grains"), std::string::npos);
    EXPECT_GT(measures.at("on_disc").at("value").get<double>(), 0.5 * poured);
    EXPECT_GT(measures.at("height").at("value").get<double>(), 0.005);
    EXPECT_LT(measures.at("height").at("value").get<double>(), 0.03);
    EXPECT_NE(read_file(folder_ / "heap/report/index.html").find("a small heap"), std::string::npos);

    const std::string again = call({"run", "heap.toml", "-o", "heap"});
    EXPECT_NE(again.find("run: already done"), std::string::npos);
    EXPECT_NE(again.find("height   profile"), std::string::npos) << again;
    EXPECT_LT(again.find("on_disc  mass_in"), again.find("the report: ")) << again;
    std::string other = read_file(folder_ / "heap.toml");
    other.replace(other.find("friction = 0.5"), 14, "friction = 0.6");
    write_file(folder_ / "other.toml", other);
    EXPECT_NE(call({"run", "other.toml", "-o", "heap"}, 2).find("contact.plastic-plastic.friction (0.5 -> 0.6)"), std::string::npos);

    // Another name and another measure make the report anew and keep the run; a gate that the run did not record does not.
    const std::string study = read_file(folder_ / "heap.toml");
    std::string renamed = study;
    renamed.replace(renamed.find("a small heap"), 12, "the same heap");
    write_file(folder_ / "more.toml", renamed +
                                          "[[measure]]\nname = \"everywhere\"\nwhat = \"mass_in\"\nregion = { half_space = { point_m = [0, "
                                          "0, -1], normal = [0, 0, 1] } }\n");
    EXPECT_NE(call({"run", "more.toml", "-o", "heap"}).find("run: already done"), std::string::npos);
    EXPECT_NEAR(json_of("heap/report/measures.json").at("everywhere").at("value").get<double>(), poured, 1e-6 * poured);
    EXPECT_EQ(json_of("heap/room.json").at("name"), "the same heap");
    EXPECT_NE(read_file(folder_ / "heap/study.resolved.toml").find("everywhere"), std::string::npos);
    EXPECT_NE(call({"run", "more.toml", "-o", "heap"}).find("report: already done"), std::string::npos);
    write_file(folder_ / "more.toml",
               study + "[[measure]]\nname = \"door\"\nwhat = \"passed_mass\"\ngate = { disc_m = [0, 0, 0.02], radius_m = 0.01 }\n");
    EXPECT_NE(call({"run", "more.toml", "-o", "heap"}, 2).find("measure.door.gate.disc_m"), std::string::npos);
}

TEST_F(RoomRuns, a_bed_that_is_not_at_rest_or_lost_grains_is_refused) {
    const std::string room = "name = \"a bed\"\n[scene]\nkind = \"room\"\n[room]\nsize_m = [0.06, 0.06, 0.08]\n";
    const std::string pour = "[[prepare]]\ndo = \"pour\"\ngrains = \"grains\"\ncount = 60\n[[prepare]]\ndo = \"settle\"\n";
    const std::string rest = std::string(k_materials) + "[run]\nend_s = 0.1\n";
    write_file(folder_ / "bed.toml", room + pour + rest);
    for (const std::string& said : {call({"check", "bed.toml"}), call({"run", "bed.toml", "-o", "bed"})})
        EXPECT_NE(said.find("warning: bed.toml: it has no [[measure]]"), std::string::npos) << said;
    EXPECT_NE(read_file(folder_ / "bed/report/index.html").find("What became of the grains"), std::string::npos);
    write_file(folder_ / "hasty.toml", room + pour + "longest_s = 0.02\n" + rest);
    EXPECT_NE(call({"run", "hasty.toml", "-o", "hasty"}, 4).find("are not at rest after 0.02 s"), std::string::npos);
    write_file(folder_ / "open.toml", room + "[[boundary]]\non = \"sides\"\ngrains = \"open\"\n" + pour + rest);
    EXPECT_NE(call({"run", "open.toml", "-o", "open"}, 4).find("left the room. A bed has all grains that are poured"), std::string::npos);
    write_file(folder_ / "loose.toml", room + pour + "[[prepare]]\ndo = \"freeze\"\nabove_m = 0.07\n" + rest);
    const std::string said = call({"run", "loose.toml", "-o", "loose"}, 2);
    EXPECT_NE(said.find("loose.toml:13: do = \"freeze\" finds 0 grains in its region"), std::string::npos) << said;
    EXPECT_NE(said.find("those of its 60 lie from"), std::string::npos) << said;
}

/// A later part begins without the grains that were taken out before.
TEST_F(RoomRuns, grains_that_were_trimmed_do_not_count_as_waiting) {
    std::string study = std::string(k_pressed_bed) + k_materials;
    study.insert(study.find("[[prepare]]\ndo = \"compress\""),
                 "[[prepare]]\ndo = \"trim\"\nabove_m = 0.01\n[[prepare]]\ndo = \"pour\"\ngrains = \"grains\"\ncount = 3\n"
                 "region = { box = { lower_m = [-0.015, -0.015, 0], upper_m = [0.015, 0.015, 0.05] } }\n");
    study.replace(study.find("pressure_pa = 2000"), 18, "pressure_pa = 2000\nlongest_s = 0.02");
    write_file(folder_ / "bed.toml", study);
    const std::string said = call({"run", "bed.toml", "-o", "bed"}, 4);
    EXPECT_NE(said.find("with which lid is pressed; it went"), std::string::npos) << said;
    EXPECT_EQ(said.find("found no room"), std::string::npos) << said;
}

TEST_F(RoomRuns, studies_that_nobody_foresaw_run) {
    write_file(folder_ / "hourglass.toml", std::string(k_hourglass) + k_materials);
    call({"run", "hourglass.toml", "-o", "hourglass"});
    const double poured = json_of("hourglass/room.json").at("bed").at("poured_kg").get<double>();
    EXPECT_NEAR(json_of("hourglass/report/measures.json").at("sand").at("value").get<double>(), poured, 0.05 * poured);
    // Its lower face stops at 0.085 m, below the sand's top: 400 grains fill the cone, 27 cm3, and a centimetre and a half above it.
    EXPECT_GT(json_of("hourglass/report/measures.json").at("pressed").at("value").get<double>(), 0.0);

    std::string sheltered = std::string(k_sheltered_bed) + k_materials;
    write_file(folder_ / "sheltered.toml", sheltered.replace(sheltered.find("= 828"), 5, "= 1100"));
    call({"run", "sheltered.toml", "-o", "sheltered"});
    EXPECT_GT(json_of("sheltered/report/measures.json").at("lifted").at("value").get<double>(), 0.0);
    const postproc::Table balance = postproc::read_joined_table(folder_ / "sheltered", "balance", "balance.csv",
                                                                {{"time_s", "outlet_flow_m3_s", "momentum_error"}, {}, {}, ""});
    const double bore = k_pi * 0.019 * 0.019;
    for (std::size_t n = 0; n < balance.rows(); ++n) {  // 0.4 m/s until 0.1 s, and 0.9 m/s from 0.2 s on
        const double time = balance.number("time_s")[n], speed = 0.4 + 0.5 * std::clamp((time - 0.1) / 0.1, 0.0, 1.0);
        if (time > 0.05) EXPECT_NEAR(balance.number("outlet_flow_m3_s")[n], speed * bore, 1e-6 * bore) << time;
    }
    EXPECT_LE(largest(balance.number("momentum_error")), 1e-5);
}

/// A plate goes up by its table and down by an event, and its grain with it: both times through a gate.
const char* const k_lift = R"(
name = "a grain on a lift"
[scene]
kind = "room"
[room]
size_m = [0.02, 0.02, 0.08]
[[solid]]
name = "plate"
generate = "box"
lower_m = [-0.0099, -0.0099, 0.005]
upper_m = [0.0099, 0.0099, 0.010]
velocity_m_s = [0, 0, 0.1]
from_s = 0
to_s = 0.2
[[event]]
do = "move"
solid = "plate"
velocity_m_s = [0, 0, -0.05]
from_s = 0.3
to_s = 0.5
[[prepare]]
do = "pour"
grains = "grains"
count = 1
region = { box = { lower_m = [-0.008, -0.008, 0.01], upper_m = [0.008, 0.008, 0.03] } }
[[measure]]
name = "rides"
what = "passed_mass"
gate = { disc_m = [0, 0, 0.0275], radius_m = 0.01 }
[run]
end_s = 0.6
write_interval_s = 0.1
)";

TEST_F(RoomRuns, a_solid_moves_several_times) {
    std::string study = std::string(k_lift) + k_materials;
    const std::string sizes = "{ uniform_by_number = [0.0045, 0.0055] }";
    write_file(folder_ / "lift.toml", study.replace(study.find(sizes), sizes.size(), "0.005"));
    call({"run", "lift.toml", "-o", "lift"});
    const postproc::Table rides =
        postproc::read_joined_table(folder_ / "lift", "rock", "gates.csv", {{"time_s", "vz_m_s"}, {"gate"}, {}, ""});
    ASSERT_EQ(rides.rows(), 2u);
    // The centre begins at 12.5 mm and meets the gate after 15 mm on the way up, and after 5 mm on the way down.
    EXPECT_NEAR(rides.number("time_s")[0], 0.15, 2e-3);
    EXPECT_NEAR(rides.number("vz_m_s")[0], 0.1, 2e-3);
    EXPECT_NEAR(rides.number("time_s")[1], 0.4, 2e-3);
    EXPECT_NEAR(rides.number("vz_m_s")[1], -0.05, 2e-3);
    EXPECT_NE(read_file(folder_ / "lift/report/index.html").find("moves from 0 to 0.2 s; moves from 0.3 to 0.5 s"), std::string::npos);
}

/// 5/7 g (sin - rolling cos) moves the sphere of the example by 12 mm in a second at 11.5 degrees, and not at all below 11.31.
TEST_F(RoomRuns, sweep_over_the_tilt_finds_where_a_sphere_begins_to_roll) {
    const std::string study = (fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples/plate/study.toml").string();
    call({"sweep", study, "--set", "room.tilt_deg=11.25,11.5", "-o", "tilt"});
    const double mass = 828.0 * k_pi / 6.0 * 6.4e-8;
    EXPECT_EQ(json_of("tilt/study_tilt_deg_11.25/report/measures.json").at("moved").at("value").get<double>(), 0.0);
    EXPECT_NEAR(json_of("tilt/study_tilt_deg_11.5/report/measures.json").at("moved").at("value").get<double>(), mass, 1e-6 * mass);
    // One of them made the bed, the other took it.
    EXPECT_NE(fs::exists(folder_ / "tilt/study_tilt_deg_11.25/bed/1"), fs::exists(folder_ / "tilt/study_tilt_deg_11.5/bed/1"));
    EXPECT_TRUE(fs::exists(folder_ / "tilt/comparison/comparison.json"));
}

/// A closed room of still water, into which a grain is fed.
const char* const k_still_water = R"(
name = "a grain in still water"
[scene]
kind = "room"
[room]
size_m = [0.12, 0.12, 0.30]
medium = "water"
cell_m = 0.012
turbulence = "laminar"
[[material]]
name = "quartz"
youngs_modulus_pa = 5e6
[[contact]]
pair = ["quartz", "quartz"]
friction = 0.5
restitution = 0.6
[[contact]]
pair = ["quartz", "steel"]
friction = 0.3
restitution = 0.6
[[grains]]
name = "grains"
material = "quartz"
density_kg_m3 = 2650
diameter_m = 0.005
[[event]]
do = "feed"
grains = "grains"
from_s = 0
to_s = 0.01
rate_kg_s = 0.0174
region = { box = { lower_m = [-0.02, -0.02, 0.285], upper_m = [0.02, 0.02, 0.30] } }
[[measure]]
name = "fallen"
what = "passed_mass"
gate = { disc_m = [0, 0, 0.06], radius_m = 0.06, normal = [0, 0, -1] }
[run]
end_s = 0.7
write_interval_s = 0.35
)";

/// After 44 diameters a grain falls at the terminal speed of its force balance but for exp(-12) of it. The room is 24 diameters wide.
TEST_F(RoomRuns, a_grain_in_still_water_falls_at_its_terminal_speed) {
    write_file(folder_ / "water.toml", k_still_water);
    EXPECT_NE(call({"check", "water.toml"}).find("mesh of 2500 cells"), std::string::npos);
    call({"run", "water.toml", "-o", "water"});
    const postproc::Table crossings =
        postproc::read_joined_table(folder_ / "water", "rock", "gates.csv", {{"time_s", "vz_m_s"}, {"gate"}, {}, ""});
    const postproc::Table balance = postproc::read_joined_table(
        folder_ / "water", "balance", "balance.csv",
        {{"time_s", "solid_volume_error", "momentum_error", "continuity_error", "rocks", "outlet_flow_m3_s", "outlet_pressure_m2_s2"},
         {},
         {"outlet_flow_m3_s", "outlet_pressure_m2_s2"},
         ""});
    physics::SettlingRock grain;
    grain.rock = {0.005, 1000.0, 1e-6, 1.0, 1.0};
    grain.density = 2650.0;
    const double terminal = physics::terminal_slip_speed(grain);
    ASSERT_EQ(crossings.rows(), 1u);
    EXPECT_NEAR(-crossings.number("vz_m_s").front(), terminal, 0.02 * terminal);
    EXPECT_LE(largest(balance.number("solid_volume_error")), 1e-10);
    EXPECT_LE(largest(balance.number("momentum_error")), 1e-5);
    EXPECT_LE(largest(balance.number("continuity_error")), 1e-6);
    EXPECT_EQ(balance.number("rocks").back(), 1.0);
    EXPECT_TRUE(json_of("water/report/results.json").at("finished").get<bool>());
    EXPECT_TRUE(json_of("water/mesh.json").at("gates").at(0).at("passed").get<bool>());
}

/// A tube hangs over a bed in a pool whose sides are open above the bed, and water is drawn through it.
const char* const k_riser = R"(
name = "a riser over a bed"
[scene]
kind = "room"
[room]
size_m = [0.20, 0.20, 0.20]
medium = "water"
cell_m = 0.02
[[room.refine]]
cylinder = { from_m = [0, 0, 0.0], to_m = [0, 0, 0.2], radius_m = 0.045 }
cell_m = 0.01
[[solid]]
name = "riser"
generate = "tube"
from_m = [0, 0, 0.04]
to_m = [0, 0, 0.20]
inner_radius_m = 0.025
wall_m = 0.01
[[boundary]]
on = "top"
inside = "riser"
flow = { outflow_m_s = 1.0, ramp_s = 0.1 }
[[boundary]]
on = "sides"
above_m = 0.03
flow = "pressure"
[[prepare]]
do = "pour"
grains = "grains"
count = 300
region = { box = { lower_m = [-0.04, -0.04, 0], upper_m = [0.04, 0.04, 0.038] } }
[[measure]]
name = "lifted"
what = "passed_mass"
gate = { disc_m = [0, 0, 0.10], radius_m = 0.025 }
[run]
end_s = 0.8
write_interval_s = 0.4
)";

/// 1 m/s in a pipe lifts grains that fall at some 0.06 m/s; its discharge is speed times area, and its mesh has the tube.
TEST_F(RoomRuns, water_that_is_drawn_through_a_tube_lifts_grains) {
    write_file(folder_ / "riser.toml", std::string(k_riser) + k_materials);
    std::string study = read_file(folder_ / "riser.toml");
    study.replace(study.find("density_kg_m3 = 828"), 19, "density_kg_m3 = 1050");
    write_file(folder_ / "riser.toml", study);
    for (const int ranks : {1, 2}) {
        if (ranks > cases::available_cores()) continue;
        const std::string run = fmt::format("riser_{}", ranks);
        call({"run", "riser.toml", "-o", run, "--ranks", std::to_string(ranks)});
        EXPECT_EQ(fs::exists(folder_ / run / "processor1"), ranks == 2);
        const double poured = json_of(run + "/room.json").at("bed").at("poured_kg").get<double>();
        EXPECT_GT(json_of(run + "/report/measures.json").at("lifted").at("value").get<double>(), 0.01 * poured) << ranks;
        const postproc::Table balance = postproc::read_joined_table(folder_ / run, "balance", "balance.csv",
                                                                    {{"time_s", "outlet_flow_m3_s", "momentum_error"}, {}, {}, ""});
        EXPECT_NEAR(balance.number("outlet_flow_m3_s").back(), k_pi * 0.025 * 0.025, 1e-6 * k_pi * 0.025 * 0.025) << ranks;
        EXPECT_LE(largest(balance.number("momentum_error")), 1e-5) << ranks;
        const double overlap = json_of(run + "/report/results.json").at("largest_overlap").get<double>();
        EXPECT_GT(overlap, 0.0) << ranks;
        EXPECT_LT(overlap, 0.1) << ranks;
    }
}

/// A run that the user stops goes on from the step at which it was stopped, not from its last checkpoint.
TEST_F(RoomRuns, a_stopped_run_keeps_what_it_has_computed) {
    write_file(folder_ / "riser.toml", std::string(k_riser) + "checkpoint_interval_s = 0.7\n" + k_materials);
    const fs::path pictures = folder_ / "riser/postProcessing/rock/vtk";
    std::thread user([&] {
        for (int i = 0; i < 6000 && !fs::exists(pictures / "rocks_0.4.vtp"); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        ::kill(::getpid(), SIGTERM);
    });
    EXPECT_THROW(call({"run", "riser.toml", "-o", "riser"}), Interrupted);
    user.join();
    const std::string said = read_file(folder_ / "output");
    EXPECT_NE(said.find("stopping at the end of this step"), std::string::npos) << said;
    EXPECT_NE(said.find("resume with: cutterflow run riser.toml -o riser --resume"), std::string::npos) << said;
    const double kept = std::stod(newest_checkpoint(folder_ / "riser").filename().string());
    EXPECT_GE(kept, 0.4);
    EXPECT_LT(kept, 0.7);
    for (const char* command : {"measure", "report"})
        EXPECT_NE(call({command, "riser"}).find("warning: riser is not finished: it has come to 0."), std::string::npos) << command;
    call({"run", "riser.toml", "-o", "riser", "--resume"});
    const postproc::Table balance =
        postproc::read_joined_table(folder_ / "riser", "balance", "balance.csv", {{"time_s", "momentum_error"}, {}, {}, ""});
    EXPECT_NEAR(balance.number("time_s").back(), 0.8, 1e-6);
    EXPECT_TRUE(fs::exists(folder_ / fmt::format("riser/postProcessing/balance/{:g}", kept)));
    EXPECT_LE(largest(balance.number("momentum_error")), 1e-5);
}

TEST_F(RoomRuns, commands_refuse_what_rooms_have_no_use_for) {
    call({"new", "room.toml", "--kind", "room"});
    EXPECT_NE(call({"new", "cut.toml", "--kind", "room", "--cutter", "a.stl"}, 2).find("Such a study has no cutter"), std::string::npos);
    EXPECT_NE(call({"run", "room.toml", "--ranks", "2"}, 2).find("run on one core"), std::string::npos);
    EXPECT_NE(call({"sweep", "room.toml", "--rpm", "30"}, 2).find("--rpm in a sweep of a room. It belongs to cutters"), std::string::npos);
    EXPECT_NE(call({"params", "--kind", "room"}).find("[[solid]]"), std::string::npos);
    write_file(folder_ / "typo.toml", "[scene]\nkind = \"rooom\"\n");
    EXPECT_NE(call({"check", "typo.toml"}, 2).find("Did you mean \"room\"?"), std::string::npos);
}

}  // namespace
