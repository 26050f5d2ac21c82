/// Measures of a whole run directory: its files, its restarts, its mistakes; and their figures.
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/profiles/profile.hpp"
#include "geometry/base/sphere.hpp"
#include "postproc/analysis/measures/measure_run.hpp"
#include "postproc/analysis/measures/measure_source.hpp"
#include "postproc/analysis/measures/measure_table.hpp"
#include "postproc/draw/gnuplot.hpp"
#include "postproc/pages/measures/measure_figures.hpp"
#include "postproc/tests/measures/packed_grains.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double k_d = 0.01, k_density = 2650.0;

class MeasuredRun : public ::testing::Test {
protected:
    MeasuredRun() {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        run_ = testing::fresh_directory(fmt::format("measured_run_{}", test->name()));
    }

    void write(const std::string& file, const std::string& text) { write_file(run_ / file, text); }

    void picture(double time, const Grains& grains) {
        std::string text = "<VTKFile>\n";
        const auto array = [&](const char* name, const auto& value) {
            text += fmt::format("<DataArray type=\"Float64\" Name=\"{}\" format=\"ascii\">\n", name);
            for (std::size_t n = 0; n < grains.size(); ++n) text += value(n) + "\n";
            text += "</DataArray>\n";
        };
        const auto vector = [](const Vec3& v) { return fmt::format("{:.9g} {:.9g} {:.9g}", v[0], v[1], v[2]); };
        array("Points", [&](std::size_t n) { return vector(grains.position[n]); });
        array("diameter", [&](std::size_t n) { return fmt::format("{:.9g}", grains.diameter[n]); });
        array("density", [&](std::size_t n) { return fmt::format("{:.9g}", grains.density[n]); });
        array("velocity", [&](std::size_t n) { return vector(grains.velocity[n]); });
        write(fmt::format("postProcessing/rock/vtk/rocks_{:g}.vtp", time), text + "</VTKFile>\n");
    }

    /// Grains leave one by one through the gate, 0.1 s apart; the run was resumed at 2 s.
    void crossings() {
        std::string first = "time_s,gate,id,direction,mass_kg\n", second = first;
        for (int n = 1; n <= 40; ++n) {
            const std::string row = fmt::format("{:.2f},{},{},1,0.5\n", 0.1 * n, n % 2 == 0 ? "outlet" : "other", n);
            if (n <= 25) first += row;  // rows after 2 s were done again
            if (n > 20) second += row;
        }
        write("postProcessing/rock/0/gates.csv", first);
        write("postProcessing/rock/2/gates.csv", second);
        write("postProcessing/cost/0/cost.csv", "time_s\n2.5\n");
        write("postProcessing/cost/2/cost.csv", "time_s\n5\n");
    }

    /// Twelve grains in a region that they leave at 2 a second, from the start on; the first picture is that of 1 s.
    void emptying_region() {
        for (int second = 1; second <= 5; ++second) picture(second, column_of(12 - 2 * second));
    }
    static Grains column_of(int count) {
        Grains grains;
        for (int n = 0; n < count; ++n) grains.add({0.0, 0.0, (n + 0.5) * k_d}, Vec3::Zero(), k_d, k_density);
        return grains;
    }

    fs::path run_;
};

