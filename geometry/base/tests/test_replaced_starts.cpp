#include "geometry/base/statistics/replaced_starts.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"

namespace cutterflow {
namespace {

namespace fs = std::filesystem;

class ReplacedStarts : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "cutterflow_starts_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        run_ = name;
    }
    void TearDown() override { fs::remove_all(run_); }

    fs::path start(const std::string& name) const { return run_ / "postProcessing/cost" / name; }

    fs::path run_;
};

TEST_F(ReplacedStarts, cost_their_own_processor_time_or_the_wall_time_of_their_steps_on_all_ranks) {
    write_file(start("0") / "cost.csv", "time_s,step_s,fluid_s\n0.1,2,1\n0.2,3.5,1\n0.3,4");
    write_file(start("0.25") / "cost.csv", "time_s,step_s,fluid_s\n0.3,100,1\n");
    write_file(start("0.25") / "cost.json", R"({"ranks": 4, "core_s": 60.5})");
    note_replaced_start(run_, start("0"), 4);
    note_replaced_start(run_, start("0.25"), 4);
    EXPECT_EQ(read_file(run_ / "replaced_starts.csv"), "start_s,core_s\n0,22\n0.25,60.5\n") << "a step that was cut off is not counted";
    EXPECT_NEAR(replaced_core_seconds(run_), 4 * 5.5 + 60.5, 1e-12);
}

TEST_F(ReplacedStarts, that_made_no_step_or_wrote_nothing_are_not_noted) {
    write_file(start("0") / "cost.csv", "time_s,step_s,fluid_s\n");
    write_file(start("1") / "cost.csv", "");
    write_file(start("1") / "cost.json", "{\"core_s\"");
    for (const char* name : {"0", "1", "2"}) note_replaced_start(run_, start(name), 4);
    EXPECT_FALSE(fs::exists(run_ / "replaced_starts.csv"));
    EXPECT_EQ(replaced_core_seconds(run_), 0.0);
}

TEST_F(ReplacedStarts, are_refused_when_their_file_is_damaged) {
    write_file(run_ / "replaced_starts.csv", "start_s,core_s\n0,many\n");
    EXPECT_THROW(replaced_core_seconds(run_), UserError);
}

}  // namespace
}  // namespace cutterflow
