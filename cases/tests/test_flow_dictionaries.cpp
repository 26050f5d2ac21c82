#include "cases/scenes/cutter/flow_dictionaries.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cases/scenes/cutter/case_builder.hpp"
#include "cases/testing/tiny_rotor_mesh.hpp"

namespace cutterflow::cases {
namespace {

/// The dictionary or value behind a path of keys; fails the test when it is not there.
const meshing::FoamValue* find(const meshing::FoamDictionary& dictionary, const std::string& key) {
    for (const meshing::FoamEntry& entry : dictionary.entries())
        if (entry.key == key) return &entry.values.front();
    return nullptr;
}

std::string text_of(const FoamFile& file, const std::string& key) {
    const meshing::FoamValue* value = find(file.contents, key);
    return value ? value->text() : "(missing " + key + ")";
}

const FoamFile& file_of(const std::vector<FoamFile>& files, const std::string& path) {
    const auto found = std::find_if(files.begin(), files.end(), [&](const FoamFile& file) { return file.path == path; });
    if (found == files.end()) throw std::runtime_error(path + " is missing");
    return *found;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(Turbulence, has_the_intensity_and_length_it_was_asked_for) {
    const double speed = 2.5, length = 0.028;
    const Turbulence turbulence = turbulence_of(speed, length);
    EXPECT_NEAR(std::sqrt(2.0 / 3.0 * turbulence.k) / speed, 0.05, 1e-12);
    EXPECT_NEAR(std::pow(0.09, 0.75) * std::pow(turbulence.k, 1.5) / turbulence.epsilon, length, 1e-12);
    EXPECT_NEAR(turbulence.eddy_viscosity(), std::pow(0.09, 0.25) * std::sqrt(turbulence.k) * length, 1e-12);
}

TEST(Fields, carry_discharge_and_the_fixed_pressure_of_the_circumference) {
    CaseInputs inputs = test::tiny_inputs();
    inputs.discharge = 0.12;
    const std::vector<FoamFile> files = field_files(inputs);
    ASSERT_EQ(files.size(), 5u);
    const std::string velocity = text_of(file_of(files, "0/U"), "boundaryField");
    EXPECT_TRUE(contains(velocity, "flowRateOutletVelocity"));
    EXPECT_TRUE(contains(velocity, "volumetricFlowRate 0.12;"));
    EXPECT_TRUE(contains(velocity, "pressureInletOutletVelocity"));
    EXPECT_TRUE(contains(velocity, "movingWallVelocity"));
    EXPECT_EQ(text_of(file_of(files, "0/p"), "dimensions"), "[0 2 -2 0 0 0 0]");
    for (const FoamFile& file : files) EXPECT_TRUE(contains(text_of(file, "boundaryField"), "cyclicAMI")) << file.path;
}

TEST(Fields, of_a_head_that_travels_let_the_far_water_through) {
    CaseInputs inputs = test::tiny_inputs();
    EXPECT_FALSE(contains(text_of(file_of(field_files(inputs), "0/U"), "boundaryField"), "inletOutlet;"));
    inputs.hauling = Vec3(0.0, -0.1, 0.0);
    const std::vector<FoamFile> files = field_files(inputs);
    const std::string velocity = text_of(file_of(files, "0/U"), "boundaryField");
    EXPECT_TRUE(contains(velocity, "inletValue      uniform (0 -0.1 0);")) << velocity;
    EXPECT_TRUE(contains(velocity, "fixedValue")) << "bed and top move with the ground";
    EXPECT_TRUE(contains(velocity, "noSlip")) << "backplate and pipe travel with the head";
    EXPECT_FALSE(contains(text_of(file_of(files, "0/p"), "boundaryField"), "freestreamPressure")) << "one pressure all around";
}

TEST(RotorMotion, is_the_same_in_mesh_motion_and_frozen_start) {
    CaseInputs inputs = test::tiny_inputs();
    inputs.rotor.speed = -3.5;
    const FoamFile moving = dynamic_mesh_file(inputs);
    const FoamFile frozen = frozen_rotor_file(inputs);
    for (const std::string& text : {text_of(moving, "solidBodyCoeffs"), text_of(frozen, "rotor")}) {
        EXPECT_TRUE(contains(text, "omega           -3.5;")) << text;
        EXPECT_TRUE(contains(text, "axis            (0 0 1);")) << text;
        EXPECT_TRUE(contains(text, "cellZone        rotor;")) << text;
    }
}

TEST(FrozenStart, has_no_moving_mesh_and_monitors_what_its_convergence_is_told_by) {
    const std::vector<FoamFile> files = start_system_files(test::tiny_inputs(), 250);
    const FoamFile& control = file_of(files, "system/controlDict");
    EXPECT_EQ(text_of(control, "endTime"), "250");
    EXPECT_EQ(text_of(control, "writeInterval"), "250");
    for (const char* monitor : {"torque", "outletPressure", "outletFlow", "inletFlow"})
        EXPECT_TRUE(contains(text_of(control, "functions"), monitor));
    EXPECT_TRUE(contains(text_of(file_of(files, "system/fvSchemes"), "divSchemes"), "bounded Gauss upwind"));
}

TEST(Run, takes_times_courant_number_and_convection_from_the_inputs) {
    CaseInputs inputs = test::tiny_inputs();
    inputs.times.end = 2.0;
    inputs.times.write_interval = 0.25;
    inputs.numerics.max_courant = 0.5;
    inputs.numerics.outer_correctors = 3;
    const std::vector<FoamFile> files = run_system_files(inputs);
    const FoamFile& control = file_of(files, "system/controlDict");
    EXPECT_EQ(text_of(control, "endTime"), "2");
    EXPECT_EQ(text_of(control, "writeInterval"), "0.25");
    EXPECT_EQ(text_of(control, "maxCo"), "0.5");
    EXPECT_TRUE(contains(text_of(file_of(files, "system/fvSolution"), "PIMPLE"), "nOuterCorrectors 3;"));
    // A factor of 1 is no relaxation, but makes OpenFOAM add to diagonals, as inertia that no fluid has.
    EXPECT_EQ(text_of(file_of(files, "system/fvSolution"), "relaxationFactors"), "(missing relaxationFactors)");
}

TEST(Run, convects_momentum_in_second_order_with_and_without_rock) {
    CaseInputs inputs = test::tiny_inputs();
    const auto convection = [&] { return text_of(file_of(run_system_files(inputs), "system/fvSchemes"), "divSchemes"); };
    EXPECT_TRUE(contains(convection(), "div(phi,U)      Gauss linearUpwindV grad(U);")) << convection();
    inputs.rock.emplace();
    EXPECT_TRUE(contains(convection(), "div(phi,U)      Gauss linearUpwindV grad(U);"));
    inputs.numerics.convection = ConvectionScheme::upwind;
    EXPECT_TRUE(contains(convection(), "div(phi,U)      Gauss upwind;"));
}

TEST(Decomposition, has_as_many_boxes_as_ranks) {
    const std::vector<std::pair<int, std::string>> cases = {{1, "(1 1 1)"}, {2, "(2 1 1)"}, {4, "(2 2 1)"},
                                                            {6, "(3 2 1)"}, {7, "(7 1 1)"}, {64, "(8 8 1)"}};
    for (const auto& [ranks, boxes] : cases) {
        const FoamFile file = decompose_file(ranks);
        EXPECT_EQ(text_of(file, "numberOfSubdomains"), std::to_string(ranks));
        EXPECT_TRUE(contains(text_of(file, "hierarchicalCoeffs"), boxes)) << ranks;
    }
}

TEST(Coupling, is_the_flow_alone_without_rock) {
    const meshing::FoamDictionary coupling = coupling_dictionary(test::tiny_inputs());
    EXPECT_EQ(find(coupling, "rock"), nullptr);
    EXPECT_NE(find(coupling, "fates"), nullptr);
    EXPECT_NE(find(coupling, "outflow"), nullptr);
    EXPECT_EQ(find(coupling, "stop"), nullptr);
}

TEST(Coupling, of_a_replay_observes_and_saves_nothing_of_the_flow) {
    CaseInputs inputs = test::tiny_inputs();
    inputs.rock.emplace();
    inputs.rock->contact.youngs_modulus = 1.1e8;
    inputs.rock->contact.max_speed = 4.0;
    inputs.rock->walls = standard_walls();
    inputs.replay = "/runs/demo/recording";
    const meshing::FoamDictionary replay = coupling_dictionary(inputs);
    for (const char* section : {"outflow", "velocity", "checkpoint", "record"}) EXPECT_EQ(find(replay, section), nullptr) << section;
    for (const char* section : {"rock", "fates", "replay"}) EXPECT_NE(find(replay, section), nullptr) << section;
    inputs.replay.clear();
    inputs.record = coupling::RecordSettings{1.0, 2.0, 48, 6};
    const meshing::FoamDictionary run = coupling_dictionary(inputs);
    EXPECT_NE(find(run, "record"), nullptr);
    EXPECT_EQ(find(run, "replay"), nullptr);
}

TEST(Coupling, has_the_keys_of_the_contract) {
    CaseInputs inputs = test::tiny_inputs();
    inputs.rock.emplace();
    inputs.rock->contact.youngs_modulus = 1.1e8;
    inputs.rock->contact.max_speed = 4.0;
    inputs.rock->walls = standard_walls();
    inputs.stop = coupling::StopSettings{0.05};
    const std::string text = coupling_dictionary(inputs).text();
    for (const char* entry : {"youngsModulus   110000000;",
                              "poissonRock     0.24;",
                              "poissonSteel    0.27;",
                              "rollingLaw      spring;",
                              "rock_steel",
                              "friction        0.35;",
                              "restitution     0.97;",
                              "rollingFriction 0.1;",
                              "wetRestitution  true;",
                              "timeStepFraction 0.1;",
                              "maxSpeed ",
                              "rotating        true;",
                              "type            cylinder;",
                              "map             gaussian;",
                              "sampling        gaussian;",
                              "clusterSize     0;",
                              "gamma           1;",
                              "minWidthInCells 1.5;",
                              "maxSolidFraction 0.7;",
                              "drag            brown_lawler;",
                              "hindrance       di_felice;",
                              "addedMass       0.5;",
                              "dragModifier    1;",
                              "sphericity      1;",
                              "lift            none;",
                              "viscousForce    true;",
                              "ringRadius      0.15;",
                              "zBackplate      0.02;",
                              "hysteresis      0.25;",
                              "binWidth ",
                              "undecided       0.05;",
                              "offset ",
                              "startTime       0;",
                              "interval        0.1;",
                              "keep            2;",
                              "feed            \"constant/rockFeed.csv\";",
                              "contour         \"constant/contour.csv\";"})
        EXPECT_TRUE(contains(text, entry)) << entry << "\nin\n" << text;
}

TEST(Dictionaries, have_balanced_brackets) {
    const CaseInputs inputs = test::tiny_inputs();
    for (const auto& files : {field_files(inputs), property_files(inputs), run_system_files(inputs), start_system_files(inputs, 10)}) {
        for (const FoamFile& file : files) {
            const std::string text = file.contents.text();
            for (const auto& [open, close] : {std::pair{'(', ')'}, {'{', '}'}, {'[', ']'}})
                EXPECT_EQ(std::count(text.begin(), text.end(), open), std::count(text.begin(), text.end(), close)) << file.path;
        }
    }
}

}  // namespace
}  // namespace cutterflow::cases