TEST_F(MeasuredRun, counts_what_passes_a_gate_once_through_a_restart) {
    crossings();
    write(k_measures, R"([{"name": "outlet", "what": "passed_mass", "gate": {"disc_m": [0, 0, 0], "radius_m": 0.1}},
                          {"name": "part", "what": "passed_mass", "gate": "outlet", "from_s": 1, "to_s": 2},
                          {"name": "none", "what": "passed_mass", "gate": "absent"},
                          {"name": "flow", "what": "rate", "gate": "outlet", "from_s": 0.5, "to_s": 3.5},
                          {"name": "middle", "what": "rate", "gate": "outlet"},
                          {"name": "half", "what": "time_of", "gate": "outlet", "share": 0.5},
                          {"name": "never", "what": "time_of", "gate": "outlet", "share": 1, "of_kg": 20}])");
    const json results = write_measures(run_);
    const auto value = [&](const char* name) { return results[name]["value"].get<double>(); };
    EXPECT_NEAR(value("outlet"), 10.0, 1e-12);
    EXPECT_NEAR(value("part"), 2.5, 1e-12);
    EXPECT_EQ(value("none"), 0.0);
    EXPECT_NEAR(value("flow"), 2.5, 0.05);
    EXPECT_NEAR(value("middle"), 2.5, 0.1);
    EXPECT_NEAR(value("half"), 2.0, 1e-9);
    EXPECT_TRUE(results["never"]["value"].is_null());
    EXPECT_THAT(results["never"]["detail"]["reason"].get<std::string>(), HasSubstr("not 20"));
    EXPECT_FALSE(results["flow"]["standard_error"].is_null());
    EXPECT_EQ(read_measures(run_), results);
    EXPECT_EQ(measure_figures(results).size(), 6U);
}

// Times that are nearer to each other than the name of a start's folder tells are the same time, not the same grain or wall.
TEST_F(MeasuredRun, keeps_what_was_recorded_just_before_a_restart) {
    const std::string gates = "time_s,gate,id,direction,mass_kg\n", walls = "time_s,wall,force_x_n,force_y_n,force_z_n\n";
    write("postProcessing/rock/0/gates.csv", gates + "1,outlet,1,1,0.5\n1.999999,outlet,2,1,0.5\n2,outlet,3,1,0.5\n");
    write("postProcessing/rock/2/gates.csv", gates + "2,outlet,3,1,0.5\n2.000001,outlet,4,1,0.5\n2.000001,outlet,3,-1,0.5\n");
    write("postProcessing/rock/0/walls.csv", walls + "1,lid,1,0,0\n1,floor,4,0,0\n2,lid,3,0,0\n2,floor,4,0,0\n");
    write("postProcessing/rock/2/walls.csv", walls + "2.000001,floor,4,0,0\n3,floor,4,0,0\n");
    EXPECT_NEAR(MeasureSource(run_).through_gate("outlet").total(), 3 * 0.5, 1e-12);
    EXPECT_EQ(MeasureSource(run_).wall_force("lid", "x").value, (std::vector<double>{1, 3}));
}

