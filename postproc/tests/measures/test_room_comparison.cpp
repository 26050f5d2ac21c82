/// Runs of rooms beside each other: what is told of runs without measures and of runs that were stopped.
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "postproc/analysis/measures/measure_run.hpp"
#include "postproc/pages/measures/measure_figures.hpp"
#include "postproc/pages/room/room_page.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class RoomComparison : public ::testing::Test {
protected:
    RoomComparison() {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = testing::fresh_directory(fmt::format("room_comparison_{}", test->name()));
    }

    /// A run of 0.8 s whose last start has come to `reached` [s].
    fs::path run(const std::string& name, double reached, bool finished) {
        const fs::path run = folder_ / name;
        write_file(run / k_room_file, R"({"name": "heap", "end_s": 0.8})");
        write_file(run / k_measures, R"([{"name": "mass", "what": "mass_in"}])");
        write_file(run / k_measure_results, R"({"mass": {"what": "mass_in", "value": 2.5, "unit": "kg", "standard_error": null,
                                                         "detail": {}, "series": null}})");
        write_file(run / "postProcessing/cost/0/cost.csv", "time_s\n0.1\n0.2\n");
        write_file(run / "postProcessing/cost/0.2/cost.csv", fmt::format("time_s\n0.3\n{}\n", reached));
        if (finished) write_file(run / "postProcessing/cost/0.2/cost.json", R"({"steps": 4})");
        return run;
    }

    fs::path folder_;
};

TEST_F(RoomComparison, names_the_runs_that_have_not_come_to_their_end) {
    const fs::path done = run("a_repeat1", 0.6, true), stopped = run("a_repeat2", 0.45, false);  // the first by its stop rule
    const std::vector<SettingResults> settings = compare_room_runs({done, stopped});
    const std::string told = stopped.string() + " is not finished: it has come to 0.45 of 0.8 s";
    EXPECT_THAT(setting_comparison_text(settings), AllOf(HasSubstr("warning: " + told), Not(HasSubstr("a_repeat1"))));
    EXPECT_EQ(room_comparison_json(settings).at("warnings"), json::array({told}));
    EXPECT_THAT(read_file(write_room_comparison(settings, folder_ / "comparison")), HasSubstr("<p class=\"notice\">" + told));
    EXPECT_EQ(unfinished_room(done), "");
    fs::remove_all(stopped / "postProcessing");
    EXPECT_EQ(unfinished_room(stopped), "") << "nothing tells";
}

TEST_F(RoomComparison, says_that_a_study_has_no_measure) {
    const fs::path one = run("one", 0.8, true), none = run("none", 0.8, true);
    write_file(none / k_measures, "[]");
    fs::remove(none / k_measure_results);
    try {
        compare_room_runs({one, none});
        FAIL() << "there is nothing to compare";
    } catch (const UserError& error) {
        ASSERT_EQ(error.mistakes().size(), 1U) << error.what();
        EXPECT_EQ(error.mistakes()[0].what, fmt::format("the study of {} has no [[measure]]", none.string()));
        EXPECT_THAT(error.mistakes()[0].remedy, HasSubstr("repeat cutterflow run STUDY -o " + none.string()));
    }
}

TEST(MeasureFigures, an_angle_of_no_grains_has_no_figure) {
    const json results{{"slope",
                        {{"what", "angle"},
                         {"value", nullptr},
                         {"unit", "deg"},
                         {"standard_error", nullptr},
                         {"detail", {{"reason", "no angle: no grains above the base"}, {"sides", json::array()}}},
                         {"series", {{"silhouettes", json::array()}}}}}};
    EXPECT_TRUE(measure_figures(results).empty());
}

}  // namespace
}  // namespace cutterflow::postproc
