/// cutterFoam on a case that a user wrote by hand: it finds OpenFOAM without an environment, deletes no time folder, applies fvOptions as
/// pimpleFoam does, and refuses by name what it does not support.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cases/testing/tiny_rotor_mesh.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "meshing/dictionary/foam_command.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/rotor_case.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// Three steps of the small rotor.
fs::path rotor(const std::string& name, bool with_rock = false) {
    const fs::path folder = scratch_folder(name);
    cases::CaseInputs inputs = cases::test::tiny_inputs();
    if (with_rock) {
        inputs.rock.emplace();
        coupling::use_preset(inputs.rock->contact, coupling::k_paper_pairs);
    }
    write_rotor_case(folder, inputs, "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n1,0,0,0.18,-0.1,0.02,2650\n");
    std::ofstream(folder / "system/controlDict", std::ios::app) << R"(
endTime 0.006; deltaT 2e-3; adjustTimeStep no; writeControl timeStep; writeInterval 1000;
functions
{
    mean
    {
        type volFieldValue; libs (fieldFunctionObjects); writeControl timeStep; writeFields no; regionType all; operation volAverage;
        fields (U k);
    }
}
)";
    return folder;
}

void write_dictionary(const fs::path& file, const std::string& body) {
    std::ofstream(file) << fmt::format("FoamFile {{ version 2.0; format ascii; class dictionary; object {}; }}\n{}\n",
                                       file.filename().string(), body);
}

struct Ended {
    int code;
    std::string said;
};

/// Runs a command in the case, with everything that it said.
Ended run_as_user(const fs::path& folder, const std::vector<std::string>& arguments, int ranks = 1) {
    const ChildCommand command = meshing::foam_command(folder, arguments.front(), {arguments.begin() + 1, arguments.end()}, ranks);
    const int code = run_child(command).exit_code;
    return {code, read_file(command.log)};
}

TEST(HandWrittenCase, runs_without_an_environment) {
    const Ended ended = run_as_user(rotor("hand_no_environment"), {"env", "-u", "WM_PROJECT_DIR", cutter_foam()});
    EXPECT_EQ(ended.code, 0) << ended.said;
    EXPECT_THAT(ended.said, HasSubstr("Time = 0.006"));
}

TEST(HandWrittenCase, is_refused_in_the_environment_of_another_version) {
    const fs::path folder = rotor("hand_other_version");
    const Ended ended = run_as_user(folder, {"env", "WM_PROJECT_VERSION=v2312", cutter_foam()});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.said, HasSubstr("v2312"));

    const fs::path other = folder / "other";
    fs::create_directories(other / "META-INFO");
    fs::copy("/usr/share/openfoam/etc", other / "etc", fs::copy_options::recursive);
    std::ofstream(other / "META-INFO/api-info") << "api=2206\npatch=0\n";
    const Ended of_folder = run_as_user(folder, {"env", "WM_PROJECT_DIR=" + other.string(), cutter_foam()});
    EXPECT_EQ(of_folder.code, 2);
    EXPECT_THAT(of_folder.said, HasSubstr("2206"));
}

TEST(HandWrittenCase, keeps_time_folders_that_are_later_than_a_checkpoint) {
    const fs::path folder = rotor("hand_time_folders");
    fs::create_directories(folder / names::checkpoints / "0.002");
    fs::create_directories(folder / "0.004");
    std::ofstream(folder / "0.004/U") << "the user's";
    const Ended ended = run_as_user(folder, {cutter_foam()});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.said, HasSubstr((folder / "0.004").string()));
    EXPECT_THAT(ended.said, HasSubstr("startTime 0.002"));
    EXPECT_EQ(read_file(folder / "0.004/U"), "the user's");
}

std::vector<double> last_means(const fs::path& folder) {
    std::ifstream stream(folder / "postProcessing/mean/0/volFieldValue.dat");
    std::string last;
    for (std::string line; std::getline(stream, line);) last = line;
    for (char& c : last)
        if (c == '(' || c == ')') c = ' ';
    std::istringstream numbers(last);
    return {std::istream_iterator<double>(numbers), {}};
}

TEST(HandWrittenCase, takes_sources_as_pimple_foam_does) {
    const char* const sources = R"(
push { type vectorSemiImplicitSource; selectionMode all; volumeMode specific; injectionRateSuSp { U ((3 2 0) 0); } }
drive
{
    type meanVelocityForce; selectionMode cellZone; cellZone stator; fields (U); Ubar (0.05 0 0); relaxation 1;
}
stir { type scalarSemiImplicitSource; selectionMode all; volumeMode specific; injectionRateSuSp { k (0.5 -1); } }
)";
    const fs::path plain = rotor("hand_no_sources"), ours = rotor("hand_sources"), theirs = rotor("hand_sources_pimpleFoam");
    for (const fs::path& folder : {ours, theirs}) write_dictionary(folder / "constant/fvOptions", sources);
    for (const fs::path& folder : {plain, ours}) EXPECT_EQ(run_as_user(folder, {cutter_foam()}).code, 0);
    EXPECT_EQ(run_as_user(theirs, {"pimpleFoam"}).code, 0);
    const std::vector<double> without = last_means(plain), mean = last_means(ours), expected = last_means(theirs);
    ASSERT_EQ(mean.size(), 5u);  // time, U, k
    ASSERT_EQ(expected.size(), 5u);
    for (const std::size_t column : {1u, 2u, 4u}) {
        // Eight faces around the interface, which pimpleFoam couples by means of the other side and we by parts: 2.3e-3 came.
        EXPECT_NEAR(mean[column], expected[column], 3e-3 * std::abs(expected[column])) << column;
        EXPECT_GT(std::abs(mean[column] - without[column]), 0.1 * std::abs(mean[column])) << column << ": the source does nothing";
    }
}

