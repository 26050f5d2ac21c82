/// cutterSurface as a user starts it: what it refuses, and what stays of a run that breaks off.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
        std::vector<std::string> arguments{(fs::path(CUTTERFLOW_BUILD_DIR) / "bin" / "cutterSurface").string(), folder_.string()};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const fs::path log = folder_ / "log";
        const int code = run_child({arguments, folder_, log, {}}).exit_code;
        output_ = read_file(log);
        return code;
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

}  // namespace
