#include "postproc/run/run_table.hpp"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

using testing::fresh_directory;
using testing::write_text;

const TableRules k_rules{{"time_s", "value"}, {}, {}, "Run again"};

TEST(ReadTable, ignores_a_last_line_cut_short) {
    const auto file = fresh_directory("table") / "t.csv";
    // "0.3,1" may be the beginning of "0.3,12": without its newline it does not count.
    write_text(file, "time_s,value\n0.1,10\n0.2,11\n0.3,1");
    const Table table = read_table(file, k_rules);
    ASSERT_EQ(table.rows(), 2u);
    EXPECT_EQ(table.number("value"), (std::vector<double>{10, 11}));
}

TEST(ReadTable, a_table_with_a_header_alone_has_its_columns) {
    const auto file = fresh_directory("table") / "t.csv";
    write_text(file, "time_s,value\n");
    const Table table = read_table(file, k_rules);
    EXPECT_TRUE(table.empty());
    EXPECT_TRUE(table.number("value").empty());
}

TEST(ReadTable, names_file_and_every_missing_column_and_the_remedy) {
    const auto file = fresh_directory("table") / "t.csv";
    write_text(file, "time_s,other\n1,2\n");
    try {
        read_table(file, {{"time_s", "value", "third"}, {}, {}, "Run again"});
        FAIL();
    } catch (const UserError& error) {
        ASSERT_EQ(error.mistakes().size(), 2u);
        const std::string text = error.what();
        EXPECT_NE(text.find(file.string()), std::string::npos);
        EXPECT_NE(text.find("column value is missing"), std::string::npos);
        EXPECT_NE(text.find("column third is missing"), std::string::npos);
        EXPECT_NE(text.find("Run again"), std::string::npos);
    }
}

TEST(ReadTable, refuses_broken_lines_and_fields_by_line_number) {
    const auto file = fresh_directory("table") / "t.csv";
    for (const char* broken : {"0.1\n", "0.1,abc\n", "0.1,nan\n", "0.1,\n", "0.1,2x\n", "0.1,2,3\n"}) {
        write_text(file, std::string("time_s,value\n0.05,1\n") + broken);
        try {
            read_table(file, k_rules);
            FAIL() << broken;
        } catch (const UserError& error) {
            EXPECT_NE(std::string(error.what()).find("t.csv:3"), std::string::npos) << error.what();
        }
    }
}

TEST(ReadTable, refuses_numbers_that_are_not_whole_where_they_must_be) {
    const auto file = fresh_directory("table") / "t.csv";
    const TableRules rules{{"time_s", "value"}, {}, {}, "Run again", {"value"}};
    write_text(file, "time_s,value\n0.05,0\n0.1,2147483647\n");
    EXPECT_EQ(read_table(file, rules).number("value")[1], 2147483647.0);
    for (const char* value : {"-1", "0.5", "2147483648", "1e300"}) {
        write_text(file, fmt::format("time_s,value\n0.05,1\n0.1,{}\n", value));
        EXPECT_THROW(read_table(file, rules), UserError) << value;
        EXPECT_NO_THROW(read_table(file, k_rules));
    }
}

TEST(ReadTable, empty_fields_are_allowed_where_the_contract_says_so) {
    const auto file = fresh_directory("table") / "t.csv";
    write_text(file, "time_s,value\r\n0.1,\r\n");
    const Table table = read_table(file, {{"time_s", "value"}, {}, {"value"}, ""});
    EXPECT_TRUE(std::isnan(table.number("value")[0]));
}

TEST(ReadJoinedTable, drops_what_a_restart_replaced_and_keeps_the_checkpoints_own_step) {
    const auto run = fresh_directory("joined");
    write_text(run / "postProcessing/x/0/t.csv", "time_s,value\n0.1,1\n0.2,2\n0.3,99\n0.4,99\n0.5,9");
    write_text(run / "postProcessing/x/0.2/t.csv", "time_s,value\n0.3,3\n0.4,4\n0.5,99\n");
    write_text(run / "postProcessing/x/0.4/t.csv", "time_s,value\n0.5,5\n");
    write_text(run / "postProcessing/x/notes/t.csv", "not a table");
    const Table table = read_joined_table(run, "x", "t.csv", k_rules);
    EXPECT_EQ(table.number("value"), (std::vector<double>{1, 2, 3, 4, 5}));
}

TEST(ReadJoinedTable, start_folders_are_ordered_as_numbers) {
    const auto run = fresh_directory("joined");
    write_text(run / "postProcessing/x/10/t.csv", "time_s,value\n10.1,3\n");
    write_text(run / "postProcessing/x/9/t.csv", "time_s,value\n9.5,2\n10.05,99\n");
    write_text(run / "postProcessing/x/0/t.csv", "time_s,value\n8.0,1\n");
    EXPECT_EQ(read_joined_table(run, "x", "t.csv", k_rules).number("value"), (std::vector<double>{1, 2, 3}));
}

TEST(ReadJoinedTable, an_event_at_the_start_time_counts_once) {
    const auto run = fresh_directory("joined");
    const TableRules rules{{"time_s", "id"}, {"surface"}, {}, ""};
    write_text(run / "postProcessing/rock/0/e.csv", "time_s,id,surface\n0.2,1,head\n0.2,2,head\n");
    write_text(run / "postProcessing/rock/0.2/e.csv", "time_s,id,surface\n0.2,2,head\n0.2,2,mouth\n0.3,1,head\n");
    const Table table = read_joined_table(run, "rock", "e.csv", rules, {"id", "surface"});
    EXPECT_EQ(table.number("id"), (std::vector<double>{1, 2, 2, 1}));
}

TEST(ReadJoinedTable, a_folders_name_has_six_digits_and_its_rows_nine) {
    const auto run = fresh_directory("joined");
    write_text(run / "postProcessing/x/0/t.csv", "time_s,value\n1.23456,1\n1.23456444,2\n1.23496444,99\n");
    write_text(run / "postProcessing/x/1.23456/t.csv", "time_s,value\n1.23496,3\n");
    EXPECT_EQ(read_joined_table(run, "x", "t.csv", k_rules).number("value"), (std::vector<double>{1, 2, 3}));
}

TEST(ReadJoinedTable, a_restart_that_wrote_nothing_still_replaces_what_came_after_it) {
    const auto run = fresh_directory("joined");
    write_text(run / "postProcessing/x/0/t.csv", "time_s,value\n0.1,1\n0.3,99\n");
    std::filesystem::create_directories(run / "postProcessing/x/0.2");
    EXPECT_EQ(read_joined_table(run, "x", "t.csv", k_rules).number("value"), (std::vector<double>{1}));
}

// A copy that was broken off, a full disk.
TEST(ReadJoinedTable, a_finished_start_has_whole_tables) {
    const auto run = fresh_directory("joined");
    const auto file = run / "postProcessing/x/0/t.csv";
    for (const char* damaged : {"", "time_s,value\n0.1,1\n0.2,"}) {
        std::filesystem::remove_all(run / "postProcessing/cost");
        write_text(file, damaged);
        EXPECT_NO_THROW(read_joined_table(run, "x", "t.csv", k_rules)) << "still running";
        write_text(run / "postProcessing/cost/0/cost.json", "{}");
        try {
            read_joined_table(run, "x", "t.csv", k_rules);
            ADD_FAILURE() << damaged;
        } catch (const UserError& error) {
            EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace cutterflow::postproc