TEST(HandWrittenCase, with_rock_refuses_a_source_of_momentum_by_name) {
    const fs::path folder = rotor("hand_source_with_rock", true);
    write_dictionary(
        folder / "constant/fvOptions",
        "push { type vectorSemiImplicitSource; selectionMode all; volumeMode specific; injectionRateSuSp { U ((3 2 0) 0); } }");
    const Ended ended = run_as_user(folder, {cutter_foam()});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.said, HasSubstr("push of type vectorSemiImplicitSource"));
}

TEST(HandWrittenCase, with_a_rotating_reference_frame_is_refused_by_name) {
    const fs::path folder = rotor("hand_frame");
    write_dictionary(
        folder / "constant/MRFProperties",
        "asleep { active no; cellZone rotor; }\nspinning { cellZone rotor; active yes; origin (0 0 0); axis (0 0 1); omega 6; }");
    const Ended ended = run_as_user(folder, {cutter_foam()});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.said, HasSubstr("spinning"));
    EXPECT_THAT(ended.said, ::testing::Not(HasSubstr("asleep")));
    EXPECT_THAT(ended.said, ::testing::Not(HasSubstr("Time = 0.002")));
}

/// One step of one rock in a closed box of 0.1 m, in two parts.
fs::path box(const std::string& name, BoxCase box = {}) {
    box.lower = Vec3::Zero();
    box.upper = Vec3::Constant(0.1);
    box.cells = {4, 4, 4};
    box.end_time = box.time_step;
    box.rocks = {{1, 0.0, Vec3::Constant(0.05), 0.01}};
    const fs::path folder = scratch_folder(name);
    write_box_case(folder, box);
    decompose(folder, {1, 1, 2});
    return folder;
}

void expect_exit(const fs::path& folder, int code, const std::vector<std::string>& parts) {
    for (const int ranks : {1, 2}) {
        const Ended ended = run_as_user(folder, {cutter_foam()}, ranks);
        EXPECT_EQ(ended.code, code) << ranks << " rank(s): " << ended.said;
        for (const std::string& part : parts) EXPECT_THAT(ended.said, HasSubstr(part)) << ranks << " rank(s)";
    }
}

TEST(ExitCodes, is_0_of_a_run_that_ends) {
    expect_exit(box("exit_done"), 0, {"Time = 0.001"});
}

TEST(ExitCodes, is_2_of_wrong_values_which_are_all_named) {
    BoxCase wrong;
    wrong.kernel = "gamma 0.3; minWidthInCells 9;";
    wrong.closures = "drag brown;";
    expect_exit(box("exit_values", wrong), 2, {"gamma = 0.3", "minWidthInCells = 9", "drag"});
}

TEST(ExitCodes, is_2_of_a_broken_feed_whose_lines_are_all_named) {
    const fs::path folder = box("exit_feed");
    const fs::path feed = folder / "constant/rockFeed.csv";
    std::ofstream(feed) << "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n"
                           "1,0,0.05,0.05,0.05,0.01\n2,0,0.05,0.05,0.05,-0.01,2650\n3,0,0.05,0.05,0.5,0.01,2650\n";
    expect_exit(folder, 2,
                {feed.string() + ":2: 6 fields instead of 7", feed.string() + ":3: diameter_m = -0.01",
                 feed.string() + ":4: rock 3 at (0.05 0.05 0.5) m lies outside rock.domain"});
}

TEST(ExitCodes, is_4_of_rock_outside_the_mesh_within_its_domain) {
    const fs::path folder = box("exit_check");
    const fs::path file = folder / names::coupling_properties;
    std::string text = read_file(file);
    const std::size_t begin = text.find("upper"), end = text.find(';', begin);
    text.replace(begin, end - begin, "upper (0.1 0.1 0.9)");
    std::ofstream(file) << text;
    std::ofstream(folder / "constant/rockFeed.csv") << "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n1,0,0.05,0.05,0.5,0.01,2650\n";
    expect_exit(folder, 4, {"rock 1"});
}

TEST(ExitCodes, is_1_of_options_that_openfoam_refuses) {
    const Ended ended = run_as_user(box("exit_options"), {cutter_foam(), "-nonsense"});
    EXPECT_EQ(ended.code, 1) << ended.said;
}

}  // namespace
}  // namespace cutterflow::validation
