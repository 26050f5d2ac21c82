#include "geometry/base/json_document.hpp"

#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"

namespace cutterflow {
namespace {

namespace fs = std::filesystem;

const fs::path k_file = fs::path(CUTTERFLOW_BUILD_DIR) / "tests" / "document.json";
const std::vector<JsonField> k_fields{{"cells", JsonKind::whole, true},    {"gates/*/name", JsonKind::text, true},
                                      {"gates/*/passed", JsonKind::truth}, {"rocks/*/bin", JsonKind::whole_or_null},
                                      {"head/radius_m", JsonKind::number}, {"head/passage_m", JsonKind::number_or_null},
                                      {"versions", JsonKind::object}};

nlohmann::json document(const std::string& text) {
    fs::create_directories(k_file.parent_path());
    std::ofstream(k_file, std::ios::binary) << text;
    return read_json_document(k_file, k_fields, "Run it again");
}

std::vector<Mistake> mistakes_of(const std::string& text) {
    try {
        document(text);
    } catch (const UserError& error) {
        return error.mistakes();
    }
    return {};
}

TEST(JsonDocument, with_all_values_of_their_kinds_is_read) {
    const nlohmann::json read = document(
        R"({"cells": 2147483647, "gates": [{"name": "a", "passed": true}, {"name": "b"}], "rocks": [{"bin": null}, {"bin": 3}],
           "head": {"radius_m": 1, "passage_m": null}, "versions": {}, "other": [1.5]})");
    EXPECT_EQ(read.at("cells").get<int>(), 2147483647);
    EXPECT_EQ(read.at("gates").at(1).at("name"), "b");
    EXPECT_EQ(document(R"({"cells": 0, "gates": []})").size(), 2u);
}

TEST(JsonDocument, names_every_value_that_is_missing_or_of_another_kind) {
    const std::vector<Mistake> mistakes = mistakes_of(
        R"({"gates": [{"name": 1, "passed": "yes"}, {}, 7], "rocks": [{"bin": -1}], "head": {"radius_m": "1", "passage_m": []}, "versions": 0})");
    std::vector<std::string> found;
    for (const Mistake& mistake : mistakes) {
        EXPECT_EQ(mistake.where, k_file.string());
        EXPECT_EQ(mistake.remedy, "Run it again");
        EXPECT_FALSE(mistake.rule.empty());
        found.push_back(mistake.what);
    }
    const std::vector<std::string> expected{"cells is missing",      "gates[0].name = 1",         "gates[1].name is missing",
                                            "gates[2] = 7",          "gates[0].passed = \"yes\"", "rocks[0].bin = -1",
                                            "head.radius_m = \"1\"", "head.passage_m = []",       "versions = 0"};
    EXPECT_EQ(found, expected);
}

/// nlohmann's own conversion to int of each of these is undefined, or gives another number.
TEST(JsonDocument, takes_no_number_for_a_whole_one_that_int_cannot_hold) {
    for (const char* number : {"2147483648", "-1", "1.0", "2.5", "1e300", "18446744073709551615", "18446744073709551616", "true", "null"})
        EXPECT_EQ(mistakes_of(fmt::format(R"({{"cells": {}, "gates": []}})", number)).size(), 1u) << number;
}

TEST(JsonDocument, refuses_what_is_no_object_or_nested_without_end) {
    for (const std::string& text :
         {std::string(), std::string("[]"), std::string("{\"cells\": 1"), std::string("{\"cells\": 1e999}"),
          "{\"cells\": 1, \"a\": " + std::string(100000, '[') + std::string(100000, ']') + "}", std::string(100000, '[')})
        EXPECT_EQ(mistakes_of(text).size(), 1u) << text.substr(0, 40);
    fs::remove(k_file);
    EXPECT_THROW(read_json_document(k_file, {}, ""), UserError);
    EXPECT_THROW(read_json_document(k_file.parent_path(), {}, ""), UserError);
}

}  // namespace
}  // namespace cutterflow
