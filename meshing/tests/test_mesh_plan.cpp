#include "meshing/cutter/mesh_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "meshing/tests/model_mesh.hpp"

namespace cutterflow::meshing {
namespace {

/// Mistakes of a plan that is refused.
std::vector<Mistake> refusals(const MeshInput& input) {
    try {
        plan_mesh(input);
    } catch (const UserError& error) {
        return error.mistakes();
    }
    return {};
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

double last_cell_of(const CellRow& row) {
    return first_cell(row) * row.expansion;
}

TEST(CellRow, fills_its_length_with_cells_that_grow_no_faster_than_allowed) {
    for (const double growth : {1.1, 1.35, 2.0}) {
        for (const double first : {0.01, 0.03, 0.4}) {
            const CellRow row = growing_row(0.5, 2.5, first, growth);
            const double q = row.cells > 1 ? std::pow(row.expansion, 1.0 / (row.cells - 1)) : 1.0;
            EXPECT_LE(q, growth * (1.0 + 1e-9));
            double length = 0.0, cell = first_cell(row);
            for (int i = 0; i < row.cells; ++i, cell *= q) length += cell;
            EXPECT_NEAR(length, 2.0, 1e-9);
            if (row.expansion > 1.0) EXPECT_NEAR(first_cell(row), first, 1e-6 * first);
        }
    }
    EXPECT_THROW(growing_row(1.0, 1.0, 0.1, 1.2), std::invalid_argument);
    EXPECT_THROW(growing_row(0.0, 1.0, 0.1, 1.0), std::invalid_argument);
}

TEST(CellRow, is_one_cell_when_the_first_is_longer_than_the_row) {
    const CellRow row = growing_row(0.0, 1.0, 3.0, 1.2);
    EXPECT_EQ(row.cells, 1);
    EXPECT_EQ(first_cell(row), 1.0);
}

TEST(RotorZone, has_the_volume_of_its_prism) {
    const RotorZone square{std::sqrt(2.0), -1.0, 2.0, 4};
    EXPECT_NEAR(square.volume(), 12.0, 1e-12);
    const RotorZone fine{0.5, 0.0, 1.0, 100000};
    EXPECT_NEAR(fine.volume(), k_pi * 0.25, 1e-8);
}

TEST(MeshPlan, keeps_the_steel_clear_of_the_interface_by_cells) {
    for (const char* preset : {"draft", "standard", "paper"}) {
        const MeshPlan plan = plan_mesh(model_mesh_input(preset));
        // A cell of the steel, halved, and a whole one fit between.
        EXPECT_GE(plan.rotor.radius - 0.4, 1.5 * plan.cell_size);
        EXPECT_GE(-0.485 - plan.rotor.z_bottom, 1.5 * first_cell(plan.zone.front()));
        EXPECT_GE(plan.to_ring.cells, 2.0);
        EXPECT_GE(plan.to_hub.cells, 2.0);
        EXPECT_GE(plan.to_cutter_top.cells, 2.0);
        EXPECT_GE(plan.to_backplate.cells, 2.0);
        EXPECT_NEAR(plan.rotor.z_top, 0.015, 1e-12);
        EXPECT_NEAR(plan.to_ring.distance, plan.rotor.radius - 0.4, 1e-12);
    }
}

TEST(MeshPlan, ends_its_rows_on_the_steel_and_on_the_tank) {
    const MeshPlan plan = plan_mesh(model_mesh_input());
    EXPECT_EQ(plan.below.front().from, -0.875);
    EXPECT_EQ(plan.below.back().to, plan.rotor.z_bottom);
    EXPECT_EQ(plan.zone.front().from, plan.rotor.z_bottom);
    EXPECT_EQ(plan.zone.front().to, 0.0);
    EXPECT_EQ(plan.zone.back().to, plan.rotor.z_top);
    EXPECT_EQ(plan.above[0].to, 0.03);
    EXPECT_NEAR(plan.above[1].to, 0.05, 1e-15);
    EXPECT_EQ(plan.above.back().to, 0.435);
    EXPECT_EQ(plan.annulus.to, plan.rotor.radius);
    EXPECT_EQ(plan.outer.to, 2.5);
    // The layers on both sides of the interface are alike.
    EXPECT_NEAR(first_cell(plan.outer), plan.cell_size, 0.1 * plan.cell_size);
    EXPECT_NEAR(last_cell_of(plan.below.back()), first_cell(plan.zone.front()), 0.1 * first_cell(plan.zone.front()));
}

TEST(MeshPlan, serves_heads_of_any_size_alike) {
    const MeshPlan model = plan_mesh(model_mesh_input());
    for (const double factor : {0.25, 4.0}) {
        const MeshPlan plan = plan_mesh(scaled(model_mesh_input(), factor));
        EXPECT_EQ(plan.background_cells(), model.background_cells());
        EXPECT_EQ(plan.interface_faces(), model.interface_faces());
        EXPECT_NEAR(plan.prediction.cells, model.prediction.cells, 1e-6 * model.prediction.cells);
        EXPECT_NEAR(plan.rotor.radius, factor * model.rotor.radius, 1e-9);
        EXPECT_NEAR(plan.prediction.cell_size_min, factor * model.prediction.cell_size_min, 1e-9);
    }
}

TEST(MeshPlan, predicts_a_time_step_that_follows_speed_and_discharge) {
    MeshInput input = model_mesh_input();
    const MeshPrediction base = plan_mesh(input).prediction;
    input.max_courant = 0.45;
    EXPECT_NEAR(plan_mesh(input).prediction.time_step, 0.5 * base.time_step, 1e-12);
    EXPECT_NEAR(plan_mesh(input).prediction.core_hours_per_revolution, 2.0 * base.core_hours_per_revolution, 1e-9);

    input = model_mesh_input();
    input.discharge *= 100.0;
    EXPECT_NEAR(plan_mesh(input).prediction.time_step * 100.0 / base.time_step, 1.12, 0.02);  // the mouth alone; tip and mouth before

    input.discharge = 1e-6;
    const double slow = plan_mesh(input).prediction.time_step;
    input.rotation_speed *= -2.0;
    EXPECT_NEAR(plan_mesh(input).prediction.time_step, 0.5 * slow, 1e-9);  // and the tip when there is hardly any suction
}

// Steps of cutterFoam on the model cutter at 0.12 m3/s and Courant 0.9, flow alone after its start, as the runs of cases/examples/trends
// took.
TEST(MeshPlan, predicts_the_time_step_of_runs_within_a_tenth) {
    const auto predicted = [](const char* preset, double rpm) {
        MeshInput input = model_mesh_input(preset);
        input.rotation_speed = rpm * 2.0 * k_pi / 60.0;
        return plan_mesh(input).prediction.time_step;
    };
    EXPECT_NEAR(predicted("draft", 30.0) / 1.36e-3, 1.0, 0.1);
    EXPECT_NEAR(predicted("draft", 60.0) / 1.26e-3, 1.0, 0.1);
    EXPECT_NEAR(predicted("draft", 90.0) / 1.15e-3, 1.0, 0.1);
    EXPECT_NEAR(predicted("standard", 60.0) / 1.05e-3, 1.0, 0.1);
}

TEST(MeshPlan, predicts_memory_near_what_programs_took) {
    // Resident sets of cutterFoam on one rank: 446 MB with 61,305 cells, 938 MB with 302,969; of snappyHexMesh: 1.5 GiB with 1,084,260.
    EXPECT_NEAR(plan_mesh(model_mesh_input("draft")).prediction.run_memory / 446e6, 1.0, 0.1);
    EXPECT_NEAR(plan_mesh(model_mesh_input("standard")).prediction.run_memory / 938e6, 1.0, 0.1);
    EXPECT_NEAR(plan_mesh(model_mesh_input("paper")).prediction.mesh_memory / 1.61e9, 1.0, 0.1);
}

TEST(MeshPlan, refuses_passages_below_two_cells_and_names_the_preset_that_resolves_them) {
    MeshInput input = model_mesh_input();
    input.cutter.passage = 0.02;
    const std::vector<Mistake> mistakes = refusals(input);
    ASSERT_EQ(mistakes.size(), 1u);
    EXPECT_TRUE(contains(mistakes[0].what, "0.02 m")) << mistakes[0].what;
    EXPECT_TRUE(contains(mistakes[0].rule, "2 cells across, 0.03 m at preset draft")) << mistakes[0].rule;
    EXPECT_TRUE(contains(mistakes[0].remedy, "Use mesh.preset = \"standard\"")) << mistakes[0].remedy;
    input.resolution = mesh_preset("standard");
    EXPECT_TRUE(refusals(input).empty());
    input.cutter.passage = 0.005;
    EXPECT_FALSE(contains(refusals(input).at(0).remedy, "preset")) << "no preset resolves it";
}

TEST(MeshPlan, warns_of_steel_thinner_than_its_cells_and_names_the_preset_that_resolves_it) {
    MeshInput input = model_mesh_input();  // cells of the cutter's: 15 mm at draft, 7.5 mm at standard, 4.5 mm at paper
    EXPECT_TRUE(mesh_warnings(input).empty()) << "thickness not asked for";
    input.cutter.thickness = 0.016;
    EXPECT_TRUE(mesh_warnings(input).empty());
    input.cutter.thickness = 0.012;
    const std::vector<Mistake> warnings = mesh_warnings(input);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(contains(warnings[0].what, "0.012 m")) << warnings[0].what;
    EXPECT_TRUE(contains(warnings[0].rule, "cells, 0.015 m at preset draft")) << warnings[0].rule;
    EXPECT_TRUE(contains(warnings[0].remedy, "Use mesh.preset = \"standard\"")) << warnings[0].remedy;
    input.cutter.thickness = 0.004;
    EXPECT_FALSE(contains(mesh_warnings(input).at(0).remedy, "preset")) << "no preset resolves it";
    EXPECT_NO_THROW(plan_mesh(input)) << "the gate on the steel's volume judges the mesh";
}

TEST(MeshPlan, refuses_a_gap_that_cannot_hold_the_interface_and_names_the_preset_that_resolves_it) {
    MeshInput input = model_mesh_input();
    input.steel.gap = 0.02;
    const std::vector<Mistake> mistakes = refusals(input);
    ASSERT_EQ(mistakes.size(), 1u);
    EXPECT_TRUE(contains(mistakes[0].what, "cutter")) << mistakes[0].what;
    EXPECT_TRUE(contains(mistakes[0].what, "backplate")) << mistakes[0].what;
    EXPECT_TRUE(contains(mistakes[0].what, "0.02 m")) << mistakes[0].what;
    EXPECT_TRUE(contains(mistakes[0].rule, "0.02667 m")) << mistakes[0].rule;
    EXPECT_TRUE(contains(mistakes[0].remedy, "standard")) << mistakes[0].remedy;
    EXPECT_TRUE(contains(mistakes[0].remedy, "suction.gap_m at least 0.02667")) << mistakes[0].remedy;

    input.resolution = mesh_preset("standard");
    EXPECT_TRUE(refusals(input).empty());
}

TEST(MeshPlan, accepts_what_its_refusals_ask_for) {
    const auto number_after = [](const std::string& text, const std::string& words) {
        const std::size_t at = text.find(words);
        EXPECT_NE(at, std::string::npos) << text;
        return std::stod(text.substr(at + words.size()));
    };
    for (const double ring : {0.17, 0.2, 0.2137, 0.25, 0.311}) {
        MeshInput input = model_mesh_input();
        input.cutter.z_max = 0.0037 * ring;
        input.ring_radius = ring;
        input.tank = {100.0 * ring, -100.0 * ring, 100.0 * ring};
        input.steel.gap = 0.01 * ring;
        input.steel.mouth.radius = 0.01 * ring;
        const std::vector<Mistake> mistakes = refusals(input);
        ASSERT_EQ(mistakes.size(), 2u);
        input.steel.gap = number_after(mistakes[0].remedy, "suction.gap_m at least ");
        input.steel.mouth.radius = number_after(mistakes[1].rule, "a radius of ");
        for (const Mistake& mistake : refusals(input)) ADD_FAILURE() << ring << ": " << mistake.text();
    }
}

TEST(MeshPlan, refuses_a_cutter_that_reaches_the_backplate_without_naming_a_preset) {
    MeshInput input = model_mesh_input();
    input.cutter.z_max = 0.035;
    const std::vector<Mistake> mistakes = refusals(input);
    ASSERT_EQ(mistakes.size(), 1u);
    EXPECT_TRUE(contains(mistakes[0].what, "-0.005 m")) << mistakes[0].what;
    EXPECT_FALSE(contains(mistakes[0].remedy, "preset")) << mistakes[0].remedy;
    EXPECT_TRUE(contains(mistakes[0].remedy, "suction.gap_m at least 0.06167")) << mistakes[0].remedy;
}

TEST(MeshPlan, places_the_interface_above_parts_that_stand_over_the_ring_plane) {
    MeshInput input = model_mesh_input();
    input.cutter.z_max = 0.01;
    input.steel.gap = 0.05;
    const MeshPlan plan = plan_mesh(input);
    EXPECT_NEAR(plan.rotor.z_top, 0.03, 1e-12);
    EXPECT_EQ(plan.zone.front().to, 0.01);
}

TEST(MeshPlan, names_every_lack_of_room_at_once) {
    MeshInput input = model_mesh_input();
    input.tank = {0.45, -0.56, 0.06};
    input.steel.mouth.radius = 0.03;
    const std::vector<Mistake> mistakes = refusals(input);
    ASSERT_EQ(mistakes.size(), 4u);
    EXPECT_TRUE(contains(mistakes[0].what, "mouth_radius"));
    EXPECT_TRUE(contains(mistakes[0].remedy, "standard"));
    EXPECT_TRUE(contains(mistakes[1].what, "tank.radius_m"));
    EXPECT_TRUE(contains(mistakes[2].remedy, "bed_clearance"));
    EXPECT_TRUE(contains(mistakes[3].remedy, "tank.height_m"));
}

TEST(MeshPlan, takes_sizes_that_are_not_positive_for_a_defect) {
    const std::vector<std::function<void(MeshInput&)>> spoil = {
        [](MeshInput& i) { i.ring_radius = 0.0; },       [](MeshInput& i) { i.cutter.volume = -1.0; },
        [](MeshInput& i) { i.cutter.z_min = 0.1; },      [](MeshInput& i) { i.discharge = 0.0; },
        [](MeshInput& i) { i.rotation_speed = 0.0; },    [](MeshInput& i) { i.max_courant = NAN; },
        [](MeshInput& i) { i.steel.mouth.radius = 0.0; }};
    for (const auto& change : spoil) {
        MeshInput input = model_mesh_input();
        change(input);
        EXPECT_THROW(plan_mesh(input), std::invalid_argument);
    }
}

TEST(MeshPreset, is_one_of_three) {
    EXPECT_GT(mesh_preset("draft").cell_size, mesh_preset("standard").cell_size);
    EXPECT_GT(mesh_preset("standard").cell_size, mesh_preset("paper").cell_size);
    // 4 mm at the blades of the model: snapped cells measure 0.445 of the background's.
    EXPECT_NEAR(0.445 * mesh_preset("paper").cell_size * 0.4, 0.004, 1e-4);
    EXPECT_THROW(mesh_preset("fine"), UserError);
}

TEST(CutterExtent, is_that_of_the_surface) {
    // A tetrahedron with its corner in the origin.
    const geometry::TriangleSurface corner{{Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(0, 4, 0), Vec3(0, 0, -2)},
                                           {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
    const CutterExtent extent = extent_of_cutter(corner);
    EXPECT_EQ(extent.radius, 4.0);
    EXPECT_EQ(extent.z_min, -2.0);
    EXPECT_EQ(extent.z_max, 0.0);
    EXPECT_NEAR(extent.volume, 4.0, 1e-12);
    EXPECT_NEAR(extent.area, 6.0 + 3.0 + 4.0 + 0.5 * std::sqrt(64.0 + 36.0 + 144.0), 1e-12);
}

}  // namespace
}  // namespace cutterflow::meshing
