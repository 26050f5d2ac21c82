/// Measures are checked as a whole, before a run and after it.
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/parameters/parameter_words.hpp"
#include "postproc/analysis/measures/measure_table.hpp"

namespace cutterflow::postproc {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<std::string> texts(const std::string& measures) {
    std::vector<std::string> found;
    for (const Mistake& mistake : check_measures(json::parse(measures), "measures.json")) found.push_back(mistake.text());
    return found;
}

TEST(MeasureTable, takes_one_of_every_kind) {
    EXPECT_THAT(texts(R"([
        {"name": "removed", "what": "passed_mass", "gate": {"disc_m": [0, 0, 0.3], "radius_m": 0.047}},
        {"name": "outlet", "what": "passed_mass", "gate": {"lower_m": [0, 0, 0.1], "upper_m": [0.1, 0.1, 0.1], "normal": [0, 0, -1]}},
        {"name": "flow", "what": "rate", "gate": "removed", "from_s": 1, "to_s": 3},
        {"name": "upper-mass", "what": "rate", "region": {"half_space": {"point_m": [0, 0, 0.5], "normal": [0, 0, 1]}}},
        {"name": "half", "what": "time_of", "gate": "removed", "share": 0.5},
        {"name": "left", "what": "mass_in", "region": {"box": {"lower_m": [0, 0, 0], "upper_m": [1, 1, 1]}}, "at_s": 2},
        {"name": "share", "what": "packing", "region": {"cylinder": {"from_m": [0, 0, 0], "to_m": [0, 0, 1], "radius_m": 0.1}}},
        {"name": "line", "what": "profile"},
        {"name": "misfit", "what": "profile_error", "against": "heap.csv", "points": 100},
        {"name": "slope", "what": "angle", "base_m": 0.02, "window": [0, 0.7]},
        {"name": "cavity", "what": "cavity", "undisturbed_m": 0.10, "quantity": "depth"},
        {"name": "hole", "what": "void_area", "seed_m": [0.1, 0, 0.135], "cell_m": 0.005,
         "region": {"box": {"lower_m": [0, -0.02, 0], "upper_m": [0.3, 0.02, 0.4]}}},
        {"name": "motion", "what": "bed_velocity", "cell_m": 0.01, "region": {"box": {"lower_m": [0, 0, 0], "upper_m": [1, 1, 1]}}},
        {"name": "beat", "what": "spectrum", "wall": "pipe", "component": "x", "length_m": 0.1, "velocity_m_s": 1, "quantity": "strouhal"},
        {"name": "torque", "what": "spectrum", "table": "loads/loads.csv", "column": "torque_rock_n_m"},
        {"name": "load", "what": "wall_force", "wall": "plate"},
        {"name": "drop", "what": "pressure_drop", "upstream_m": [0, 0, 0], "downstream_m": [0, 0, 1], "density_kg_m3": 1.2}
    ])"),
                IsEmpty());
}

TEST(MeasureTable, tells_all_mistakes_at_once_with_the_measure_s_name_and_the_nearest_word) {
    const auto found = texts(R"([
        {"name": "a b", "what": "wall_force", "wal": "plate"},
        {"name": "one", "what": "cavitty"},
        {"name": "two", "what": "rate"},
        {"name": "two", "what": "rate", "gate": "x", "region": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 1}}, "from_s": 3, "to_s": 1},
        {"name": "three", "what": "profile", "points": 1, "along": "z", "base_m": "floor"},
        {"name": "four", "what": "packing", "region": {"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, 1]}}},
        {"name": "five", "what": "mass_in", "region": {"box": {"lower_m": [0, 0, 0], "upper_m": [1, -1, 1]}}},
        {"name": "six", "what": "mass_in", "region": {"ball": {}}},
        {"name": "seven", "what": "passed_mass", "gate": {"disc_m": [0, 0], "radius_m": -1, "normal": [0, 0, 0], "colour": 1}},
        {"name": "eight", "what": "spectrum", "table": "loads/loads.csv", "quantity": "strouhal"},
        {"name": "nine", "what": "time_of", "gate": "x", "share": 1.5},
        {"what": "angle", "window": [0.8, 0.2]},
        7
    ])");
    const auto has = [&](const std::string& name, const std::string& part) {
        EXPECT_THAT(found, Contains(AllOf(HasSubstr("measures.json"), HasSubstr(name), HasSubstr(part)))) << name << " " << part;
    };
    has("measure 1", "name = \"a b\"");
    has("measure 1", "Did you mean wall");
    has("measure 1", "wall is missing");
    has("measure.one", "Did you mean cavity");
    has("measure.two", "neither gate nor region");
    has("measure.two", "two of this name");
    has("measure.two", "gate and region are both given");
    has("measure.two", "from_s = 3 and to_s = 1");
    has("measure.three", "points = 1");
    has("measure.three", "along = ");
    has("measure.three", "base_m = \"floor\" has the wrong type");
    has("measure.four", "region is a half_space");
    has("measure.five", "upper_m = [1,-1,1]");
    has("measure.six", "one of box, sphere, cylinder, half_space");
    has("measure.seven", "gate.disc_m = [0,0]");
    has("measure.seven", "gate.radius_m = -1");
    has("measure.seven", "gate.normal");
    has("measure.seven", "gate.colour is unknown");
    has("measure.eight", "table without column");
    has("measure.eight", "length_m and velocity_m_s");
    has("measure.nine", "share = 1.5");
    has("measure 12", "name is missing");
    has("measure 12", "window = [0.8,0.2]");
    has("measure 13", "A measure is a table");
    EXPECT_THAT(found, SizeIs(24));
}

