#include <filesystem>

#include <gmock/gmock.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "validation/harness/reference_table.hpp"

namespace cutterflow::validation {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<ReferenceColumn> k_wanted{{"speed", "m/s"}, {"restitution", "-"}};

ReferenceTable read(const std::string& text) {
    const auto file = std::filesystem::temp_directory_path() / "cutterflow_reference.csv";
    write_file(file, text);
    return read_reference(file, k_wanted);
}

std::string refusal(const std::string& text) {
    try {
        read(text);
    } catch (const UserError& error) {
        return error.what();
    }
    return "taken";
}

TEST(ReferenceTable, takes_lines_that_end_as_on_windows) {
    const ReferenceTable table = read("# source: Legendre2006\r\nrestitution [-],speed [m/s]\r\n0.5,1e-2\r\n");
    EXPECT_EQ(table.source, "Legendre2006");
    EXPECT_THAT(table.at("speed"), ElementsAre(0.01));
}

TEST(ReferenceTable, holds_finite_numbers) {
    EXPECT_THAT(refusal("# source: Legendre2006\nspeed [m/s],restitution [-]\n"), HasSubstr("there are no numbers"));
    EXPECT_THAT(refusal("# source: Legendre2006\nspeed [m/s],restitution [-]\n1,nan\n"), HasSubstr("\"nan\" in column \"restitution"));
}

TEST(ReferenceTable, gives_columns_and_source) {
    const ReferenceTable table = read("# source: Legendre2006\n# a comment\nrestitution [-],speed [m/s]\n0.5,1e-2\n0.75,2\n");
    EXPECT_EQ(table.source, "Legendre2006");
    EXPECT_EQ(table.rows(), 2u);
    EXPECT_THAT(table.at("speed"), ElementsAre(0.01, 2.0));
    EXPECT_THAT(table.at("restitution"), ElementsAre(0.5, 0.75));
}

TEST(ReferenceTable, refuses_missing_columns_units_and_sources_all_at_once) {
    EXPECT_THAT(refusal("# source: Legendre2006\nspeed,angle [deg]\n1,2\n"),
                AllOf(HasSubstr("column \"speed\" has no unit"), HasSubstr("no column \"restitution [-]\"")));
    EXPECT_THAT(refusal("# source: Legendre2006\nspeed [mm/s],restitution [-]\n1,2\n"), HasSubstr("\"speed\" is in [mm/s]"));
    EXPECT_THAT(refusal("speed [m/s],restitution [-]\n1,2\n"), HasSubstr("source \"\""));
    EXPECT_THAT(refusal("# source: Nobody1999\nspeed [m/s],restitution [-]\n1,2\n"), HasSubstr("Nobody1999"));
    EXPECT_THAT(refusal("# source: Legendre2006\nspeed [m/s],restitution [-]\n1,fast\n"),
                AllOf(HasSubstr("csv:3"), HasSubstr("\"fast\" in column \"restitution\"")));
    EXPECT_THAT(refusal("# source: Legendre2006\nspeed [m/s],restitution [-]\n1\n"), HasSubstr("1 fields"));
    EXPECT_THAT(refusal(""), HasSubstr("there are no columns"));
}

}  // namespace
}  // namespace cutterflow::validation