const char* const k_emptying = R"([
    {"name": "first", "what": "rate", "region": {"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, 1]}}, "from_s": 0, "to_s": 3},
    {"name": "later", "what": "rate", "region": {"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, 1]}}, "from_s": 1, "to_s": 3},
    {"name": "middle", "what": "rate", "region": {"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, 1]}}},
    {"name": "half", "what": "time_of", "region": {"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, 1]}}, "share": 0.5}])";

TEST_F(MeasuredRun, counts_what_leaves_a_region_from_the_start_of_the_run_on) {
    emptying_region();
    std::string events =
        "time_s,id,surface,direction,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,rotor_angle_rad,azimuth_rad,axial_m,diameter_m,density_kg_m3,bin\n";
    for (int n = 0; n < 12; ++n)  // two of them are fed at once, another one leaves the room later
        events += fmt::format("0,{},{},in,0,0,{},0,0,0,0,0,0,{},{},\n", n + 1, n < 10 ? "start" : "feed", (n + 0.5) * k_d, k_d, k_density);
    write("postProcessing/rock/0/events.csv", events + fmt::format("0.5,12,domain,out,0,0,1,0,0,0,0,0,0,{},{},\n", k_d, k_density));
    write(k_measures, k_emptying);
    const json results = measure_run(run_);
    const double rate = 2.0 * sphere_mass(k_d, k_density);
    for (const char* name : {"first", "later", "middle"}) EXPECT_NEAR(results[name]["value"].get<double>(), rate, 1e-6 * rate) << name;
    EXPECT_NEAR(results["half"]["value"].get<double>(), 2.5, 1e-6);
}

TEST_F(MeasuredRun, has_no_rate_before_the_first_picture_where_nothing_tells_of_it) {
    emptying_region();
    write(k_measures, k_emptying);
    const json results = measure_run(run_);
    const double rate = 2.0 * sphere_mass(k_d, k_density);
    EXPECT_NEAR(results["later"]["value"].get<double>(), rate, 1e-6 * rate);
    for (const char* name : {"first", "middle", "half"}) {
        EXPECT_TRUE(results[name]["value"].is_null()) << name;
        EXPECT_THAT(results[name]["detail"]["reason"].get<std::string>(), HasSubstr("the first picture is of 1 s")) << name;
    }
}

TEST_F(MeasuredRun, refuses_a_gate_that_a_room_does_not_have) {
    crossings();
    write("room.json", R"({"gates": ["outlet", "never"]})");
    write(k_measures, R"([{"name": "a", "what": "passed_mass", "gate": "never"}])");
    EXPECT_EQ(write_measures(run_)["a"]["value"], 0.0);
    write(k_measures, R"([{"name": "a", "what": "passed_mass", "gate": "nevr"}])");
    EXPECT_THROW(write_measures(run_), UserError);
}

TEST_F(MeasuredRun, tells_when_the_run_ends_before_a_window) {
    crossings();
    write(k_measures, R"([{"name": "within", "what": "passed_mass", "gate": "outlet", "from_s": 3, "to_s": 5},
                          {"name": "partly", "what": "passed_mass", "gate": "outlet", "from_s": 3, "to_s": 6},
                          {"name": "after", "what": "passed_mass", "gate": "outlet", "from_s": 5, "to_s": 6},
                          {"name": "later", "what": "passed_mass", "gate": "outlet", "from_s": 6}])");
    const json results = measure_run(run_);
    EXPECT_FALSE(results["within"]["detail"].contains("reason"));
    EXPECT_EQ(results["partly"]["value"], results["within"]["value"]);
    EXPECT_EQ(results["partly"]["detail"]["to_s"], 5.0);
    EXPECT_EQ(results["partly"]["detail"]["reason"], "the run ends at 5 s, in the window of 3 to 6 s");
    for (const char* name : {"after", "later"}) {
        EXPECT_TRUE(results[name]["value"].is_null()) << name;
        EXPECT_THAT(results[name]["detail"]["reason"].get<std::string>(), HasSubstr("the run ends at 5 s, before the window")) << name;
    }
}

TEST_F(MeasuredRun, makes_one_measure_anew_and_keeps_the_others) {
    crossings();
    write(k_measures, R"([{"name": "a", "what": "passed_mass", "gate": "outlet"}, {"name": "b", "what": "passed_mass", "gate": "other"}])");
    json before = write_measures(run_);
    before["b"]["value"] = 77.0;
    write(k_measure_results, before.dump());
    const json after = write_measures(run_, "a");
    EXPECT_EQ(after["b"]["value"], 77.0);
    EXPECT_EQ(after["a"]["value"], 10.0);
    EXPECT_THROW(
        {
            try {
                write_measures(run_, "aa");
            } catch (const UserError& error) {
                EXPECT_THAT(error.what(), AllOf(HasSubstr("no measure aa"), HasSubstr("a, b")));
                throw;
            }
        },
        UserError);
}

TEST_F(MeasuredRun, measures_grains_of_its_pictures) {
    const double level = 0.06;
    const Grains bed = testing::packed_grains({-0.1, -0.1, 0.0}, {0.1, 0.1, level}, k_d, 1, [](const Vec3&) { return true; });
    Grains half = bed;
    for (std::size_t n = 0; n < half.size(); ++n) half.velocity[n] = {half.position[n].x() > 0.0 ? 0.5 : 0.0, 0.0, 0.0};
    for (const double time : {0.5, 1.0}) picture(time, bed);
    picture(2.0, half);
    const char* box = R"("region": {"box": {"lower_m": [-0.08, -0.08, 0.01], "upper_m": [0.08, 0.08, 0.05]}})";
    const char* whole_height = R"("region": {"box": {"lower_m": [-0.08, -0.08, 0], "upper_m": [0.08, 0.08, 0.2]}})";
    write(k_measures,
          fmt::format(R"([{{"name": "all", "what": "mass_in", "region": {{"half_space": {{"point_m": [0, 0, 0], "normal": [0, 0, 1]}}}}}},
              {{"name": "share", "what": "packing", {0}, "at_s": 0.9}},
              {{"name": "moving", "what": "bed_velocity", {0}, "cell_m": 0.02, "from_s": 1.5}},
              {{"name": "still", "what": "bed_velocity", {0}, "cell_m": 0.02, "to_s": 1.5}},
              {{"name": "top", "what": "profile", "base_m": 0.01, "from_m": -0.09, "to_m": 0.09}},
              {{"name": "hole", "what": "cavity", "undisturbed_m": {1}, "quantity": "depth", {2}}},
              {{"name": "same", "what": "cavity"}},
              {{"name": "gap", "what": "void_area", "seed_m": [0, 0, 0.03], {0}, "cell_m": 0.01}},
              {{"name": "slope", "what": "angle", "radius_m": 0.09}}])",
                      box, level + 0.05, whole_height));
    const json results = measure_run(run_);
    const auto value = [&](const char* name) { return results[name]["value"].get<double>(); };
    EXPECT_NEAR(value("all"), mass_of(bed), 1e-6 * mass_of(bed));
    EXPECT_EQ(results["share"]["detail"]["at_s"], 1.0);
    EXPECT_NEAR(value("share"), testing::k_packed_share, 0.02);
    EXPECT_NEAR(value("moving"), 0.25, 0.01);
    EXPECT_NEAR(results["moving"]["detail"]["moving_share"].get<double>(), 0.5, 0.02);
    EXPECT_EQ(value("still"), 0.0);
    EXPECT_NEAR(value("top"), level - 0.01 + 0.5 * k_d, 0.2 * k_d);
    EXPECT_NEAR(value("hole"), 0.05, k_d) << "the whole bed lies below";
    EXPECT_TRUE(results["hole"]["detail"]["reaches_border"].get<bool>());
    EXPECT_EQ(value("gap"), 0.0);
    EXPECT_TRUE(results["slope"]["value"].is_null()) << "a level bed has no slope";
    EXPECT_LT(value("same"), 4.0 * k_d) << "the roughness of a bed is taken for a cavity";
    std::vector<std::string> names;
    for (const Figure& figure : measure_figures(results)) {
        names.push_back(figure.plot.name);
        EXPECT_FALSE(gnuplot_commands(figure.plot).empty());
        if (!gnuplot_is_installed()) continue;
        EXPECT_THAT(draw_svg(figure.plot, run_ / "plots"), HasSubstr("<svg"));
    }
    EXPECT_THAT(
        names, ::testing::IsSupersetOf({"measure_moving", "measure_still", "measure_top", "measure_hole", "measure_gap", "measure_slope"}));
    EXPECT_THAT(measures_text(results), HasSubstr("no angle"));
}

/// Outside a round bed there is no cavity; a box within it has none either, and its own level.
// The run went on from 3 s: its later pictures of before are in the folder, not in the series.
TEST_F(MeasuredRun, measures_no_picture_that_a_restart_replaced) {
    emptying_region();
    const MeasureSource all(run_);
    EXPECT_EQ(all.picture_times(), (std::vector<double>{1, 2, 3, 4, 5})) << "a run without a series";
    write("postProcessing/rock/rocks.pvd",
          "<Collection>\n<DataSet timestep=\"1\" file=\"vtk/rocks_1.vtp\"/>\n<DataSet timestep=\"2\" file=\"vtk/rocks_2.vtp\"/>\n"
          "<DataSet timestep=\"2.5\" file=\"vtk/rocks_2.5.vtp\"/>\n<DataSet timestep=\"3\" file=\"vtk/rocks_3.vtp\"/>\n</Collection>\n");
    const MeasureSource shown(run_);
    EXPECT_EQ(shown.picture_times(), (std::vector<double>{1, 2, 3})) << "one was deleted by hand";
    EXPECT_EQ(shown.grains(shown.picture_near(std::nullopt)).size(), 12U - 2 * 3);
}

TEST_F(MeasuredRun, finds_no_cavity_beside_a_round_bed) {
    const Grains bed =
        testing::packed_grains({-0.1, -0.1, 0.0}, {0.1, 0.1, 0.06}, k_d, 1, [](const Vec3& place) { return place.head<2>().norm() < 0.1; });
    picture(0.0, bed);
    write(k_measures, R"([{"name": "all", "what": "cavity"}, {"name": "given", "what": "cavity", "undisturbed_m": 0.06},
                          {"name": "within", "what": "cavity",
                           "region": {"box": {"lower_m": [-0.06, -0.06, 0], "upper_m": [0.06, 0.06, 0.2]}}}])");
    const json results = measure_run(run_);
    for (const char* name : {"all", "given"}) {
        EXPECT_TRUE(results[name]["value"].is_null()) << results[name]["value"];
        EXPECT_THAT(results[name]["detail"]["reason"].get<std::string>(), HasSubstr("a corner of the bed's extent has no grains"));
    }
    EXPECT_LT(results["within"]["value"].get<double>(), 3.0 * k_d);
}

TEST_F(MeasuredRun, compares_a_profile_with_a_given_one) {
    Grains bar;
    for (int n = 0; n < 101; ++n) bar.add({0.002 * n, 0.0, 0.05}, Vec3::Zero(), 0.02, k_density);
    picture(1.0, bar);
    write("heap.csv", "x_m,height_m\n0,0.03\n0.2,0.03\n");
    write(k_measures, R"([{"name": "misfit", "what": "profile_error", "against": "heap.csv", "from_m": 0, "to_m": 0.2}])");
    const json results = measure_run(run_);
    EXPECT_NEAR(results["misfit"]["value"].get<double>(), 1.0, 0.01);
    EXPECT_EQ(results["misfit"]["detail"]["points"], 100);
    const auto figures = measure_figures(results);
    ASSERT_EQ(figures.size(), 1U);
    EXPECT_EQ(figures[0].plot.series.size(), 2U);
}

TEST_F(MeasuredRun, reads_forces_columns_and_probes) {
    std::string walls = "time_s,wall,force_x_n,force_y_n,force_z_n\n", loads = "time_s,torque\n", probes = "# Probe 0 (0 0 0)\n# Time\n";
    for (int n = 1; n <= 2000; ++n) {
        const double time = 0.005 * n;
        walls += fmt::format("{:.3f},plate,3,{:.6f},0\n{:.3f},tube,1,0,0\n", time, 4.0 + 0.5 * std::sin(2.0 * k_pi * 4.0 * time), time);
        loads += fmt::format("{:.3f},{:.6f}\n", time, std::sin(2.0 * k_pi * 2.0 * time));
        probes += fmt::format("{:.3f} 10 {:.6f}\n", time, 4.0 - 0.1 * time);
    }
    write("postProcessing/rock/0/walls.csv", walls);
    write("postProcessing/loads/0/loads.csv", loads);
    write("postProcessing/drop/0/p", probes);
    write(k_measures, R"([{"name": "push", "what": "wall_force", "wall": "plate", "component": "y"},
                          {"name": "size", "what": "wall_force", "wall": "tube"},
                          {"name": "beat", "what": "spectrum", "wall": "plate", "component": "y", "length_m": 0.1, "velocity_m_s": 2,
                           "quantity": "strouhal"},
                          {"name": "turn", "what": "spectrum", "table": "loads/loads.csv", "column": "torque"},
                          {"name": "drop", "what": "pressure_drop", "upstream_m": [0, 0, 0], "downstream_m": [0, 0, 1],
                           "density_kg_m3": 1000, "from_s": 4, "to_s": 6}])");
    // The tube is taken away at 10 s; the zeros that follow are no force.
    for (int n = 2001; n <= 2010; ++n) walls += fmt::format("{:.3f},plate,3,4,0\n{:.3f},tube,0,0,0\n", 0.005 * n, 0.005 * n);
    write("postProcessing/rock/0/walls.csv", walls);
    write("room.json", R"({"solids": [{"name": "tube", "removed_at_s": 10.0}]})");
    const json results = measure_run(run_);
    const auto value = [&](const char* name) { return results[name]["value"].get<double>(); };
    EXPECT_NEAR(value("push"), 4.0, 0.01);
    EXPECT_EQ(value("size"), 1.0);
    EXPECT_NEAR(value("beat"), 4.0 * 0.1 / 2.0, 0.01 * 0.2);
    EXPECT_NEAR(value("turn"), 2.0, 0.02);
    EXPECT_NEAR(value("drop"), 1000.0 * (6.0 + 0.5), 1.0);
    EXPECT_EQ(measure_figures(results).size(), 5U);
}

TEST_F(MeasuredRun, draws_no_spectrum_of_what_is_not_there_and_tells_of_a_signal_that_does_not_change) {
    std::string walls = "time_s,wall,force_x_n,force_y_n,force_z_n\n";
    for (int n = 1; n <= 200; ++n) walls += fmt::format("{:.3f},plate,0,0,0\n", 0.005 * n);
    write("postProcessing/rock/0/walls.csv", walls);
    write(k_measures, R"([{"name": "still", "what": "spectrum", "wall": "plate", "component": "y"},
                          {"name": "absent", "what": "spectrum", "table": "loads/loads.csv", "column": "torque"}])");
    const json results = write_possible_measures(run_);
    EXPECT_EQ(results["still"]["detail"]["reason"], "the signal does not change");
    EXPECT_TRUE(results["absent"]["value"].is_null());
    EXPECT_NO_THROW(measure_figures(results));
}

TEST_F(MeasuredRun, finds_no_oscillation_in_a_force_that_fades) {
    std::string walls = "time_s,wall,force_x_n,force_y_n,force_z_n\n";
    for (int n = 1; n <= 400; ++n) walls += fmt::format("{:.3f},plate,0,{:.9f},0\n", 0.01 * n, std::exp(-0.01 * n / 1.5));
    write("postProcessing/rock/0/walls.csv", walls);
    write(k_measures, R"([{"name": "beat", "what": "spectrum", "wall": "plate", "component": "y", "length_m": 0.1, "velocity_m_s": 2}])");
    const json results = write_possible_measures(run_);
    EXPECT_TRUE(results["beat"]["value"].is_null());
    EXPECT_TRUE(results["beat"]["detail"]["strouhal"].is_null());
    EXPECT_THAT(results["beat"]["detail"]["reason"].get<std::string>(), HasSubstr("changes slowly"));
    EXPECT_EQ(measure_figures(results).at(0).plot.series.size(), 1U) << "without a line at a peak";
}

TEST_F(MeasuredRun, tells_of_a_place_of_pressure_in_no_cell) {
    write("postProcessing/drop/0/p", "# Probe 0 (0 0 0)\n# Time\n0.1 10 -1e+300\n0.2 10 -1e+300\n");
    write(k_measures, R"([{"name": "drop", "what": "pressure_drop", "upstream_m": [0, 0, 0], "downstream_m": [0, 0, 1],
                           "density_kg_m3": 1000}])");
    EXPECT_THAT(write_possible_measures(run_)["drop"]["detail"]["reason"].get<std::string>(), HasSubstr("lies in no cell"));
}