TEST(MeasureTable, takes_flat_rectangles_as_gates_alone) {
    const auto gate = [](const char* lower, const char* upper) {
        return texts(fmt::format(R"([{{"name": "door", "what": "passed_mass", "gate": {{"lower_m": {}, "upper_m": {}}}}}])", lower, upper));
    };
    EXPECT_THAT(gate("[0.02, -0.025, 0]", "[0.02, 0.025, 0.09]"), IsEmpty());
    EXPECT_THAT(gate("[0.02, -0.025, 0]", "[0.03, 0.025, 0.09]"),
                ::testing::ElementsAre(HasSubstr("gate.lower_m = [0.02,-0.025,0] and upper_m = [0.03,0.025,0.09] are no rectangle")));
    EXPECT_THAT(gate("[0.02, 0.025, 0]", "[0.02, 0.025, 0.09]"), SizeIs(1)) << "a line";
    EXPECT_THAT(gate("[0.02, 0.025, 0]", "[0.02, -0.025, 0.09]"), SizeIs(1)) << "corners exchanged";
}

TEST(MeasureTable, refuses_times_before_the_run) {
    EXPECT_THAT(texts(R"([{"name": "a", "what": "angle", "at_s": -1}, {"name": "b", "what": "wall_force", "wall": "plate", "to_s": -1},
                          {"name": "c", "what": "wall_force", "wall": "plate", "from_s": -1}])"),
                ::testing::ElementsAre(HasSubstr("at_s = -1"), HasSubstr("to_s = -1"), HasSubstr("from_s = -1")));
}

/// Outside a region that is no box there is no bed, and its map would have a false cavity there.
TEST(MeasureTable, takes_a_box_alone_for_a_cavity) {
    for (const char* region : {R"({"cylinder": {"from_m": [0, 0, 0], "to_m": [0, 0, 1], "radius_m": 0.1}})",
                               R"({"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, 1]}})"})
        EXPECT_THAT(texts(fmt::format(R"([{{"name": "a", "what": "cavity", "region": {}}}])", region)),
                    Contains(HasSubstr("It must be a box here")));
}

TEST(MeasureTable, refuses_maps_of_a_box_that_are_too_fine) {
    const auto of = [](const char* box, const char* more) {
        return texts(fmt::format(R"([{{"name": "a", "region": {{"box": {}}}, {}}}])", box, more));
    };
    const char* high = R"({"lower_m": [0, 0, 0], "upper_m": [0.1, 0.1, 100]})";
    EXPECT_THAT(of(high, R"("what": "cavity", "cell_m": 0.001)"), IsEmpty()) << "seen from above";
    EXPECT_THAT(of(high, R"("what": "cavity", "cell_m": 1e-7)"), Contains(HasSubstr("cell_m = 1e-07 gives a map of 1e+12 cells")));
    EXPECT_THAT(of(high, R"("what": "bed_velocity", "cell_m": 0.001, "across": "z")"), IsEmpty());
    EXPECT_THAT(of(high, R"("what": "bed_velocity", "cell_m": 0.001)"), Contains(HasSubstr("It has at most 250000")));
    EXPECT_THAT(of(high, R"("what": "void_area", "cell_m": 0.001, "seed_m": [9, 0, 0])"),
                ::testing::ElementsAre(HasSubstr("It has at most 250000"), HasSubstr("seed_m")));
}

