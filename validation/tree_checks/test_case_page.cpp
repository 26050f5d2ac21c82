/// docs/user/your_own_case.md lists exactly the keys that the reader of constant/couplingProperties knows.
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace {

std::string content(const std::string& file) {
    std::ifstream stream(std::string(CUTTERFLOW_SOURCE_DIR) + "/" + file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::set<std::string> matches(const std::string& text, const std::regex& pattern) {
    std::set<std::string> found;
    for (std::sregex_iterator i(text.begin(), text.end(), pattern), end; i != end; ++i) found.insert((*i)[1]);
    return found;
}

TEST(CasePage, lists_the_keys_and_sections_that_the_reader_knows) {
    const std::string reader = content("solver/foam/dictionary/coupling_dictionary.cpp");
    const std::regex read_key(
        "\\b(?:read|read_choice|section|sections|read_section|read_optional|read_tabled|read_list|read_sides)\\((?:file, |section, |"
        "wall, )?\"(\\w+)\"");
    std::set<std::string> known = matches(reader, read_key);
    for (const std::string& section : matches(content("solver/ports/settings.hpp"), std::regex("\\bvisit\\(\"(\\w+)\"")))
        known.insert(section);
    const std::regex row("\\b(?:number|closure|yes_or_no|ParameterRow)\\(\\s*\"(\\w+)\"");
    for (const std::string& key : matches(content("solver/ports/setting_table.cpp"), row)) known.insert(key);
    ASSERT_GT(known.size(), 40u) << "the scan found too few keys: it looks in the wrong place";
    for (const char* other_file : {"rho", "nu", "purgeWrite"}) known.erase(other_file);

    const std::string page = content("docs/user/your_own_case.md");
    std::set<std::string> documented = matches(page, std::regex("\n\\| `(\\w+)` \\|"));
    for (const std::string& section : matches(page, std::regex("\n### (\\w+)"))) documented.insert(section);
    for (const std::string& key : known) EXPECT_EQ(documented.count(key), 1u) << key << " is read but not documented";
    for (const std::string& key : documented) EXPECT_EQ(known.count(key), 1u) << key << " is documented but not read";
}

}  // namespace
