#include "cases/runner/run_progress.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

#include "geometry/base/file_content.hpp"

using namespace cutterflow;
using namespace cutterflow::cases;
namespace fs = std::filesystem;

TEST(RunProgress, reads_the_simulated_time_from_openfoams_log_lines_alone) {
    EXPECT_EQ(simulated_time("Time = 0.125"), 0.125);
    EXPECT_EQ(simulated_time("Time = 1e-05"), 1e-5);
    EXPECT_EQ(simulated_time("Time = 2s"), 2.0);
    EXPECT_FALSE(simulated_time("ExecutionTime = 3 s  ClockTime = 4 s").has_value());
    EXPECT_FALSE(simulated_time("Time = now").has_value());
    EXPECT_FALSE(simulated_time("").has_value());
}

TEST(RunProgress, logs_of_earlier_attempts_are_kept) {
    std::string name = (fs::temp_directory_path() / "cutterflow_log_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    const fs::path log = fs::path(name) / "log.cutterFoam";
    keep_older_log(log);
    write_file(log, "first");
    keep_older_log(log);
    write_file(log, "second");
    keep_older_log(log);
    EXPECT_FALSE(fs::exists(log));
    EXPECT_EQ(read_file(log.string() + ".1"), "first");
    EXPECT_EQ(read_file(log.string() + ".2"), "second");
    fs::remove_all(name);
}
