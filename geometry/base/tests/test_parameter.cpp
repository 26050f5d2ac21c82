#include "geometry/base/parameters/parameter.hpp"

#include <filesystem>
#include <functional>

#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "geometry/base/parameters/parameter_reading.hpp"

using namespace cutterflow;

namespace {

Parameter make(const std::string& key, ParameterKind kind) {
    Parameter parameter;
    parameter.key = key;
    parameter.kind = kind;
    parameter.help = "Help of " + key + ".";
    return parameter;
}

/// One key of every kind, a required one, a derived one, and an array of tables with another inside.
ParameterTable sample_table() {
    Parameter speed = make("rotor.speed_rpm", ParameterKind::number);
    speed.unit = "rpm";
    speed.minimum = 0.0;
    speed.maximum = 120.0;
    Parameter direction = make("rotor.direction", ParameterKind::choice);
    direction.choices = {"right_handed", "left_handed"};
    direction.default_value = std::string("right_handed");
    Parameter blades = make("rotor.blades", ParameterKind::integer);
    blades.default_value = std::int64_t{6};
    blades.minimum = 1.0;
    Parameter discharge = make("suction.discharge_m3_s", ParameterKind::number);
    discharge.unit = "m3/s";
    discharge.minimum = 0.0;
    discharge.minimum_excluded = true;
    discharge.default_value = 0.12;
    Parameter radius = make("suction.mouth_radius_m", ParameterKind::number);
    radius.optional = true;
    radius.derived_from = "0.25 ring radius";
    Parameter file = make("suction.file", ParameterKind::path);
    file.default_value = std::string("a \"b\".stl");
    Parameter open = make("suction.open", ParameterKind::boolean);
    open.default_value = false;
    Parameter count = make("feed.count", ParameterKind::integer);
    count.repeated = true;
    count.minimum = 1.0;
    Parameter seed = make("feed.seed", ParameterKind::integer);
    seed.repeated = true;
    seed.default_value = std::int64_t{1};
    Parameter diameter = make("feed.class.diameter_m", ParameterKind::number);
    diameter.repeated = true;
    diameter.unit = "m";
    diameter.default_value = 0.02;
    return {speed, direction, blades, discharge, radius, file, open, count, seed, diameter};
}

std::vector<Mistake> mistakes_in(const std::string& toml) {
    try {
        parse_parameters(sample_table(), toml, "study.toml");
    } catch (const UserError& error) {
        EXPECT_EQ(error.code(), ExitCode::user_input);
        return error.mistakes();
    }
    return {};
}

std::string only_mistake_in(const std::string& toml) {
    const std::vector<Mistake> mistakes = mistakes_in(toml);
    EXPECT_EQ(mistakes.size(), 1u) << toml;
    return mistakes.empty() ? "" : mistakes.front().text();
}

void expect_contains(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << "\n lacks: " << part;
}

}  // namespace

/// toml++ asserts on these.
TEST(ParameterFile, with_stray_brackets_is_refused_as_no_toml) {
    for (const char* text : {"[[[a]]]\n", "[,]\n", "[[=\n"}) {
        try {
            parse_parameters(sample_table(), text, "study.toml");
            ADD_FAILURE() << text;
        } catch (const UserError& error) {
            EXPECT_NE(std::string(error.what()).find("study.toml"), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find("must be TOML"), std::string::npos) << error.what();
        }
    }
}

/// toml++ formats these with an undefined conversion, which UndefinedBehaviorSanitizer reports.
TEST(Parameter, that_is_an_array_or_a_table_is_shown_on_one_line) {
    expect_contains(only_mistake_in("rotor.speed_rpm = [0.0625, inf, [1e-300]]\n"), "rotor.speed_rpm = [0.0625, inf, [1e-300]] has");
    expect_contains(only_mistake_in("rotor.speed_rpm = [{a = 0.0625}]\n"), "[{ a = 0.0625 }]");
}

