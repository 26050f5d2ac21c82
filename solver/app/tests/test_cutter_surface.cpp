/// cutterSurface as a user starts it: what it refuses, and what stays of a run that breaks off.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/process/child_process.hpp"

namespace {

using namespace cutterflow;
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string scene(const std::string& more) {
    return "[domain]\nwidth_m = 0.1\nheight_m = 0.1\ncell_m = 0.002\n"
           "[[fill]]\nfrom_x_m = 0.0\nfrom_z_m = 0.0\nto_x_m = 0.1\nto_z_m = 0.02\n"
           "[run]\nend_s = 0.01\nwrite_interval_s = 0.002\ncheckpoint_interval_s = 0.001\n" +
           more;
}

class CutterSurface : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ =
            fs::path(CUTTERFLOW_BUILD_DIR) / "tests" / "cutter_surface" / ::testing::UnitTest::GetInstance()->current_test_info()->name();
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    int start(const std::string& text, const std::vector<std::string>& options = {}) {
        write_file(folder_ / "scene.toml", text);
        std::vector<std::string> arguments{program(), folder_.string()};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const fs::path log = folder_ / "log";
        const int code = run_child({arguments, folder_, log, {}}).exit_code;
        output_ = read_file(log);
        return code;
    }
    std::string program() const { return (fs::path(CUTTERFLOW_BUILD_DIR) / "bin" / "cutterSurface").string(); }
    /// Starts the scene of the folder, and sends a signal when it has a checkpoint.
    int send(const std::string& signal) {
        const std::string wait = "for n in $(seq 500); do ls checkpoints/*[0-9] 2> /dev/null && break; sleep 0.02; done";
        const std::string script = fmt::format("'{}' . & p=$!; {}; kill -{} $p; wait $p", program(), wait, signal);
        const fs::path log = folder_ / "log";
        const int code = run_child({{"sh", "-c", script}, folder_, log, {}}).exit_code;
        output_ = read_file(log);
        return code;
    }
    /// Time [s] of the newest checkpoint.
    double kept() const { return std::stod(newest_checkpoint(folder_).filename().string()); }
    /// Time [s] of the last whole row of a table of the process that began at 0.
    double last_row(const std::string& name) const {
        std::string text = read_file(folder_ / "postProcessing" / name / "0" / (name + ".csv"));
        text.erase(text.rfind('\n'));
        return std::stod(text.substr(text.rfind('\n') + 1));
    }
    int checkpoints() const {
        int count = 0;
        if (!fs::exists(folder_ / "checkpoints")) return 0;
        for (const auto& entry : fs::directory_iterator(folder_ / "checkpoints")) count += entry.path().extension() != ".part";
        return count;
    }

    fs::path folder_;
    std::string output_;
};

/// A body that is shot into shallow water: the run breaks off after its first checkpoints.
TEST_F(CutterSurface, ends_with_4_names_time_and_place_and_keeps_the_last_checkpoint) {
    write_file(folder_ / "shot.csv", "x_m,z_m,vz_m_s\n0.05,0.085,-60\n");
    const std::string shot = scene("[[bodies]]\ndiameter_m = 0.02\nfile = \"shot.csv\"\n");
    std::string small = shot;
    small.replace(small.find("checkpoint_interval_s = 0.001"), 29, "checkpoint_interval_s = 2e-4");
    EXPECT_EQ(start(small), 4) << output_;
    EXPECT_THAT(output_, ::testing::ContainsRegex("near \\(.*, .*\\) m at .* s, in a step of"));
    EXPECT_GT(checkpoints(), 0);
}

TEST_F(CutterSurface, refuses_a_folder_with_a_run_of_another_scene_and_one_that_began) {
    ASSERT_EQ(start(scene("")), 0) << output_;
    const int written = checkpoints();
    EXPECT_EQ(start(scene("")), 2);
    EXPECT_THAT(output_, AllOf(HasSubstr("holds a run already"), HasSubstr("--resume")));
    for (const auto& options : {std::vector<std::string>{}, std::vector<std::string>{"--resume"}}) {
        EXPECT_EQ(start(scene("[water]\ndensity_kg_m3 = 1025.0\n"), options), 2);
        EXPECT_THAT(output_, AllOf(HasSubstr("holds a run of another scene"), HasSubstr("Take a new folder")));
    }
    EXPECT_EQ(checkpoints(), written);
}

