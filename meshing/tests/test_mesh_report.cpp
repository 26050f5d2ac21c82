#include "meshing/cutter/mesh_report.hpp"

#include "meshing/cutter/build_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/head/head_names.hpp"
#include "meshing/tests/model_mesh.hpp"

namespace cutterflow::meshing {
namespace {

// Lines of checkMesh 1912 of a good mesh and of a bad one.
const std::string k_good_log = R"(Checking geometry...
    Max cell openness = 3.1e-16 OK.
    Max aspect ratio = 88.1653220047 OK.
    Minimum face area = 2.51e-05. Maximum face area = 0.123.  Face area magnitudes OK.
    Min volume = 3.085e-07. Max volume = 0.01338.  Total volume = 25.65.  Cell volumes OK.
    Mesh non-orthogonality Max: 65.764293551 average: 10.6276139881
    Non-orthogonality check OK.
    Face pyramids OK.
    Max skewness = 3.0799489033 OK.

Mesh OK.

End
)";
const std::string k_bad_log = R"(Checking geometry...
 ***High aspect ratio cells found, Max aspect ratio: 1.5e+30, number of cells 2
 ***Zero or negative cell volume detected.  Minimum negative volume: -1e-09, Number of negative volume cells: 2
    Mesh non-orthogonality Max: 160.5 average: 12.25
   *Number of severely non-orthogonal (> 70 degrees) faces: 4.
 ***Number of non-orthogonality errors: 2.
 ***Max skewness = 12.5, 3 highly skew faces detected which may impair the quality of the results

Failed 4 mesh checks.

End
)";

struct Case {
    MeshPlan plan = plan_mesh(model_mesh_input());
    CheckMeshFigures quality = parse_check_mesh(k_good_log, "log");
    ProbeFigures figures = good_figures();

    ProbeFigures good_figures() const {
        ProbeFigures f;
        f.cells = 60000;
        f.rotor_cells = 27000;
        f.volume_min = 3e-7;
        f.volume_max = 0.013;
        f.rotor_volume = plan.rotor.volume() - 0.98 * plan.input.cutter.volume;
        const double n = plan.rotor.facets;
        f.patches = {{names::cutter_patch, 1.2, 0.0128},
                     {names::backplate_patch, 0.9, 0.02},
                     {names::suction_pipe_patch, 0.5, 0.03},
                     {names::outlet_patch, 0.97 * k_pi * 0.01, 0.04},
                     {names::inlet_patch, n * 2.0 * 2.5 * std::sin(k_pi / n) * 1.31, 0.16},
                     {names::tank_top_patch, 19.6, 0.1},
                     {names::tank_bottom_patch, 19.6, 0.1},
                     {names::rotor_interface_patch, 2.9, 0.03},
                     {names::stator_interface_patch, 2.9, 0.03}};
        f.weight_min = 0.997;
        f.weight_max = 1.003;
        f.rotor_side = {plan.interface_faces(), true, 1e-3};
        f.stator_side = f.rotor_side;
        return f;
    }

    std::vector<std::string> failed() const {
        std::vector<std::string> names;
        for (const MeshGate& gate : check_mesh_gates(plan, quality, figures))
            if (!gate.passed()) names.push_back(gate.name);
        return names;
    }
};

TEST(CheckMeshLog, gives_its_figures) {
    const CheckMeshFigures good = parse_check_mesh(k_good_log, "log");
    EXPECT_DOUBLE_EQ(good.non_orthogonality_max, 65.764293551);
    EXPECT_DOUBLE_EQ(good.non_orthogonality_mean, 10.6276139881);
    EXPECT_DOUBLE_EQ(good.skewness_max, 3.0799489033);
    EXPECT_DOUBLE_EQ(good.aspect_ratio_max, 88.1653220047);
    EXPECT_EQ(good.failed_checks, 0);
    const CheckMeshFigures bad = parse_check_mesh(k_bad_log, "log");
    EXPECT_DOUBLE_EQ(bad.non_orthogonality_max, 160.5);
    EXPECT_DOUBLE_EQ(bad.skewness_max, 12.5);
    EXPECT_DOUBLE_EQ(bad.aspect_ratio_max, 1.5e30);
    EXPECT_EQ(bad.failed_checks, 4);
}

TEST(CheckMeshLog, with_a_figure_that_is_no_number_is_an_error_that_quotes_it) {
    for (const char* figure : {"-nan", "inf", "1e"}) {
        std::string log = k_good_log;
        log.replace(log.find("3.0799489033"), 12, figure);
        try {
            parse_check_mesh(log, "log");
            ADD_FAILURE() << "accepted: " << figure;
        } catch (const ToolError& error) {
            EXPECT_NE(std::string(error.what()).find(figure), std::string::npos);
        }
    }
}

