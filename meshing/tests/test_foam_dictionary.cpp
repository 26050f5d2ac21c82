#include "meshing/dictionary/foam_dictionary.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace cutterflow::meshing {
namespace {

/// Tokens of dictionary text as OpenFOAM's reader forms them: brackets directly behind a word belong to that word.
std::vector<std::string> tokens(const std::string& text) {
    std::vector<std::string> result;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (std::isspace(static_cast<unsigned char>(c))) {
            ++i;
        } else if (c == '"') {
            std::size_t end = i + 1;
            while (text[end] != '"') end += text[end] == '\\' ? 2 : 1;
            result.push_back(text.substr(i, end + 1 - i));
            i = end + 1;
        } else if (std::string("(){};[]").find(c) != std::string::npos) {
            result.push_back(std::string(1, c));
            ++i;
        } else {
            int depth = 0;
            std::size_t end = i;
            for (; end < text.size(); ++end) {
                const char w = text[end];
                if (std::isspace(static_cast<unsigned char>(w)) || std::string("{};[]\"").find(w) != std::string::npos) break;
                if (w == '(') ++depth;
                if (w == ')' && --depth < 0) break;
            }
            result.push_back(text.substr(i, end - i));
            i = end;
        }
    }
    return result;
}

std::vector<std::string> tokens(const FoamDictionary& dictionary) {
    return tokens(dictionary.text());
}

using Tokens = std::vector<std::string>;

TEST(FoamDictionary, keeps_a_keyword_and_a_bracket_behind_it_apart) {
    FoamDictionary d;
    d.add("a_key_that_is_longer_than_its_column", FoamValue::list({1, 2}));
    EXPECT_EQ(tokens(d), (Tokens{"a_key_that_is_longer_than_its_column", "(", "1", "2", ")", ";"}));
}

TEST(FoamDictionary, writes_scheme_keys_unquoted_and_patterns_quoted) {
    FoamDictionary d;
    d.add("div(phi,U)", FoamValue::raw("Gauss linearUpwind grad(U)")).add_pattern("(U|k)Final", 1);
    EXPECT_EQ(tokens(d), (Tokens{"div(phi,U)", "Gauss", "linearUpwind", "grad(U)", ";", "\"(U|k)Final\"", "1", ";"}));
}

TEST(FoamDictionary, nests_dictionaries_and_lists_of_named_dictionaries) {
    FoamDictionary wall;
    wall.add("type", "wall");
    FoamDictionary d;
    d.add("outer", FoamDictionary().add("inner", wall));
    d.add("patches", FoamValue::list({FoamValue::sequence({"hub", wall}), wall}));
    EXPECT_EQ(tokens(d), (Tokens{"outer", "{",    "inner", "{", "type", "wall", ";",    "}",    "}", "patches", "(", "hub",
                                 "{",     "type", "wall",  ";", "}",    "{",    "type", "wall", ";", "}",       ")", ";"}));
}

TEST(FoamDictionary, keeps_the_order_of_its_entries) {
    FoamDictionary d;
    d.add("z", 1).add("a", 2).add_flag("m");
    EXPECT_EQ(tokens(d), (Tokens{"z", "1", ";", "a", "2", ";", "m", ";"}));
}

TEST(FoamDictionary, breaks_long_lists_into_lines_without_changing_their_tokens) {
    std::vector<FoamValue> items;
    Tokens expected{"list", "("};
    for (int i = 0; i < 200; ++i) {
        items.push_back(i);
        expected.push_back(std::to_string(i));
    }
    expected.insert(expected.end(), {")", ";"});
    FoamDictionary d;
    d.add("list", FoamValue::list(items));
    EXPECT_EQ(tokens(d), expected);
    std::istringstream lines(d.text());
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 140u);
}

TEST(FoamDictionary, refuses_a_key_that_is_there_or_is_no_word) {
    FoamDictionary d;
    d.add("type", "wall");
    EXPECT_THROW(d.add("type", "patch"), std::invalid_argument);
    for (const char* key : {"", "two words", "a;b", "(U|k)", "open(", "path/name", "br{ace", "$macro", "#include"})
        EXPECT_THROW(d.add(key, 1), std::invalid_argument) << key;
    EXPECT_NO_THROW(d.add_pattern("type", "patch"));
}

TEST(FoamValue, writes_numbers_that_read_back_the_same) {
    for (const double x : {0.1, 1.0 / 3.0, -5.0, 1.1e8, 1e-300, 0.0, 6.02214076e23})
        EXPECT_EQ(std::strtod(FoamValue(x).text().c_str(), nullptr), x);
    EXPECT_EQ(FoamValue(Vec3(1.5, -2.0, 0.25)).text(), "(" + FoamValue(1.5).text() + " " + FoamValue(-2.0).text() + " 0.25)");
    EXPECT_THROW(FoamValue(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
    EXPECT_THROW(FoamValue(Vec3(0, std::numeric_limits<double>::infinity(), 0)), std::invalid_argument);
}

TEST(FoamValue, takes_text_as_a_word_and_quotes_only_when_asked) {
    EXPECT_EQ(FoamValue("latestTime").text(), "latestTime");
    EXPECT_EQ(FoamValue(true).text(), "true");
    EXPECT_THROW(FoamValue("constant/rockFeed.csv"), std::invalid_argument);
    EXPECT_THROW(FoamValue("rev B"), std::invalid_argument);
    EXPECT_EQ(FoamValue::quoted(R"(a "b" \c)").text(), R"("a \"b\" \\c")");
    EXPECT_EQ(FoamValue::dimensions({0, 2, -1, 0, 0, 0, 0}).text(), "[0 2 -1 0 0 0 0]");
}

TEST(FoamValue, refuses_raw_tokens_that_would_end_the_entry) {
    for (const char* bad : {"", "Gauss; linear", "a { b", "grad(U", "U)", "line\nend"})
        EXPECT_THROW(FoamValue::raw(bad), std::invalid_argument) << bad;
}

TEST(FoamFile, names_class_and_object_and_makes_its_folder) {
    const auto folder = std::filesystem::path(testing::TempDir()) / "foam_dictionary_test";
    std::filesystem::remove_all(folder);
    FoamDictionary d;
    d.add("deltaT", 0.001);
    write_foam_file(folder / "system" / "controlDict", "dictionary", d);
    std::stringstream text;
    text << std::ifstream(folder / "system" / "controlDict").rdbuf();
    const Tokens t = tokens(text.str());
    const Tokens head{"FoamFile", "{", "version"};
    EXPECT_TRUE(std::equal(head.begin(), head.end(), t.begin()));
    EXPECT_EQ(Tokens(t.end() - 10, t.end()),
              (Tokens{"class", "dictionary", ";", "object", "controlDict", ";", "}", "deltaT", "0.001", ";"}));
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace cutterflow::meshing