TEST(MeasureTable, refuses_tables_that_are_none_of_a_run_or_of_many_walls) {
    const auto of = [](const char* table, const char* column) {
        return texts(fmt::format(R"([{{"name": "a", "what": "spectrum", "table": "{}", "column": "{}"}}])", table, column));
    };
    EXPECT_THAT(of("loads/loads.csv", "torque_rock_n_m"), IsEmpty());
    for (const char* table : {"loads.csv", "/loads/loads.csv", "../loads/loads.csv", "loads/"})
        EXPECT_THAT(of(table, "torque_rock_n_m"), Contains(HasSubstr("It is a file in a folder of postProcessing/"))) << table;
    EXPECT_THAT(of("rock/walls.csv", "force_x_n"), Contains(HasSubstr("Give a wall and a component")));
    EXPECT_THAT(of("loads/loads.csv", "time_s"), Contains(HasSubstr("Time is no signal")));
}

TEST(MeasureTable, refuses_what_is_no_list) {
    EXPECT_THAT(texts(R"({"name": "a"})"), SizeIs(1));
}

TEST(MeasureTable, has_unique_kinds_and_keys_that_can_be_read) {
    std::set<std::string> whats;
    for (const MeasureKind& kind : measure_table()) {
        EXPECT_TRUE(whats.insert(kind.what).second) << kind.what;
        std::set<std::string> keys{"name", "what"};
        for (const MeasureKey& key : kind.keys) {
            const Parameter& parameter = key.parameter;
            EXPECT_TRUE(keys.insert(parameter.key).second) << kind.what << " " << parameter.key;
            EXPECT_FALSE(parameter.help.empty()) << parameter.key;
            if (!parameter.default_value) continue;
            EXPECT_FALSE(value_mistake(parameter, *parameter.default_value)) << parameter.key;
            const bool text = std::holds_alternative<std::string>(*parameter.default_value);
            EXPECT_EQ(text, parameter.kind == ParameterKind::choice) << parameter.key;
        }
    }
}

/// The tables of the manual page, as Markdown.
std::string measures_markdown() {
    std::string text;
    for (const MeasureKind& kind : measure_table()) {
        text += fmt::format("### {}\n\n{} Unit of the value: {}.\n\n| key | value | when absent | meaning |\n|---|---|---|---|\n",
                            kind.what, kind.help, kind.unit);
        for (const MeasureKey& key : kind.keys) {
            const Parameter& p = key.parameter;
            std::string value;
            switch (key.shape) {
                case MeasureShape::single:
                    value = p.choices.empty() ? parameter_words::kind_with_unit(p) : fmt::format("{}", fmt::join(p.choices, ", "));
                    break;
                case MeasureShape::pair:
                    value = "2 numbers" + (parameter_words::has_unit(p) ? " in " + p.unit : std::string());
                    break;
                case MeasureShape::point:
                    value = "3 numbers in m";
                    break;
                case MeasureShape::region:
                    value = "a region";
                    break;
                case MeasureShape::gate:
                    value = "a gate";
            }
            const std::string bounds = parameter_words::bounds_text(p);
            std::string absent = !p.optional && !p.default_value ? "required" : p.derived_from;
            if (p.default_value)
                absent = p.kind == ParameterKind::choice ? std::get<std::string>(*p.default_value) : toml_text(*p.default_value);
            text += fmt::format("| `{}` | {}{} | {} | {}{} |\n", p.key, value, bounds.empty() ? "" : ", " + bounds, absent, p.help,
                                p.reference.empty() ? "" : " [" + p.reference + "]");
        }
        if (&kind != &measure_table().back()) text += '\n';
    }
    return text;
}

TEST(MeasureTable, is_the_table_of_the_manual_page) {
    const std::string page = read_file(installation().data / "docs/user/measures.md");
    EXPECT_NE(page.find(measures_markdown()), std::string::npos)
        << "docs/user/measures.md differs from the table: replace its part from the first ### to the end by\n"
        << measures_markdown();
}

TEST(MeasureTable, gives_defaults_where_keys_are_absent) {
    const MeasureValues values(json::parse(R"({"name": "p", "what": "profile", "base_m": 0.25})"));
    EXPECT_EQ(values.integer("points"), 100);
    EXPECT_EQ(values.text("along"), "x");
    EXPECT_EQ(values.number("base_m"), 0.25);
    EXPECT_EQ(values.optional_number("from_m"), std::nullopt);
}

}  // namespace
}  // namespace cutterflow::postproc