TEST(Parameter, that_is_missing_is_told_where_it_belongs) {
    const auto remedy = [](const std::string& key) {
        try {
            parse_parameters({make(key, ParameterKind::integer)}, "", "study.toml");
        } catch (const UserError& error) {
            return error.mistakes().front().remedy;
        }
        return std::string();
    };
    EXPECT_EQ(remedy("count"), "Add count (a whole number) at the top of the file");
    EXPECT_EQ(remedy("feed.count"), "Add count (a whole number) to [feed]");
}

TEST(Parameter, reads_every_kind_and_fills_in_defaults) {
    const ParameterValues values = parse_parameters(sample_table(), R"(
[rotor]
speed_rpm = 60
direction = "left_handed"
[suction]
open = true
file = "Cutter Head (rev B).STL"
)",
                                                    "study.toml");
    EXPECT_EQ(values.number("rotor.speed_rpm"), 60.0);
    EXPECT_EQ(values.text("rotor.direction"), "left_handed");
    EXPECT_EQ(values.integer("rotor.blades"), 6);
    EXPECT_EQ(values.number("rotor.blades"), 6.0);
    EXPECT_EQ(values.number("suction.discharge_m3_s"), 0.12);
    EXPECT_TRUE(values.boolean("suction.open"));
    EXPECT_EQ(values.text("suction.file"), "Cutter Head (rev B).STL");
    EXPECT_FALSE(values.has("suction.mouth_radius_m"));
    EXPECT_EQ(values.where("rotor.speed_rpm"), "study.toml:3");
    EXPECT_EQ(values.where("rotor.blades"), "");
    EXPECT_TRUE(values.tables("feed").empty());
    EXPECT_THROW(values.number("suction.mouth_radius_m"), std::logic_error);
    EXPECT_THROW(values.number("suction.file"), std::logic_error);
}

TEST(Parameter, reads_arrays_of_tables_and_arrays_inside_them) {
    const ParameterValues values = parse_parameters(sample_table(), R"(
rotor.speed_rpm = 60.5
[[feed]]
count = 3
[[feed.class]]
diameter_m = 0.01
[[feed.class]]
[[feed]]
count = 4
seed = 7
)",
                                                    "study.toml");
    ASSERT_EQ(values.tables("feed").size(), 2u);
    const ParameterValues& first = values.tables("feed")[0];
    EXPECT_EQ(first.integer("feed.count"), 3);
    EXPECT_EQ(first.integer("feed.seed"), 1);
    ASSERT_EQ(first.tables("feed.class").size(), 2u);
    EXPECT_EQ(first.tables("feed.class")[0].number("feed.class.diameter_m"), 0.01);
    EXPECT_EQ(first.tables("feed.class")[1].number("feed.class.diameter_m"), 0.02);
    EXPECT_EQ(values.tables("feed")[1].integer("feed.seed"), 7);
    EXPECT_EQ(values.tables("feed")[1].where("feed.count"), "study.toml:9");
}

TEST(Parameter, reports_every_mistake_of_a_file_at_once_in_its_order) {
    const std::vector<Mistake> mistakes = mistakes_in(R"([suction]
discharge_m3_s = 0
[rotor]
speed_rpn = 60
direction = "left"
[[feed]]
count = "three"
)");
    ASSERT_EQ(mistakes.size(), 4u);  // a misspelt key is not told of as missing too
    EXPECT_EQ(mistakes[0].where, "study.toml:2");
    expect_contains(mistakes[0].text(), "suction.discharge_m3_s = 0 is too low. It must be above 0 m3/s.");
    EXPECT_EQ(mistakes[1].where, "study.toml:4");
    expect_contains(mistakes[1].text(), "key rotor.speed_rpn is unknown");
    expect_contains(mistakes[1].text(), "Did you mean rotor.speed_rpm?");
    EXPECT_EQ(mistakes[2].where, "study.toml:5");
    expect_contains(mistakes[2].text(), "one of right_handed, left_handed");
    EXPECT_EQ(mistakes[3].where, "study.toml:7");
    expect_contains(mistakes[3].text(), "feed.count = \"three\" has the wrong type. It must be a whole number");
}