TEST_F(MeasuredRun, tells_all_that_it_cannot_measure_at_once) {
    write(k_measures, R"([{"name": "a", "what": "passed_mass", "gate": "outlet"}, {"name": "b", "what": "wall_force", "wall": "plate"},
                          {"name": "c", "what": "cavity"}, {"name": "d", "what": "pressure_drop",
                           "upstream_m": [0, 0, 0], "downstream_m": [0, 0, 1], "density_kg_m3": 1000}])");
    try {
        measure_run(run_);
        FAIL() << "nothing was there to measure";
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().size(), 4U);
        EXPECT_THAT(error.what(), AllOf(HasSubstr("measure.a"), HasSubstr("gates.csv"), HasSubstr("measure.b"), HasSubstr("walls.csv"),
                                        HasSubstr("measure.c"), HasSubstr("no picture"), HasSubstr("measure.d")));
        EXPECT_EQ(error.code(), ExitCode::user_input);
    }
    // A report is written all the same.
    const json possible = write_possible_measures(run_);
    EXPECT_EQ(possible, read_measures(run_));
    EXPECT_TRUE(possible["b"]["value"].is_null());
    EXPECT_EQ(possible["b"]["unit"], "N");
    EXPECT_THAT(possible["b"]["detail"]["reason"].get<std::string>(), HasSubstr("walls.csv"));
    EXPECT_NO_THROW(measure_figures(possible));
    write(k_measures, R"([{"name": "a", "what": "passed_masss", "gate": "outlet"}, {"what": "cavity"}])");
    EXPECT_THROW(write_possible_measures(run_), UserError);
    try {
        measure_run(run_);
        FAIL() << "the measures have mistakes";
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().size(), 2U) << error.what();
    }
    write(k_measures, R"([{"name": "a", "what": "passed_masss"},
                          {"name": "b", "what": "wall_force", "wall": "plate"},
                          {"name": "c", "what": "profile_error", "against": "gone.csv"}])");
    try {
        measure_run(run_);
        FAIL() << "one measure has a mistake, two find nothing";
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().size(), 3U) << error.what();
        EXPECT_THAT(error.what(), AllOf(HasSubstr("passed_masss"), HasSubstr("walls.csv"),
                                        HasSubstr((run_ / "gone.csv").string() + ": measure.c: there is no such file")));
    }
}

