// The fuzzer finds what it is there for: planted deaths, hangs, defects and changed inputs, each at its input.
#include "validation/fuzz/trials.hpp"

#include <csignal>
#include <fstream>
#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "validation/fuzz/kinds.hpp"
#include "validation/fuzz/mutation.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

const fs::path k_folder = fs::path(CUTTERFLOW_BUILD_DIR) / "tests" / "fuzz_trials";

/// Reads its input and does `act` with its length.
FuzzKind kind_that(const std::function<void(std::size_t length, const fs::path& file)>& act) {
    FuzzKind kind;
    kind.name = "planted";
    kind.seeds = {{"input.txt", "some words of a file\nwith a second line\n"}};
    kind.read = [act](const fs::path& folder, const std::string& file) { act(fs::file_size(folder / file), folder / file); };
    return kind;
}

FuzzCounts ends_of(const FuzzKind& kind, std::uint64_t count) {
    return try_inputs(kind, 7, 0, count, {0.2, 0}, k_folder);
}

std::uint64_t expected(const FuzzKind& kind, std::uint64_t count, const std::function<bool(std::size_t)>& belongs) {
    std::uint64_t number = 0;
    for (std::uint64_t i = 0; i < count; ++i) number += belongs(fuzz_input(kind, 7, i).content.size()) ? 1 : 0;
    return number;
}

bool is_odd(std::size_t length) {
    return length % 2 == 1;
}

TEST(Trials, count_the_exit_codes_of_the_command_line) {
    const FuzzKind kind = kind_that([](std::size_t length, const fs::path&) {
        if (is_odd(length)) throw UserError("odd", "even", "add one");
    });
    FuzzCounts counts = ends_of(kind, 700);  // more than one process takes
    const std::uint64_t odd = expected(kind, 700, is_odd);
    ASSERT_GT(odd, 0u);
    EXPECT_EQ(counts.ends[FuzzEnd::user_input], odd);
    EXPECT_EQ(counts.ends[FuzzEnd::done], 700 - odd);
    EXPECT_TRUE(counts.findings.empty());
}

TEST(Trials, find_defects_deaths_hangs_and_changed_inputs) {
    const std::vector<std::pair<FuzzEnd, std::function<void(const fs::path&)>>> planted{
        {FuzzEnd::defect, [](const fs::path&) { throw std::runtime_error("no message for the user"); }},
        {FuzzEnd::defect, [](const fs::path&) { std::vector<int>().at(1); }},
        {FuzzEnd::died, [](const fs::path&) { std::raise(SIGSEGV); }},
        {FuzzEnd::died, [](const fs::path&) { std::_Exit(3); }},
#ifdef __SANITIZE_ADDRESS__
        {FuzzEnd::died,  // AddressSanitizer
         [](const fs::path& file) {
             const std::vector<char> bytes(8);
             volatile char beyond = bytes.data()[8 + file.native().size() % 2];
             (void)beyond;
         }},
        {FuzzEnd::died,  // UndefinedBehaviorSanitizer
         [](const fs::path& file) {
             volatile int number = static_cast<int>(1e300 * static_cast<double>(file.native().size()));
             (void)number;
         }},
        {FuzzEnd::died,  // either of them, in a child process of the reader
         [](const fs::path&) {
             throw UserError(fmt::format("the importer (assimp) ended with code {}", k_sanitizer_exit_code), "rule", "remedy");
         }},
#endif
        {FuzzEnd::hung,
         [](const fs::path&) {
             for (volatile bool go_on = true; go_on;) {
             }
         }},
        {FuzzEnd::input_changed, [](const fs::path& file) { std::ofstream(file, std::ios::app) << "more"; }}};
    const auto is_rare = [](std::size_t length) { return length % 16 == 3; };
    for (const auto& [end, act] : planted) {
        const FuzzKind kind = kind_that([&](std::size_t length, const fs::path& file) {
            if (is_rare(length)) act(file);
        });
        FuzzCounts counts = ends_of(kind, 60);
        const std::uint64_t rare = expected(kind, 60, is_rare);
        ASSERT_GT(rare, 0u);
        EXPECT_EQ(counts.ends[end], rare) << fuzz_end_name(end);
        EXPECT_EQ(counts.ends[FuzzEnd::done], 60 - rare) << fuzz_end_name(end);
        ASSERT_EQ(counts.findings.size(), rare);
        for (const FuzzFinding& finding : counts.findings) {
            EXPECT_TRUE(is_rare(finding.input.size()));
            EXPECT_EQ(finding.input, fuzz_input(kind, 7, finding.index).content);
        }
    }
}

/// Else mutants of what is refused anyway would be tried.
TEST(Kinds, begin_with_files_that_are_read) {
    for (const FuzzKind& kind : fuzz_kinds()) {
        fs::remove_all(k_folder);
        fs::create_directories(k_folder);
        if (kind.around) kind.around(k_folder);
        for (const FuzzSeed& seed : kind.seeds) write_file(k_folder / seed.file, seed.content);
        for (const FuzzSeed& seed : kind.seeds) EXPECT_NO_THROW(kind.read(k_folder, seed.file)) << kind.name << " " << seed.file;
    }
}

/// Else next to all mutants of a JSON file would end in the parser.
TEST(Mutations, of_a_json_file_are_often_json_of_other_values) {
    FuzzKind kind = kind_that([](std::size_t, const fs::path&) {});
    const std::string good = R"({"cells": 61240, "gates": [{"name": "skewness", "passed": true}], "head": {"radius_m": 0.4}})";
    kind.seeds = {{"input.json", good}};
    std::size_t documents = 0;
    std::set<nlohmann::json::value_t> kinds;
    for (std::uint64_t i = 0; i < 500; ++i) {
        const nlohmann::json document = nlohmann::json::parse(fuzz_input(kind, 7, i).content, nullptr, false);
        if (document.is_discarded() || document == nlohmann::json::parse(good)) continue;
        ++documents;
        if (document.is_object() && document.contains("cells")) kinds.insert(document["cells"].type());
    }
    EXPECT_GT(documents, 125u);
    EXPECT_GE(kinds.size(), 6u);
}

TEST(Mutations, are_the_same_for_the_same_seed_and_many_for_many_indices) {
    const FuzzKind kind = kind_that([](std::size_t, const fs::path&) {});
    std::set<std::string> inputs;
    for (std::uint64_t i = 0; i < 500; ++i) {
        const std::string input = fuzz_input(kind, 7, i).content;
        EXPECT_EQ(input, fuzz_input(kind, 7, i).content);
        inputs.insert(input);
    }
    EXPECT_GT(inputs.size(), 450u);
    EXPECT_NE(fuzz_input(kind, 7, 0).content, fuzz_input(kind, 8, 0).content);
}

}  // namespace
}  // namespace cutterflow::validation