TEST(Parameter, a_misspelling_hides_no_missing_key_of_another_table) {
    const std::vector<Mistake> mistakes = mistakes_in("rotor.speed_rpm = 1\n[[feed]]\ncuont = 3\n[[feed]]\nseed = 2\n");
    ASSERT_EQ(mistakes.size(), 2u);
    expect_contains(mistakes[0].text(), "Did you mean feed.count?");
    expect_contains(mistakes[1].text(), "feed.count is missing");
    EXPECT_EQ(mistakes[1].where, "study.toml:4");
}

TEST(Parameter, names_a_misplaced_key_and_a_misspelt_section) {
    expect_contains(only_mistake_in("rotor.speed_rpm = 1\nsuction.speed_rpm = 2\n"), "Did you mean rotor.speed_rpm?");
    const std::string section = only_mistake_in("rotor.speed_rpm = 1\n[sucktion]\nopen = true\n");
    expect_contains(section, "section sucktion is unknown");
    expect_contains(section, "Did you mean suction?");
    expect_contains(only_mistake_in("rotor.speed_rpm = 1\nnonsense_altogether = 2\n"),
                    "The file's sections are rotor, suction, feed, feed.class");
}

TEST(Parameter, refuses_values_outside_their_type_or_bounds) {
    const std::string good = "rotor.speed_rpm = 1\n";
    expect_contains(only_mistake_in("rotor.speed_rpm = 120.5"), "It must be 0 to 120 rpm");
    expect_contains(only_mistake_in("rotor.speed_rpm = -1"), "too low");
    expect_contains(only_mistake_in("rotor.speed_rpm = nan"), "not finite");
    expect_contains(only_mistake_in("rotor.speed_rpm = true"), "wrong type");
    expect_contains(only_mistake_in(good + "rotor.blades = 6.0"), "a whole number");
    expect_contains(only_mistake_in(good + "rotor.blades = 0"), "at least 1");
    expect_contains(only_mistake_in(good + "suction.file = 3"), "a path in quotes");
    EXPECT_TRUE(mistakes_in("rotor.speed_rpm = 120").empty());
    EXPECT_TRUE(mistakes_in("rotor.speed_rpm = 0").empty());
}

TEST(Parameter, tells_sections_and_arrays_of_tables_apart) {
    expect_contains(only_mistake_in("rotor.speed_rpm = 1\nsuction = 3"), "Write [suction] on a separate line");
    expect_contains(only_mistake_in("rotor.speed_rpm = 1\n[feed]\ncount = 1"), "Write [[feed]] with two brackets");
    expect_contains(only_mistake_in("rotor.speed_rpm = 1\n[[feed]]\nseed = 1"), "study.toml:2: feed.count is missing");
}

TEST(Parameter, explains_a_file_that_is_not_toml_or_not_there) {
    expect_contains(only_mistake_in("[rotor]\nspeed_rpm = \n"), "study.toml:2");
    try {
        read_parameters(sample_table(), "/nonexistent/study.toml");
        FAIL() << "a missing file was read";
    } catch (const UserError& error) {
        expect_contains(error.what(), "cannot read /nonexistent/study.toml");
    }
    EXPECT_THROW(read_parameters(sample_table(), std::filesystem::temp_directory_path()), UserError);
}