TEST_F(MeasuredRun, refuses_a_list_without_measures_and_writes_nothing) {
    write(k_measures, "[]");
    try {
        write_measures(run_, {});
        FAIL();
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().front().what, "it names no measure");
    }
    EXPECT_FALSE(std::filesystem::exists(run_ / k_measure_results));
}

TEST_F(MeasuredRun, refuses_maps_of_more_cells_than_anyone_draws) {
    Grains two;
    two.add({0.0, 0.0, 0.0}, Vec3::Zero(), 0.1, k_density);
    two.add({1.0, 1.0, 0.0}, Vec3::Zero(), 0.1, k_density);
    picture(1.0, two);
    const char* box = R"("region": {"box": {"lower_m": [0, 0, 0], "upper_m": [1, 1, 1]}}, "cell_m": 1e-12)";
    write(k_measures, fmt::format(R"([{{"name": "a", "what": "cavity", {0}}}, {{"name": "b", "what": "bed_velocity", {0}}},
                                     {{"name": "c", "what": "void_area", "seed_m": [0, 0, 0], {0}}},
                                     {{"name": "d", "what": "cavity", "cell_m": 1e-12}}])",
                                  box));
    try {
        measure_run(run_);
        FAIL() << "a map of 1e24 cells";
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().size(), 4U) << error.what();
    }
}

