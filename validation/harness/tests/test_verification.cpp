#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/verification.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

const fs::path k_folder = fs::temp_directory_path() / "cutterflow_verification_record";

int run(const std::function<void(Verification&)>& body, std::string effort = "standard") {
    fs::remove_all(k_folder);
    std::string program = "case", folder = k_folder.string();
    char* arguments[] = {program.data(), effort.data(), folder.data()};
    return verify(3, arguments, body);
}

std::vector<std::string> verdicts() {
    std::vector<std::string> words;
    for (const auto& row : nlohmann::json::parse(read_file(k_folder / "quantities.json"))) words.push_back(row.at("verdict"));
    return words;
}

TEST(VerificationRecord, judges_each_rule_at_its_tolerance) {
    const About about{"exact", "", {}};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const int code = run([&](Verification& record) {
        record.relative("a", "m", 1.009, 1.0, 0.01, about);
        record.relative("b", "m", -0.989, -1.0, 0.01, about);
        record.relative("c", "m", -1.0, 1.0, 0.01, about);
        record.absolute("d", "m", -0.5, -0.6, 0.2, about);
        record.absolute("e", "m", -0.5, 0.5, 0.2, about);
        record.at_most("f", "m", 1e-9, 1e-8, about);
        record.at_most("g", "m", 1e-7, 1e-8, about);
        record.at_least("h", "-", 1.9, 1.8, about);
        record.at_least("i", "-", 1.7, 1.8, about);
        record.report("j", "s", 3.0, 4.0, about);
        record.relative("k", "m", nan, 1.0, 0.01, about);
        record.at_most("l", "m", nan, 1.0, about);
        record.at_least("m", "m", nan, 1.0, about);
        record.not_converged("n", "m", about);
    });
    EXPECT_EQ(code, 4);
    EXPECT_THAT(verdicts(), ::testing::ElementsAre("pass", "fail", "fail", "pass", "fail", "pass", "fail", "pass", "fail", "reported",
                                                   "fail", "fail", "fail", "not converged"));
}

TEST(Largest, keeps_a_not_a_number_wherever_it_stands) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(larger(1.0, 2.0), 2.0);
    EXPECT_EQ(larger(2.0, -1.0), 2.0);
    EXPECT_EQ(largest({-3.0, -1.0, -2.0}), -1.0);
    for (const std::vector<double>& values : {std::vector{nan, 1.0, 2.0}, {1.0, nan, 2.0}, {1.0, 2.0, nan}, {nan}})
        EXPECT_TRUE(std::isnan(largest(values)));
    EXPECT_THROW(largest({}), std::runtime_error);
}

TEST(VerificationRecord, ends_as_the_case_did) {
    const About about{"exact", "", {}};
    EXPECT_EQ(run([&](Verification& record) { record.at_most("a", "m", 0.0, 1.0, about); }), 0);
    EXPECT_EQ(run([&](Verification& record) { record.not_converged("a", "m", about); }), 4);
    EXPECT_EQ(run([&](Verification& record) { record.report("a", "m", 1.0, {}, {"NoSuchPaper", "", {}}); }), 2);
    EXPECT_EQ(run([](Verification&) { throw std::runtime_error("broken"); }), 1);
    EXPECT_EQ(run([](Verification&) {}, "quick"), 2);
}

TEST(VerificationRecord, knows_how_much_is_wanted) {
    run([](Verification& record) { EXPECT_FALSE(record.wants(Effort::standard)); }, "fast");
    run([](Verification& record) { EXPECT_TRUE(record.wants(Effort::fast) && record.wants(Effort::standard)); }, "standard");
    run([](Verification& record) { EXPECT_TRUE(record.wants(Effort::longest)); }, "long");
}

}  // namespace
}  // namespace cutterflow::validation
