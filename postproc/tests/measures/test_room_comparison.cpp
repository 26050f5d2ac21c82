/// Runs of rooms beside each other: what is told of runs without measures and of runs that were stopped.
#include <filesystem>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/sphere.hpp"
#include "postproc/analysis/measures/measure_run.hpp"
#include "postproc/pages/measures/measure_figures.hpp"
#include "postproc/pages/room/room_page.hpp"
#include "postproc/pages/room/room_pictures.hpp"
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

TEST_F(RoomComparison, says_what_a_run_of_a_room_has) {
    try {
        compare_room_runs({run("one", 0.8, true), folder_});
        FAIL() << "a folder of runs is none";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("is no run of a room. A run of a room has a room.json"));
    }
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

class RoomReport : public ::testing::Test {
protected:
    RoomReport() {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        run_ = testing::fresh_directory(fmt::format("room_report_{}", test->name()));
        room_ = json::parse(R"({"name": "bin", "end_s": 1.0, "size_m": [0.1, 0.1, 0.1], "medium": "none", "seed": 1, "bed": null,
                                "grains": [], "solids": []})");
        write_file(run_ / "postProcessing/rock/vtk/rocks_1.vtp", picture());
    }

    /// One grain that lies on the floor.
    static std::string picture() {
        std::string text = "<VTKFile>\n";
        for (const auto& [name, value] :
             {std::pair{"Points", "0 0 0.005"}, {"diameter", "0.01"}, {"density", "1000"}, {"velocity", "0 0 0"}})
            text += fmt::format("<DataArray type=\"Float64\" Name=\"{}\" format=\"ascii\">\n{}\n</DataArray>\n", name, value);
        return text + "</VTKFile>\n";
    }

    /// \param rows  time, number and mass of what came in, each step
    void account(const std::string& rows) {
        std::string text = "time_s,placed_count,placed_kg";
        for (const char* where : {"in_run", "removed", "extracted", "left_domain", "decided"})
            text += fmt::format(",{0}_count,{0}_kg", where);
        text += "\n";
        std::istringstream lines(rows);
        for (std::string line; std::getline(lines, line);) text += line + ",1,0.1,0,0,0,0,0,0,0,0\n";
        write_file(run_ / "postProcessing/rock/0/account.csv", text);
    }

    /// The first `bed` grains start, the others are fed, all of 10 mm and 1000 kg/m3.
    void events(int bed, int fed) {
        std::string text =
            "time_s,id,surface,direction,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,rotor_angle_rad,azimuth_rad,axial_m,diameter_m,density_kg_m3,"
            "bin\n";
        for (int id = 1; id <= bed + fed; ++id)
            text += fmt::format("0,{},{},in,0,0,0,0,0,0,0,0,0,0.01,1000,\n", id, id <= bed ? "start" : "feed");
        write_file(run_ / "postProcessing/rock/0/events.csv", text);
    }

    json results() {
        write_file(run_ / k_room_file, room_.dump());
        page_ = read_file(write_room_report(run_));
        return json::parse(read_file(run_ / "report/results.json"));
    }

    fs::path run_;
    json room_;
    std::string page_;
};

/// Its axis was pressed with it: a solid whose file stands there moves alike.
TEST(RoomPictures, show_a_pressed_solid_that_turns_where_it_is) {
    const json turn = {{"origin_m", {0.0, 0.0, 0.04}}, {"axis", {0.0, 1.0, 0.0}}, {"speed_rad_s", 0.5}, {"from_s", 1.0}, {"to_s", 4.0}};
    const json pressed{{"turn", turn}, {"pressed_m", {0.002, 0.0, -0.01}}};
    json there{{"turn", turn}};
    there["turn"]["origin_m"] = {0.002, 0.0, 0.03};
    const Vec3 point(0.02, 0.01, 0.05), way(0.002, 0.0, -0.01);
    for (const double time : {0.0, 2.0, 5.0})
        EXPECT_NEAR((moved_point(pressed, time, point) - moved_point(there, time, point + way)).norm(), 0.0, 1e-15) << time;
    EXPECT_GT((moved_point(pressed, 5.0, point) - point - way).norm(), 0.01);
}