TEST(Parameter, template_with_values_reads_back_as_the_same_values) {
    const ParameterValues values = parse_parameters(sample_table(), R"(
rotor.speed_rpm = 0.1
suction.mouth_radius_m = 0.30000000000000004
[[feed]]
count = 3
[[feed.class]]
diameter_m = 1e-3
[[feed]]
count = 5
)",
                                                    "study.toml");
    const ParameterValues again = parse_parameters(sample_table(), commented_toml(sample_table(), &values), "again.toml");
    EXPECT_EQ(again.number("rotor.speed_rpm"), 0.1);
    EXPECT_EQ(again.number("suction.mouth_radius_m"), 0.30000000000000004);
    EXPECT_EQ(again.text("suction.file"), "a \"b\".stl");
    ASSERT_EQ(again.tables("feed").size(), 2u);
    ASSERT_EQ(again.tables("feed")[0].tables("feed.class").size(), 1u);
    EXPECT_EQ(again.tables("feed")[0].tables("feed.class")[0].number("feed.class.diameter_m"), 1e-3);
    EXPECT_EQ(again.tables("feed")[1].integer("feed.count"), 5);
}

TEST(Parameter, template_leaves_required_keys_to_fill_in) {
    const std::string text = commented_toml(sample_table());
    const std::vector<Mistake> mistakes = mistakes_in(text);
    ASSERT_EQ(mistakes.size(), 2u);
    expect_contains(mistakes[0].text(), "feed.count is missing");
    expect_contains(mistakes[1].text(), "rotor.speed_rpm is missing");
    expect_contains(text, "# speed_rpm =\n");
    expect_contains(text, "without it: 0.25 ring radius");
}

TEST(Parameter, lists_hold_every_key) {
    const std::string text = parameters_text(sample_table());
    const std::string markdown = parameters_markdown(sample_table());
    for (const Parameter& parameter : sample_table()) {
        expect_contains(text, parameter.help.substr(0, 7));
        expect_contains(markdown, parameter.help);
    }
    expect_contains(markdown, "## [[feed.class]]");
    expect_contains(markdown, "right_handed \\| left_handed");
}

TEST(Parameter, nearest_word_allows_a_third_of_the_letters_to_differ) {
    EXPECT_EQ(nearest_word("dischrge", {"direction", "discharge"}), "discharge");
    EXPECT_EQ(nearest_word("abc", {"abd"}), "abd");
    EXPECT_EQ(nearest_word("abc", {"axx"}), "");
    EXPECT_EQ(nearest_word("", {"a"}), "");
}

/// Keys of arrays of tables mean something in their own tables alone.
TEST(Parameter, that_is_unknown_is_no_misspelling_of_a_key_of_another_array_of_tables) {
    Parameter name = make("measure.name", ParameterKind::text);
    Parameter level = make("prepare.region.above_m", ParameterKind::number);
    Parameter box = make("prepare.region.box.lower_m", ParameterKind::number);
    Parameter longest = make("prepare.longest_s", ParameterKind::number);
    Parameter radius = make("measure.region.ball.radius_m", ParameterKind::number);
    for (Parameter* row : {&name, &level, &box, &longest, &radius}) row->optional = true;
    for (Parameter* row : {&name, &longest}) row->repeated = true;
    const auto remedy = [&](const std::string& toml) {
        return parse_with_mistakes({name, level, box, longest, radius}, toml, "room.toml").mistakes.at(0).remedy;
    };
    EXPECT_EQ(remedy("[[measure]]\nregion = { above_m = 1 }\n"), "Remove it");
    EXPECT_EQ(remedy("[[measure]]\nregion = { box = { lower_m = 1 } }\n"), "Did you mean measure.region.ball?");
    EXPECT_EQ(remedy("[[measure]]\nlongest_s = 1\n"), "Remove it");
    EXPECT_EQ(remedy("[[prepare]]\nabove_m = 1\n"), "Did you mean prepare.region.above_m?");
    EXPECT_EQ(remedy("[[prepare]]\nregion = { bux = { lower_m = 1 } }\n"), "Did you mean prepare.region.box?");
}