TEST_F(MeasuredRun, tells_every_mistake_of_a_given_profile_with_its_line) {
    const auto refusal = [&](const std::string& text) {
        write("heap.csv", text);
        try {
            read_profile(run_ / "heap.csv");
        } catch (const UserError& error) {
            EXPECT_EQ(error.code(), ExitCode::user_input);
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(refusal("x_m,height_m\n0,0.02\n0.03,0.01\n"), "");
    EXPECT_THAT(refusal("x,h\n0,0.02\n0.03,0.01\n"),
                AllOf(HasSubstr("heap.csv:1: column 'x_m' is missing"), HasSubstr("column 'height_m' is missing")));
    EXPECT_THAT(refusal("x_m,height_m\n0,high\n0.03,0.01\n0.02,0.01\n"),
                AllOf(HasSubstr("heap.csv:2: height_m = 'high'"), HasSubstr("heap.csv:4: x_m = 0.02 after 0.03")));
    EXPECT_THAT(refusal("x_m,height_m\n0,0.01\n"), HasSubstr("A profile has two or more"));
    EXPECT_THAT(refusal(""), HasSubstr("is empty"));
}

TEST_F(MeasuredRun, says_that_there_are_no_grains) {
    Grains one;
    one.add({0.0, 0.0, 0.005}, Vec3::Zero(), k_d, k_density);
    picture(2.0, one);
    write("heap.csv", "x_m,height_m\n0,0.03\n0.2,0.03\n");
    const char* away = R"("region": {"half_space": {"point_m": [0, 0, 1], "normal": [0, 0, 1]}})";
    write(k_measures, fmt::format(R"([{{"name": "slope", "what": "angle", {0}}}, {{"name": "line", "what": "profile", {0}}},
                                      {{"name": "misfit", "what": "profile_error", "against": "heap.csv", {0}}},
                                      {{"name": "floor", "what": "profile", "from_m": 0, "to_m": 0.2, {0}}},
                                      {{"name": "gone", "what": "profile_error", "against": "heap.csv", "from_m": 0, "to_m": 0.2, {0}}}])",
                                  away));
    const json results = measure_run(run_);
    for (const char* name : {"slope", "line", "misfit", "floor", "gone"})
        EXPECT_THAT(results[name]["detail"]["reason"].get<std::string>(), HasSubstr("the picture at 2 s has no grains in the region"));
    for (const char* name : {"slope", "line", "misfit"}) EXPECT_TRUE(results[name]["value"].is_null()) << name;
    EXPECT_EQ(results["floor"]["value"], 0.0) << "the ends are given: an empty floor";
    EXPECT_EQ(results["gone"]["value"], 1.0);
    EXPECT_NO_THROW(measure_figures(results));
}