TEST(CheckMeshLog, that_was_cut_off_is_an_error_that_names_it) {
    for (const std::string& log :
         {std::string(), k_good_log.substr(0, k_good_log.find("Max skewness")), k_good_log.substr(0, k_good_log.find("Mesh OK"))}) {
        try {
            parse_check_mesh(log, "mesh/log.checkMesh");
            ADD_FAILURE() << "accepted: " << log;
        } catch (const ToolError& error) {
            EXPECT_NE(std::string(error.what()).find("mesh/log.checkMesh"), std::string::npos);
        }
    }
}

TEST(MeshGates, pass_a_good_mesh) {
    EXPECT_EQ(Case().failed(), std::vector<std::string>{});
}

TEST(MeshGates, each_see_their_own_fault) {
    const std::vector<std::pair<std::string, std::function<void(Case&)>>> faults = {
        {"failed checks of checkMesh", [](Case& c) { c.quality.failed_checks = 1; }},
        {"non-orthogonality, deg", [](Case& c) { c.quality.non_orthogonality_max = 75.1; }},
        {"skewness", [](Case& c) { c.quality.skewness_max = 4.01; }},
        {"smallest cell volume over the background's", [](Case& c) { c.figures.volume_min = 0.99e-4 * std::pow(c.plan.cell_size, 3); }},
        {"smallest cell volume over the background's", [](Case& c) { c.figures.volume_min = -1e-9; }},
        {"missing patches", [](Case& c) { c.figures.patches.erase(c.figures.patches.begin() + 1); }},
        {"interface faces that refinement split", [](Case& c) { c.figures.rotor_side.faces += 3; }},
        {"interface faces that refinement split", [](Case& c) { c.figures.stator_side.restored = false; }},
        // The zone inverted: the steel inside, the water outside.
        {"relative error of the steel's volume in the rotor zone", [](Case& c) { c.figures.rotor_volume = c.plan.input.cutter.volume; }},
        // One of six blades lost.
        {"relative error of the steel's volume in the rotor zone",
         [](Case& c) { c.figures.rotor_volume += 0.13 * c.plan.input.cutter.volume; }},
        {"relative error of the inlet's area", [](Case& c) { c.figures.patches[4].area *= 0.98; }},
        {"relative error of the outlet's area", [](Case& c) { c.figures.patches[3].area *= 0.9; }},
        {"smallest interface weight", [](Case& c) { c.figures.weight_min = 0.979; }},
        {"largest interface weight", [](Case& c) { c.figures.weight_max = 1.021; }},
        {"largest interface weight", [](Case& c) { c.figures.weight_max = NAN; }},
    };
    for (const auto& [gate, spoil] : faults) {
        Case c;
        spoil(c);
        EXPECT_EQ(c.failed(), std::vector<std::string>{gate});
    }
}

TEST(MeshGates, miss_the_outlet_when_the_pipe_is_closed) {
    Case c;
    c.figures.patches.erase(c.figures.patches.begin() + 3);
    EXPECT_EQ(c.failed(), (std::vector<std::string>{"missing patches", "relative error of the outlet's area"}));
}

TEST(MeshGates, stop_the_run_with_value_limit_and_remedy) {
    Case c;
    c.quality.skewness_max = 5.25;
    c.figures.weight_min = 0.5;
    MeshReport report;
    report.gates = check_mesh_gates(c.plan, c.quality, c.figures);
    try {
        require_mesh_gates(report);
        FAIL();
    } catch (const CheckFailure& failure) {
        const std::string text = failure.what();
        EXPECT_EQ(failure.code(), ExitCode::check_failed);
        for (const char* part : {"skewness is 5.25", "at most 4", "mesh.preset", "smallest interface weight"})
            EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
    }
    report.gates = check_mesh_gates(Case().plan, Case().quality, Case().figures);
    EXPECT_NO_THROW(require_mesh_gates(report));
}

