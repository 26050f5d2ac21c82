/// The pages of docs/ and the README are consistent: links and headings exist, citations are in docs/references.bib.
#include <cctype>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/base/file_content.hpp"

namespace {

namespace fs = std::filesystem;

const fs::path k_root = CUTTERFLOW_SOURCE_DIR;

/// The README, the changelog and every Markdown page below docs/.
std::vector<fs::path> pages() {
    std::vector<fs::path> found{k_root / "README.md", k_root / "CHANGELOG.md"};
    for (const auto& entry : fs::recursive_directory_iterator(k_root / "docs"))
        if (entry.path().extension() == ".md") found.push_back(entry.path());
    return found;
}

/// A page without fenced code, in which brackets are no links.
std::string prose(const fs::path& page) {
    std::istringstream text(cutterflow::read_file(page));
    std::string result, line;
    bool code = false;
    while (std::getline(text, line)) {
        if (line.rfind("```", 0) == 0)
            code = !code;
        else if (!code)
            result += line + '\n';
    }
    return result;
}

std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
    const std::regex expression(pattern);
    std::vector<std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match) found.push_back((*match)[1]);
    return found;
}

/// The anchor that GitHub gives a heading: lower case, spaces as hyphens, punctuation dropped.
std::string anchor_of(const std::string& heading) {
    std::string anchor;
    for (const char c : heading) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == ' ')
            anchor += '-';
        else if (byte >= 0x80 || std::isalnum(byte) != 0 || c == '-' || c == '_')
            anchor += static_cast<char>(byte < 0x80 ? std::tolower(byte) : byte);
    }
    return anchor;
}

std::set<std::string> anchors_of(const fs::path& page) {
    std::set<std::string> anchors;
    for (const std::string& heading : matches(prose(page), "(?:^|\n)#+ ([^\n]*)")) anchors.insert(anchor_of(heading));
    return anchors;
}

TEST(Documentation, links_lead_to_files_and_headings_that_exist) {
    std::size_t links = 0;
    for (const fs::path& page : pages()) {
        for (const std::string& link : matches(prose(page), "\\]\\(([^)\\s]+)\\)")) {
            if (link.rfind("http", 0) == 0) continue;
            ++links;
            const std::size_t hash = link.find('#');
            const std::string path = link.substr(0, hash);
            const fs::path target = path.empty() ? page : page.parent_path() / path;
            EXPECT_TRUE(fs::exists(target)) << fs::relative(page, k_root) << ": " << link;
            if (hash == std::string::npos || target.extension() != ".md" || !fs::exists(target)) continue;
            EXPECT_EQ(anchors_of(target).count(link.substr(hash + 1)), 1u) << fs::relative(page, k_root) << ": " << link;
        }
    }
    EXPECT_GT(links, 50u);
}

TEST(Documentation, citations_are_entries_of_the_bibliography) {
    const std::vector<std::string> entries = matches(cutterflow::read_file(k_root / "docs" / "references.bib"), "@\\w+\\{([^,]+),");
    const std::set<std::string> keys(entries.begin(), entries.end());
    std::size_t citations = 0;
    for (const char* folder : {"docs/theory", "docs/design"})
        for (const auto& entry : fs::directory_iterator(k_root / folder)) {
            if (entry.path().extension() != ".md") continue;
            // [Key2001] or [Key2001, Other2002]
            for (const std::string& group : matches(prose(entry.path()), "\\[([A-Z][A-Za-z]+\\d{4}[^\\]]*|VDI[^\\]]*)\\]")) {
                std::istringstream list(group);
                for (std::string key; std::getline(list >> std::ws, key, ',');) {
                    ++citations;
                    EXPECT_EQ(keys.count(key), 1u) << fs::relative(entry.path(), k_root) << ": [" << key << "]";
                }
            }
        }
    EXPECT_GT(citations, 30u);
}

// Else verify --resume would keep a result of examples that have changed.
TEST(Documentation, verification_cases_name_the_examples_they_read) {
    std::size_t readers = 0;
    for (const auto& entry : fs::recursive_directory_iterator(k_root / "validation/cases")) {
        if (entry.path().extension() != ".cpp") continue;
        const std::string readme = cutterflow::read_file(entry.path().parent_path() / "README.md");
        for (const std::string& example : matches(cutterflow::read_file(entry.path()), R"re(cases/examples/([A-Za-z0-9_]+))re")) {
            ++readers;
            EXPECT_NE(readme.find("\n- examples: " + example + "\n"), std::string::npos) << entry.path() << " reads " << example;
        }
    }
    EXPECT_GT(readers, 2u);
}

}  // namespace
