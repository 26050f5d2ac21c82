#include "postproc/analysis/steel/steel_work.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "postproc/pages/report.hpp"
#include "postproc/pages/steel/steel_section.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

using nlohmann::json;
using testing::SmallRun;

/// Of the small run's head: two triangles of 0.01 m2 from the ring's underside to z = -0.1, with 2 and 6 J/m2 of impact, and one of 0.03 m2
/// on the ring, all of it without.
void write_map(const SmallRun& run) {
    testing::write_text(run.directory / "postProcessing/rock/wall_work_cutter.vtp",
                        "<VTKFile>\n<DataArray type=\"Float64\" Name=\"Points\" format=\"ascii\">\n"
                        "0.3 0 0\n0.3 0.2 0\n0.3 0 -0.1\n"
                        "0.3 0.2 0\n0.3 0.2 -0.1\n0.3 0 -0.1\n"
                        "0.3 0 0.01\n0.6 0 0.01\n0.3 0.2 0.01\n</DataArray>\n"
                        "<DataArray type=\"Float64\" Name=\"impact_j_m2\" format=\"ascii\">\n2\n6\n0\n</DataArray>\n"
                        "<DataArray type=\"Float64\" Name=\"sliding_j_m2\" format=\"ascii\">\n1\n0\n0\n</DataArray>\n</VTKFile>\n");
}

/// Impact grows by 3 W on the cutter and by 0.5 W on the backplate from the first rock at 1 s on, sliding by 1 W on the cutter.
void write_work(const SmallRun& run, double end, double since = 0.0) {
    std::string text = "time_s,wall,impact_j,sliding_j,since_s\n";
    if (since > 0.0) text += "0.4,cutter,7,7,0\n0.4,backplate,7,7,0\n";  // of before an earlier program went on with the run
    for (double time = 0.5; time < end + 0.01; time += 0.25) {
        const double rock = std::max(0.0, time - std::max(1.0, since));
        text += std::to_string(time) + ",cutter," + std::to_string(3.0 * rock) + "," + std::to_string(rock) + "," + std::to_string(since) +
                "\n";
        text += std::to_string(time) + ",backplate," + std::to_string(0.5 * rock) + ",0," + std::to_string(since) + "\n";
    }
    testing::write_text(run.directory / "postProcessing/rock/0/wall_work.csv", text);
}

json steel_of(const SmallRun& run) {
    const RunData data = read_run(run.directory);
    return results_json(compute_results(data), data).at("steel_work");
}

/// The section of the page; drawing takes a second where there is a map.
std::string section_of(const SmallRun& run) {
    const RunData data = read_run(run.directory);
    return steel_section(compute_results(data), data, Page(run.directory / "page.html", PageForm::live));
}

TEST(SteelWork, of_a_batch_is_over_the_time_with_rock_and_per_placed_rock) {
    SmallRun run("steel_batch");
    run.write();
    write_work(run, 2.0);
    write_map(run);
    const json steel = steel_of(run);
    EXPECT_NEAR(steel.at("window_start_s").get<double>(), 1.0, 1e-9);
    EXPECT_NEAR(steel.at("window_end_s").get<double>(), 2.0, 1e-9);
    const json& cutter = steel.at("walls").at(0);
    EXPECT_EQ(cutter.at("name"), "cutter");
    EXPECT_NEAR(cutter.at("impact_w").get<double>(), 3.0, 1e-6);
    EXPECT_NEAR(cutter.at("sliding_w").get<double>(), 1.0, 1e-6);
    EXPECT_NEAR(cutter.at("impact_j_per_kg_fed").get<double>(), 3.0 / (16.0 * testing::small_rock_mass()), 1e-4);
    EXPECT_NEAR(cutter.at("impact_j_per_kg_delivered").get<double>(), 3.0 / (3.0 * testing::small_rock_mass()), 1e-3);
    EXPECT_NEAR(steel.at("walls").at(1).at("impact_w").get<double>(), 0.5, 1e-6);
}