namespace {

/// Lists, a key beside a table of its name, and an array within a section.
ParameterTable table_with_lists() {
    Parameter size = make("room.size_m", ParameterKind::numbers);
    size.length = 3;
    size.unit = "m";
    size.minimum = 0.0;
    size.minimum_excluded = true;
    Parameter cell = make("room.refine.cell_m", ParameterKind::number);
    cell.repeated = true;
    Parameter pair = make("contact.pair", ParameterKind::texts);
    pair.repeated = true;
    pair.length = 2;
    Parameter flow = make("side.flow", ParameterKind::choice);
    flow.repeated = flow.optional = true;
    flow.choices = {"slip", "pressure"};
    Parameter speed = make("side.flow.speed_m_s", ParameterKind::number);
    speed.optional = true;
    return {size, cell, pair, flow, speed};
}

std::string mistakes_with_lists(const std::string& toml) {
    try {
        parse_parameters(table_with_lists(), toml, "room.toml");
    } catch (const UserError& error) {
        return error.what();
    }
    return {};
}

const char* const k_lists = R"([room]
size_m = [1, 0.5, 2]
[[room.refine]]
cell_m = 0.01
[[contact]]
pair = ["gravel", "steel"]
[[side]]
flow = "slip"
[[side]]
flow = { speed_m_s = 1.5 }
)";

}  // namespace

TEST(Parameter, reads_lists_and_tables_in_the_place_of_a_key_and_writes_them_back) {
    const ParameterTable table = table_with_lists();
    ParameterValues values = parse_parameters(table, k_lists, "room.toml");
    const auto expect_values = [&] {
        EXPECT_EQ(values.numbers("room.size_m"), (std::vector<double>{1.0, 0.5, 2.0}));
        ASSERT_EQ(values.tables("room.refine").size(), 1u);
        EXPECT_EQ(values.tables("room.refine")[0].number("room.refine.cell_m"), 0.01);
        EXPECT_EQ(values.tables("contact").at(0).texts("contact.pair"), (std::vector<std::string>{"gravel", "steel"}));
        ASSERT_EQ(values.tables("side").size(), 2u);
        EXPECT_EQ(values.tables("side")[0].text("side.flow"), "slip");
        EXPECT_FALSE(values.tables("side")[0].has("side.flow.speed_m_s"));
        EXPECT_EQ(values.tables("side")[1].number("side.flow.speed_m_s"), 1.5);
        EXPECT_FALSE(values.tables("side")[1].has("side.flow"));
    };
    expect_values();
    EXPECT_EQ(values.where("room.size_m"), "room.toml:2");
    EXPECT_EQ(values.tables("side")[1].where("side.flow"), "room.toml:10");
    for (const std::string& written : {plain_toml(table, values), commented_toml(table, &values)}) {
        values = parse_parameters(table, written, "written.toml");
        expect_values();
    }
}

TEST(Parameter, lists_have_a_length_a_type_and_bounds) {
    expect_contains(mistakes_with_lists("room.size_m = [1, 2]\n"), "a list of 3 numbers in m");
    expect_contains(mistakes_with_lists("room.size_m = [1, 2, \"x\"]\n"), "has the wrong type");
    expect_contains(mistakes_with_lists("room.size_m = [0, 0.015]\n"), "room.size_m = [0, 0.015] has the wrong type");
    expect_contains(mistakes_with_lists("room.size_m = [1, 2, 0]\n"), "room.size_m = [1, 2, 0] is too low");
    expect_contains(mistakes_with_lists("room.size_m = 1\n"), "has the wrong type");
    expect_contains(mistakes_with_lists("room.size_m = [1, 2, 3]\n[[contact]]\npair = [\"a\"]\n"), "a list of 2 texts in quotes");
    expect_contains(mistakes_with_lists("room.size_m = [1, 2, 3]\n[[side]]\nflow = { speed = 1 }\n"), "Did you mean side.flow.speed_m_s");
    expect_contains(mistakes_with_lists("room.size_m = [1, 2, 3]\n[[side]]\nflow = 3\n"), "one of its choices");
}
