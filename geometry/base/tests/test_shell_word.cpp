#include "geometry/base/process/shell_word.hpp"

#include <gtest/gtest.h>

#include "geometry/base/process/child_process.hpp"

namespace cutterflow {
namespace {

TEST(ShellWord, is_bare_where_it_can_be) {
    EXPECT_EQ(shell_word("runs/60rpm_0.12m3_s"), "runs/60rpm_0.12m3_s");
    EXPECT_EQ(shell_word("a b.toml"), "'a b.toml'");
    EXPECT_EQ(shell_word(""), "''");
}

TEST(ShellWord, comes_back_from_a_shell_as_it_was) {
    for (const std::string text : {"it's.toml", "$HOME", "a\\b", "*", "~", "a;b", "\"", "ä", "#1"}) {
        std::string seen;
        run_child({{"sh", "-c", "printf '%s\\n' " + shell_word(text)}, {}, {}, {}}, [&](const std::string& line) { seen = line; });
        EXPECT_EQ(seen, text);
    }
}

}  // namespace
}  // namespace cutterflow