// Energy goes to the bins by area, and 0.08 J are all: the lower bins have more of the second triangle.
TEST(SteelWork, by_axial_bin_holds_all_energy_of_the_map) {
    SmallRun run("steel_bins");
    run.write();
    write_work(run, 2.0);
    write_map(run);
    const json steel = steel_of(run);
    double impact = 0.0, area = 0.0;
    for (const json& bin : steel.at("cutter_bins")) {
        impact += bin.at("impact_j").get<double>();
        area += bin.at("area_m2").get<double>();
    }
    EXPECT_NEAR(impact, 0.01 * (2.0 + 6.0), 1e-12);
    EXPECT_NEAR(area, 0.05, 1e-12);
    const json& ring = steel.at("cutter_bins").at(0);
    EXPECT_EQ(ring.at("name"), "gap");
    EXPECT_NEAR(ring.at("area_m2").get<double>(), 0.03, 1e-12);
    EXPECT_EQ(ring.at("impact_j"), 0.0);
    const json &upper = steel.at("cutter_bins").at(1), &lower = steel.at("cutter_bins").at(3);
    EXPECT_LT(upper.at("impact_w_m2").get<double>(), lower.at("impact_w_m2").get<double>());
    EXPECT_NEAR(steel.at("impact_highest_w_m2").get<double>(), 6.0, 1e-6);
    EXPECT_NEAR(steel.at("sliding_highest_w_m2").get<double>(), 1.0, 1e-6);
}

TEST(SteelWork, of_a_head_that_is_fed_is_that_of_its_production) {
    SmallRun run("steel_fed");
    run.write();
    testing::make_fed(run, 0.0);
    write_work(run, 31.0);
    const RunData data = read_run(run.directory);
    const Results results = compute_results(data);
    ASSERT_TRUE(results.fed.has_value());
    const std::optional<SteelWork>& work = results.steel;
    ASSERT_TRUE(work.has_value());
    EXPECT_NEAR(work->from, results.fed->production.from, 1e-9);
    EXPECT_GT(work->from, 2.0);
    EXPECT_NEAR(work->walls.at(0).energy.impact / work->fed, 0.3, 1e-3);        // 3 W over 10 kg/s
    EXPECT_NEAR(work->walls.at(0).energy.impact / work->delivered, 0.5, 5e-3);  // of which 60 % are delivered
    EXPECT_FALSE(work->cutter.has_value()) << "there is no map";
}

TEST(SteelWork, counts_from_the_checkpoint_of_an_earlier_program_and_says_so) {
    SmallRun run("steel_later");
    run.write();
    write_work(run, 2.0, 1.5);
    const json steel = steel_of(run);
    EXPECT_NEAR(steel.at("window_start_s").get<double>(), 1.5, 1e-9);
    EXPECT_NEAR(steel.at("walls").at(0).at("impact_w").get<double>(), 3.0, 1e-6);
    EXPECT_NE(section_of(run).find("Counted from t = 1.5 s on"), std::string::npos);
}

TEST(SteelWork, is_on_the_page_with_its_scaling_and_what_it_is_not) {
    SmallRun run("steel_page");
    run.length_ratio = 4.0;
    run.write();
    write_work(run, 2.0);
    write_map(run);
    const std::string page = testing::read_text(write_report(run.directory).page_file);
    for (const char* part : {"What rock does to the steel", "energy times 256 (length⁴), per area times 16 (length²)", "no load on a pick",
                             "not how much of it is lost", "above the ring’s top face", "6 W/m² and more",
                             "Cutter head from the hub, coloured by the work of rock on its steel", "backplate"})
        EXPECT_NE(page.find(part), std::string::npos) << part;
}

TEST(SteelWork, of_a_run_of_an_earlier_program_is_none) {
    SmallRun run("steel_none");
    run.write();
    EXPECT_TRUE(steel_of(run).is_null());
    EXPECT_EQ(section_of(run), "");
}

TEST(WorkedSurface, of_a_file_that_a_kill_cut_off_is_refused) {
    SmallRun run("steel_cut_off");
    run.write();
    write_map(run);
    const auto file = run.directory / "postProcessing/rock/wall_work_cutter.vtp";
    const std::string whole = testing::read_text(file);
    EXPECT_EQ(read_worked_surface(file).per_area.at(1).impact, 6.0);
    testing::write_text(file, whole.substr(0, whole.size() / 2));
    EXPECT_THROW(read_worked_surface(file), UserError);
}

}  // namespace
}  // namespace cutterflow::postproc