TEST_F(MeasuredRun, names_the_columns_of_a_table_that_has_not_the_one_asked_for) {
    write("postProcessing/loads/0/loads.csv", "time_s,torque\n0.1,1\n0.2,2\n");
    write(k_measures, R"([{"name": "turn", "what": "spectrum", "table": "loads/loads.csv", "column": "torqe"}])");
    try {
        measure_run(run_);
        FAIL() << "there is no such column";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("the column torqe is missing"), HasSubstr("the table has time_s, torque"),
                                        HasSubstr("one of its columns"), ::testing::Not(HasSubstr("Run it again"))));
    }
}

TEST_F(MeasuredRun, refuses_pictures_without_densities_and_broken_files) {
    write("postProcessing/rock/vtk/rocks_1.vtp",
          "<DataArray Name=\"Points\">0 0 0</DataArray><DataArray Name=\"velocity\">0 0 0</DataArray>"
          "<DataArray Name=\"diameter\">1</DataArray>");
    write(k_measures, R"([{"name": "c", "what": "cavity"}])");
    EXPECT_THROW(measure_run(run_), UserError);
    for (const std::string& broken : {std::string("[{]"), std::string(), std::string(100000, '['), std::string("[] []")}) {
        write(k_measures, broken);
        EXPECT_THROW(measure_run(run_), UserError) << broken.substr(0, 10);
    }
    write(k_measure_results, R"({"c": {"value": "much"}})");
    EXPECT_THROW(read_measures(run_), UserError);
}

}  // namespace
}  // namespace cutterflow::postproc