/// The first row of the account is of the end of the first step.
TEST_F(RoomReport, counts_what_was_fed_at_the_beginning) {
    const double grain = 1000.0 * sphere_volume(0.01);
    room_["fed_kg"] = 2.0 * grain;
    account(fmt::format("0.1,3,{}\n1,4,{}\n", 3.0 * grain, 4.0 * grain));
    events(2, 2);
    EXPECT_NEAR(results().at("account").at("fed").at("kg").get<double>(), 2.0 * grain, 1e-9 * grain);
    EXPECT_THAT(page_, AllOf(HasSubstr("Feeds gave 0.001047 of 0.001047 kg."), Not(HasSubstr("found no room"))));
}

TEST_F(RoomReport, tells_what_extractions_took_and_what_the_solver_warned_of) {
    room_["extract_kg"] = 1.0;
    room_["bed"] = {{"name", "b"}, {"poured", 1}, {"poured_kg", 0.1}, {"parts", 1}};
    account("0.1,1,0.1\n");
    events(1, 0);
    write_file(run_ / "bed/1/postProcessing/cost/0/cost.json", R"({"warnings": ["time 0 s: events[0] (freeze) finds no rock"]})");
    write_file(run_ / "postProcessing/cost/0/warnings.txt", "time 0.5 s: events[0] (extract) is starved\n");
    EXPECT_EQ(results().at("warnings"),
              json::array({"bed/1: time 0 s: events[0] (freeze) finds no rock", "time 0.5 s: events[0] (extract) is starved"}));
    EXPECT_THAT(page_, AllOf(HasSubstr("Extractions took 0 of 1 kg: the rest"), HasSubstr("<p class=\"notice\">bed/1: time 0 s")));
    std::string many;
    for (int n = 0; n < 12; ++n) many += fmt::format("w{}\n", n);
    write_file(run_ / "postProcessing/cost/0/warnings.txt", many);
    const json told = results().at("warnings");
    ASSERT_EQ(told.size(), 11U);
    EXPECT_EQ(told.back(), "3 more are in postProcessing/cost/*/warnings.txt");
}

TEST_F(RoomReport, counts_one_grain_as_one) {
    room_["bed"] = {{"name", "b"}, {"poured", 1}, {"poured_kg", 0.1}, {"parts", 1}};
    results();
    EXPECT_THAT(page_, AllOf(HasSubstr("1 grain poured, 0.1 kg, in 1 part;"), HasSubstr("1 s; 1 grain; blue"), Not(HasSubstr("1 grains"))));
}

TEST_F(RoomReport, says_which_grains_are_clumps) {
    json kind{{"name", "rods"}, {"density_kg_m3", 2500}, {"smallest_m", 0.004}, {"largest_m", 0.005}};
    room_["grains"].push_back(kind);
    results();
    EXPECT_THAT(page_, AllOf(HasSubstr("2500 kg/m3, 4 to 5 mm"), Not(HasSubstr("clumps of"))));
    room_["grains"][0]["clump"] = "rod.clump";
    results();
    EXPECT_THAT(page_, HasSubstr("4 to 5 mm (diameters of spheres of their volume); clumps of rod.clump"));
}

TEST_F(RoomReport, names_the_key_that_selects_the_turbulence_model) {
    write_file(run_ / "postProcessing/cost/0/cost.json",
               R"({"models": [{"name": "turbulence: laminar", "why": "constant/turbulenceProperties selects it"}]})");
    results();
    EXPECT_THAT(page_, AllOf(HasSubstr("room.turbulence selects it"), Not(HasSubstr("turbulenceProperties"))));
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
