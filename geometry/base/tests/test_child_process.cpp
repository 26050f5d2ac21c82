#include "geometry/base/process/child_process.hpp"

#include <csignal>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"

using namespace cutterflow;
namespace fs = std::filesystem;

namespace {

class ChildProcess : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "cutterflow_child_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }
    ChildCommand script(const std::string& text) const { return {{"sh", "-c", text}, folder_, folder_ / "log.sh", {}}; }
    fs::path folder_;
};

}  // namespace

TEST_F(ChildProcess, hands_arguments_over_as_they_are) {
    std::vector<std::string> lines;
    const ChildResult result = run_child({{"printf", "%s|", "$HOME; rm -rf *", "a 'b' \"c\"", ""}, {}, folder_ / "log", {}},
                                         [&](const std::string& line) { lines.push_back(line); });
    EXPECT_EQ(result.exit_code, 0);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0], "$HOME; rm -rf *|a 'b' \"c\"||");
    EXPECT_EQ(read_file(folder_ / "log"), lines[0]);
}

TEST_F(ChildProcess, keeps_both_streams_in_the_log_and_hands_lines_over_while_it_runs) {
    std::vector<std::string> lines;
    // The child waits for a file that is made when its first line arrives: lines come while it runs, or this never ends.
    const ChildResult result =
        run_child(script("echo one; while [ ! -e seen ]; do sleep 0.01; done; echo two >&2; printf three"), [&](const std::string& line) {
            lines.push_back(line);
            write_file(folder_ / "seen", "");
        });
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(lines, (std::vector<std::string>{"one", "two", "three"}));
    EXPECT_EQ(read_file(folder_ / "log.sh"), "one\ntwo\nthree");
}

TEST_F(ChildProcess, runs_in_its_folder_with_the_added_environment_and_no_input) {
    ChildCommand command = script("pwd; echo \"$CUTTERFLOW_TEST_VALUE\"; cat; echo end");
    command.environment["CUTTERFLOW_TEST_VALUE"] = "a b";
    ::setenv("CUTTERFLOW_TEST_VALUE", "from outside", 1);
    run_child(command);
    EXPECT_EQ(read_file(folder_ / "log.sh"), fs::canonical(folder_).string() + "\na b\nend\n");
}

TEST_F(ChildProcess, reports_exit_codes_signals_and_core_seconds) {
    EXPECT_EQ(run_child(script("exit 7")).exit_code, 7);
    EXPECT_EQ(run_child(script("kill -KILL $$")).exit_code, 128 + SIGKILL);
    const ChildResult busy = run_child(script("i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done"));
    EXPECT_GT(busy.core_s, 0.01);
    EXPECT_LT(busy.core_s, busy.wall_s + 0.1);
    const ChildResult idle = run_child(script("sleep 0.3"));
    EXPECT_GE(idle.wall_s, 0.3);
    EXPECT_LT(idle.core_s, 0.15);
}

TEST_F(ChildProcess, explains_a_failure_with_the_end_of_the_log) {
    try {
        require_child(script("echo first; echo the reason; exit 3"));
        FAIL() << "exit code 3 was accepted";
    } catch (const ToolError& error) {
        const std::string text = error.what();
        EXPECT_EQ(error.code(), ExitCode::external_program);
        EXPECT_NE(text.find("exit code 3"), std::string::npos) << text;
        EXPECT_NE(text.find("the reason"), std::string::npos) << text;
        EXPECT_NE(text.find((folder_ / "log.sh").string()), std::string::npos) << text;
    }
}

TEST_F(ChildProcess, names_the_package_of_a_missing_program) {
    const std::string path = std::getenv("PATH");
    ::setenv("PATH", folder_.c_str(), 1);
    try {
        run_child({{"snappyHexMesh"}, {}, folder_ / "log", {}});
        FAIL() << "a missing program was started";
    } catch (const ToolError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("snappyHexMesh was not found"), std::string::npos) << text;
        EXPECT_NE(text.find("package openfoam"), std::string::npos) << text;
        EXPECT_NE(text.find("./bootstrap"), std::string::npos) << text;
    }
    EXPECT_THROW(run_child({{(folder_ / "cutterFoam").string()}, {}, folder_ / "log", {}}), ToolError);
    ::setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(find_program("no-such-program-anywhere"), fs::path());
    EXPECT_EQ(find_program("sh").filename(), "sh");
    EXPECT_THROW(run_child({{"sh", "-c", "true"}, folder_ / "missing", folder_ / "log", {}}), ToolError);
}

TEST_F(ChildProcess, skips_folders_of_path_that_cannot_be_looked_into) {
    const std::string path = std::getenv("PATH");
    fs::create_symlink("loop", folder_ / "loop");
    ::setenv("PATH", ((folder_ / "loop").string() + ":" + std::string(5000, 'x') + ":" + path).c_str(), 1);
    EXPECT_NO_THROW(EXPECT_EQ(find_program("sh").filename(), "sh"));
    EXPECT_NO_THROW(EXPECT_EQ(find_program("no-such-program-anywhere"), fs::path()));
    ::setenv("PATH", path.c_str(), 1);
}

TEST_F(ChildProcess, passes_a_stop_signal_on_and_waits_for_the_child) {
    for (const int number : {SIGINT, SIGTERM}) {
        const ChildCommand command = script("trap 'echo stopped; exit 0' INT TERM; echo ready; while :; do sleep 0.05; done");
        EXPECT_THROW(run_child(command,
                               [&](const std::string& line) {
                                   if (line == "ready") std::raise(number);
                               }),
                     Interrupted);
        EXPECT_EQ(read_file(folder_ / "log.sh"), "ready\nstopped\n");
    }
    EXPECT_EQ(run_child(script("true")).exit_code, 0) << "a later child is not stopped by an earlier signal";
}

TEST_F(ChildProcess, asks_a_child_with_a_first_stop_signal_once) {
    ChildCommand command = script("trap 'echo asked' USR1; trap 'echo stopped; exit 0' TERM; echo ready; while :; do sleep 0.05; done");
    command.first_stop_signal = SIGUSR1;
    EXPECT_THROW(run_child(command,
                           [&](const std::string& line) {
                               if (line != "stopped") std::raise(SIGTERM);
                           }),
                 Interrupted);
    EXPECT_EQ(read_file(folder_ / "log.sh"), "ready\nasked\nstopped\n");
}

TEST_F(ChildProcess, ends_the_child_when_the_callback_throws) {
    const ChildCommand command = script("trap 'echo gone > ended; exit 0' TERM; echo ready; while :; do sleep 0.05; done");
    EXPECT_THROW(run_child(command, [](const std::string&) { throw std::runtime_error("no"); }), std::runtime_error);
    EXPECT_TRUE(fs::exists(folder_ / "ended"));
}