TEST(NextAttempt, makes_the_cells_smaller_twice_and_names_gate_and_change) {
    Case c;
    MeshReport report;
    report.gates = check_mesh_gates(c.plan, c.quality, c.figures);
    MeshInput input = c.plan.input;
    EXPECT_FALSE(next_attempt(report, 1, input)) << "every gate was passed";

    c.quality.skewness_max = 5.25;
    report.gates = check_mesh_gates(c.plan, c.quality, c.figures);
    const std::optional<MeshRetry> second = next_attempt(report, 1, input);
    ASSERT_TRUE(second);
    EXPECT_EQ(second->failed_gate, "skewness");
    EXPECT_EQ(second->change, "cells 0.93 times as wide as the preset's");
    EXPECT_NEAR(input.resolution.cell_size, 0.93 * c.plan.input.resolution.cell_size, 1e-12);
    EXPECT_GT(plan_mesh(input).background_cells(), c.plan.background_cells());
    ASSERT_TRUE(next_attempt(report, 2, input));
    EXPECT_NEAR(input.resolution.cell_size, 0.85 * c.plan.input.resolution.cell_size, 1e-12);
    EXPECT_FALSE(next_attempt(report, 3, input)) << "the last attempt";
}

nlohmann::json side(double min, double max) {
    return {{"min", min}, {"max", max}, {"mean", 1.0}};
}

TEST(ProbeReport, gives_the_extremes_over_both_sides_and_all_angles) {
    const nlohmann::json probe = {
        {"cells", 100},
        {"volume_min_m3", 1e-6},
        {"volume_max_m3", 1e-3},
        {"zones", {{"rotor", {{"cells", 40}, {"volume_m3", 0.5}}}, {"stator", {{"cells", 60}, {"volume_m3", 5.0}}}}},
        {"patches", {{"cutter", {{"faces", 7}, {"area_m2", 1.5}, {"cell_size_mean_m", 0.01}, {"type", "wall"}}}}},
        {"interface",
         {{{"angle_rad", 0.0}, {"rotor", side(1.0, 1.001)}, {"stator", side(0.995, 1.0)}},
          {{"angle_rad", 0.1}, {"rotor", side(0.99, 1.0)}, {"stator", side(0.996, 1.004)}}}}};
    const nlohmann::json restore = {{"rotor_side", {{"faces", 12}, {"background_faces", 12}, {"restored", true}, {"drift_max_m", 0.002}}},
                                    {"stator_side", {{"faces", 15}, {"background_faces", 12}, {"restored", false}, {"drift_max_m", 0.0}}}};
    const ProbeFigures figures = parse_probe(probe, restore);
    EXPECT_EQ(figures.cells, 100u);
    EXPECT_EQ(figures.rotor_cells, 40u);
    EXPECT_EQ(figures.rotor_volume, 0.5);
    EXPECT_EQ(figures.weight_min, 0.99);
    EXPECT_EQ(figures.weight_max, 1.004);
    EXPECT_TRUE(figures.rotor_side.restored);
    EXPECT_FALSE(figures.stator_side.restored);
    EXPECT_EQ(figures.stator_side.faces, 15u);
    ASSERT_EQ(figures.patches.size(), 1u);
    EXPECT_EQ(figures.patches[0].area, 1.5);
}

TEST(MeshReport, writes_the_keys_of_its_contract) {
    Case c;
    MeshReport report;
    report.preset = "draft";
    report.quality = c.quality;
    report.figures = c.figures;
    report.prediction = c.plan.prediction;
    report.gates = check_mesh_gates(c.plan, c.quality, c.figures);
    report.gates.back().value = 2.0;
    report.program_core_s = {{"blockMesh", 0.5}, {"snappyHexMesh", 12.0}};
    const nlohmann::json json = to_json(report);
    for (const char* key : {"cells",
                            "rotor_cells",
                            "stator_cells",
                            "cell_size_min_m",
                            "cell_size_max_m",
                            "cell_size_at_cutter_m",
                            "non_orthogonality_max_deg",
                            "non_orthogonality_mean_deg",
                            "skewness_max",
                            "aspect_ratio_max",
                            "interface_weight_min",
                            "interface_weight_max",
                            "interface_faces",
                            "time_step_s",
                            "preset",
                            "gates",
                            "wall_s",
                            "core_s",
                            "retries",
                            "predicted_memory_bytes",
                            "memory_bytes",
                            "program_core_s"})
        EXPECT_TRUE(json.contains(key)) << key;
    EXPECT_EQ(json["stator_cells"], 33000);
    EXPECT_EQ(json["program_core_s"]["snappyHexMesh"], 12.0);
    EXPECT_NEAR(json["cell_size_min_m"].get<double>(), std::cbrt(3e-7), 1e-12);
    EXPECT_EQ(json["cell_size_at_cutter_m"], 0.0128);
    EXPECT_EQ(json["gates"].size(), report.gates.size());
    EXPECT_EQ(json["gates"].back()["passed"], false);
    EXPECT_EQ(json["gates"].front()["passed"], true);
}

}  // namespace
}  // namespace cutterflow::meshing
