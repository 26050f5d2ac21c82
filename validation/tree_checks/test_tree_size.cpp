/// What is under version control stays light: nobody clones libraries that stand inside generated pages, or a file larger than a mebibyte.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/base/file_content.hpp"
#include "geometry/base/process/child_process.hpp"

namespace {

namespace fs = std::filesystem;

const fs::path k_root = CUTTERFLOW_SOURCE_DIR;
constexpr std::uintmax_t k_largest_file = 1u << 20;
constexpr std::uintmax_t k_most_published = 2'000'000;  // bytes of results, their pages and pictures; sources grow with the program

/// Files under version control; empty in a copy of the sources without .git, or without git.
std::vector<fs::path> tracked_files() {
    if (!fs::exists(k_root / ".git") || cutterflow::find_program("git").empty()) return {};
    const fs::path log = fs::path(::testing::TempDir()) / "cutterflow_tracked_files";
    const auto listed = cutterflow::run_child({{"git", "-c", "safe.directory=*", "ls-files", "-z"}, k_root, log, {}});
    const std::string names = listed.exit_code == 0 ? cutterflow::read_file(log) : "";
    fs::remove(log);
    std::vector<fs::path> files;
    for (std::size_t at = 0; at < names.size();) {
        const std::string name = names.substr(at, names.find('\0', at) - at);
        at += name.size() + 1;
        if (fs::is_regular_file(k_root / name)) files.push_back(name);  // one that was just removed is still listed
    }
    return files;
}

bool is_published(const fs::path& file) {
    const std::string name = file.generic_string();
    return name.rfind("docs/results/", 0) == 0 || name.rfind("docs/images/", 0) == 0 || name == "docs/validation.md";
}

TEST(TrackedTree, holds_no_large_file_and_its_published_results_stay_light) {
    const std::vector<fs::path> files = tracked_files();
    if (files.empty()) GTEST_SKIP() << "the sources are not under git: nothing says which files are tracked";
    ASSERT_GT(files.size(), 100u);
    std::uintmax_t published = 0;
    for (const fs::path& file : files) {
        const std::uintmax_t size = fs::file_size(k_root / file);
        if (is_published(file)) published += size;
        EXPECT_LE(size, k_largest_file) << file << ": pack it, or publish it elsewhere";
    }
    EXPECT_GT(published, 0u);
    EXPECT_LE(published, k_most_published);
}

TEST(PublishedPages, hold_no_scripts_and_all_their_pictures) {
    std::size_t pages = 0;
    for (const auto& entry : fs::recursive_directory_iterator(k_root / "docs")) {
        if (entry.path().extension() != ".html") continue;
        ++pages;
        const std::string page = cutterflow::read_file(entry.path());
        EXPECT_EQ(page.find("<script"), std::string::npos) << entry.path() << ": publish with --static";
        EXPECT_NE(page.find("<svg"), std::string::npos) << entry.path();
        for (std::size_t at = page.find("<image "); at != std::string::npos; at = page.find("<image ", at + 1)) {
            const std::size_t quote = page.find("href=", at) + 5, begin = quote + 1;
            const std::string target = page.substr(begin, page.find(page[quote], begin) - begin);
            if (target.rfind("data:", 0) != 0)
                EXPECT_TRUE(fs::exists(entry.path().parent_path() / target)) << entry.path() << ": " << target;
        }
    }
    EXPECT_GT(pages, 0u);
}

}  // namespace