TEST_F(CutterSurface, refuses_to_resume_where_nothing_ran) {
    EXPECT_EQ(start(scene(""), {"--resume"}), 2);
    EXPECT_THAT(output_, HasSubstr("has no run to go on with"));
    EXPECT_EQ(checkpoints(), 0);
}

/// A body beside a solid whose surface is an OBJ, in a folder that holds a file as a user might call it.
TEST_F(CutterSurface, lets_bodies_bump_into_a_surface_of_any_format_and_overwrites_no_file) {
    const std::string block =
        "v 0.06 0.002 0.001\nv 0.09 0.002 0.001\nv 0.09 0.008 0.001\nv 0.06 0.008 0.001\n"
        "v 0.06 0.002 0.03\nv 0.09 0.002 0.03\nv 0.09 0.008 0.03\nv 0.06 0.008 0.03\n"
        "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";
    write_file(folder_ / "solids.obj", block);
    write_file(folder_ / "walls.stl", "the user's own");
    std::string space = scene(
        "[[solid]]\nkind = \"surface\"\nfile = \"solids.obj\"\n"
        "[[bodies]]\nshape = \"sphere\"\ndiameter_m = 0.01\ncentre_x_m = 0.03\ncentre_y_m = 0.0075\nlowest_m = 0.03\n");
    space.replace(space.find("cell_m"), 6, "dimensions = \"space\"\nlength_m = 0.015\ncell_m");
    space.replace(space.find("end_s = 0.01"), 12, "end_s = 0.002");
    EXPECT_EQ(start(space), 0) << output_;
    EXPECT_TRUE(fs::exists(folder_ / "walls_of_bodies" / "solids.stl"));
    EXPECT_EQ(read_file(folder_ / "walls.stl"), "the user's own");
}

/// A body that starts at the right wall's side ends the run after a while of settling, whether it is stopped in it or not.
TEST_F(CutterSurface, ends_when_it_would_have_after_a_resume) {
    write_file(folder_ / "near.csv", "x_m,z_m,vx_m_s\n0.088,0.05,1.0\n");
    const std::string text = scene("settle_s = 0.004\nstop_when = \"arrival\"\n[[bodies]]\ndiameter_m = 0.02\nfile = \"near.csv\"\n");
    std::string longer = text;
    longer.replace(longer.find("end_s = 0.01"), 12, "end_s = 0.05");
    ASSERT_EQ(start(longer), 0) << output_;
    const fs::path ends = folder_ / "ends_at_s";
    ASSERT_TRUE(fs::exists(ends)) << output_;
    const double end = std::stod(read_file(ends));
    EXPECT_LT(end, 0.02);
    ASSERT_EQ(start(longer, {"--resume"}), 0) << output_;
    double last = 0.0;
    for (const auto& entry : fs::directory_iterator(folder_ / "checkpoints"))
        last = std::max(last, std::stod(entry.path().filename().string()));
    EXPECT_NEAR(last, end, 1e-9) << "a finished run is not made longer";
}

std::string long_scene() {
    std::string text = scene("");
    return text.replace(text.find("end_s = 0.01\nwrite_interval_s = 0.002"), 37, "end_s = 5\nwrite_interval_s = 2");
}

TEST_F(CutterSurface, ends_its_step_and_keeps_rows_and_state_when_it_is_asked_to_stop) {
    write_file(folder_ / "scene.toml", long_scene());
    for (const char* number : {"USR1", "TERM"}) {
        fs::remove_all(folder_ / "checkpoints");
        fs::remove(folder_ / "scene.started.toml");
        EXPECT_EQ(send(number), 130) << number;
        EXPECT_THAT(output_, HasSubstr(fmt::format("stopped on request at {:.9g} s", last_row("balance")))) << number;
        EXPECT_NEAR(kept(), last_row("balance"), 1e-7) << number;
        EXPECT_NEAR(kept(), last_row("levels"), 1e-7) << number;
    }
}

/// A resumed run begins at the checkpoint: rows before it are written by the process that was killed, or never.
TEST_F(CutterSurface, has_the_rows_up_to_its_checkpoint_in_the_files_when_it_is_killed) {
    write_file(folder_ / "scene.toml", long_scene());
    send("KILL");
    EXPECT_GE(last_row("balance"), kept() - 1e-7);
    EXPECT_GE(last_row("levels"), kept() - 1e-7);
}

}  // namespace
