/// Rooms with a medium: boundaries, closures, files of the flow, warnings.
#include <unistd.h>

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cases/runner/room_stages.hpp"
#include "cases/scenes/room/room_case.hpp"
#include "cases/scenes/room/room_flow.hpp"
#include "cases/scenes/room/room_mesh.hpp"
#include "cases/scenes/room/room_prediction.hpp"
#include "cases/testing/stone.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string k_tank = R"(
[scene]
kind = "room"
[room]
size_m = [0.4, 0.2, 0.3]
medium = "water"
cell_m = 0.02
[[solid]]
name = "riser"
generate = "tube"
from_m = [0, 0, 0.1]
to_m = [0, 0, 0.3]
inner_radius_m = 0.04
wall_m = 0.01
)" + test::k_stone + R"([[grains]]
name = "stones"
material = "stone"
density_kg_m3 = 2650
diameter_m = 0.008
[[prepare]]
do = "pour"
grains = "stones"
count = 50
region = { box = { lower_m = [-0.19, -0.09, 0.0], upper_m = [0.19, 0.09, 0.09] } }
[run]
end_s = 2
)";
const char* const k_out = "[[boundary]]\non = \"top\"\ninside = \"riser\"\nname = \"out\"\nflow = { outflow_m_s = 1.5, ramp_s = 0.5 }\n";
const char* const k_free = "[[boundary]]\non = \"sides\"\nabove_m = 0.1\nname = \"free\"\nflow = \"pressure\"\n";

class RoomFlow : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("cutterflow_room_flow_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    RoomRequest request(const std::string& text) const {
        write_file(folder_ / "room.toml", text);
        return read_room_request(folder_ / "room.toml");
    }
    std::string mistakes_of(const std::string& text) const {
        try {
            request(text);
        } catch (const UserError& error) {
            return error.what();
        }
        return {};
    }
    std::string file_of(const RoomRequest& of, const std::string& path) const {
        for (const CaseText& file : flow_files(of.scene, *of.mesh))
            if (file.path == path) return file.text;
        return {};
    }
    /// Text of a patch's condition in a field.
    std::string condition(const RoomRequest& of, const std::string& field, const std::string& patch) const {
        const std::string text = file_of(of, "0/" + field);
        const std::size_t from = text.find("    " + patch + "\n");
        return from == std::string::npos ? "" : text.substr(from, text.find('}', from) - from);
    }
    std::string warnings_of(const RoomRequest& of) const {
        std::string text;
        for (const Mistake& warning : room_warnings(of.values, of.scene, of.pieces, of.mesh)) text += warning.text() + "\n";
        return text;
    }

    fs::path folder_;
};

TEST_F(RoomFlow, boundaries_are_patches_with_conditions_of_every_field) {
    const RoomRequest room = request(k_tank + k_out + k_free);
    EXPECT_THAT(condition(room, "U", "out"), HasSubstr("flowRateOutletVelocity"));
    EXPECT_THAT(condition(room, "U", "out"), HasSubstr("volumetricFlowRate"));
    EXPECT_THAT(condition(room, "U", "free"), HasSubstr("pressureInletOutletVelocity"));
    EXPECT_THAT(condition(room, "U", "riser"), HasSubstr("noSlip"));
    EXPECT_THAT(condition(room, "U", "bottom"), HasSubstr("noSlip"));
    EXPECT_THAT(condition(room, "p", "free"), HasSubstr("fixedValue"));
    for (const char* patch : {"out", "riser", "x_min", "top"}) EXPECT_THAT(condition(room, "p", patch), HasSubstr("fixedFluxPressure"));
    EXPECT_THAT(condition(room, "epsilon", "free"), HasSubstr("inletOutlet"));
    EXPECT_THAT(file_of(room, "constant/dynamicMeshDict"), HasSubstr("staticFvMesh"));
    EXPECT_THAT(file_of(room, "system/controlDict"), ContainsRegex("maxCo +0.9;"));
    const auto& patches = room.mesh->input.patches;
    ASSERT_EQ(patches.size(), 2u);
    EXPECT_EQ(patches[0].sides, (std::vector<std::size_t>{5}));
    EXPECT_EQ(patches[1].sides.size(), 4u);
    EXPECT_FALSE(patches[0].wall);
}

/// Discharge: mean speed times the exact area of the bore, grown from a thousandth of it.
TEST_F(RoomFlow, discharge_is_speed_times_area) {
    const RoomRequest room = request(k_tank + k_out + k_free);
    const auto& flow = std::get<ThroughFlow>(room.scene.boundaries[0].flow);
    EXPECT_NEAR(flow.area, k_pi * 1.6e-3, 1e-12);
    EXPECT_FALSE(flow.into_room);
    // 1.5 m/s through pi 0.04^2 m2 is 7.5398223686155... litres per second.
    EXPECT_THAT(condition(room, "U", "out"), ContainsRegex("\\(\\(0 7\\.53982236861550*[0-9]*e-06\\) \\(0\\.5 0\\.0075398223686155"));
    EXPECT_EQ(outlet_patch(room.scene), "out");

    const RoomRequest given = request(k_tank +
                                      "[[boundary]]\non = \"x_min\"\nname = \"in\"\nflow = { inflow_m3_s = 0.003 }\n"
                                      "[[boundary]]\non = \"x_max\"\nflow = \"pressure\"\n");
    const auto& inflow = std::get<ThroughFlow>(given.scene.boundaries[0].flow);
    EXPECT_NEAR(inflow.area, 0.06, 1e-12);
    EXPECT_NEAR(inflow.speed.front().second, 0.05, 1e-12);
    EXPECT_THAT(condition(given, "U", "in"), HasSubstr("flowRateInletVelocity"));
    EXPECT_THAT(condition(given, "U", "in"), ContainsRegex("rho +voidFraction"));
    EXPECT_EQ(outlet_patch(given.scene), "x_max_2");
}

/// k_out grows for half a second.
TEST_F(RoomFlow, grains_at_rest_end_no_run_whose_flow_still_changes) {
    const auto stop_of = [&](const std::string& boundaries) {
        const RoomScene scene = request(k_tank + "stop = { settled = true }\n" + boundaries).scene;
        return grain_files(scene, "bed", 1).front().text;
    };
    const std::string grown = std::string(k_out) + k_free;
    EXPECT_THAT(stop_of(grown), ContainsRegex("from +0\\.5;"));
    EXPECT_THAT(stop_of(grown + "[[event]]\ndo = \"ramp\"\nboundary = \"out\"\nspeed_m_s = 1\nfrom_s = 1\nto_s = 1.25\n"),
                ContainsRegex("from +1\\.25;"));
    EXPECT_THAT(stop_of("[[boundary]]\non = \"x_min\"\nflow = { inflow_m3_s = 0.003 }\n"
                        "[[boundary]]\non = \"x_max\"\nflow = \"pressure\"\n"),
                AllOf(HasSubstr("atRest"), Not(ContainsRegex("from +[0-9]"))));
}

/// From 1.5 m/s at 0.5 s to 0.5 m/s between 1 and 1.2 s, and to three litres per second at 2 s.
TEST_F(RoomFlow, events_ramp_the_flow_through_a_boundary) {
    const auto ramp = [](const char* rest) { return std::string("[[event]]\ndo = \"ramp\"\nboundary = \"out\"\n") + rest + "\n"; };
    const std::string tank = k_tank + k_out + k_free;
    const std::string first = ramp("speed_m_s = 0.5\nfrom_s = 1\nto_s = 1.2");
    const RoomRequest room = request(tank + first + ramp("discharge_m3_s = 0.003\nfrom_s = 1.2\nto_s = 2"));
    const auto& flow = std::get<ThroughFlow>(room.scene.boundaries[0].flow);
    const std::vector<std::pair<double, double>> expected{{0.0, 0.0}, {0.5, 1.5}, {1.0, 1.5}, {1.2, 0.5}, {2.0, 0.003 / flow.area}};
    ASSERT_EQ(flow.speed.size(), expected.size());
    for (std::size_t n = 0; n < expected.size(); ++n) {
        EXPECT_EQ(flow.speed[n].first, expected[n].first) << n;
        EXPECT_NEAR(flow.speed[n].second, expected[n].second, 1e-12) << n;
    }
    EXPECT_THAT(
        condition(room, "U", "out"),
        ContainsRegex("\\(1\\.2 0\\.00251327[0-9]*\\) \\(2 0\\.003[0-9]*\\)|\\(1\\.2 0\\.00251327[0-9]*\\)[ \n]*\\(2 0\\.00(3|29999)"));
    const RoomRequest raised = request(tank + ramp("speed_m_s = 4\nfrom_s = 1\nto_s = 1.2"));
    EXPECT_EQ(fastest_flow(raised.scene), 4.0) << "the prediction and the turbulence know the ramp";

    EXPECT_THAT(mistakes_of(tank + ramp("speed_m_s = 1\nfrom_s = 0.4\nto_s = 1")), HasSubstr("Its flow changes until 0.5 s"));
    EXPECT_THAT(mistakes_of(tank + first + first), HasSubstr("Its flow changes until 1.2 s"));
    EXPECT_THAT(mistakes_of(tank + ramp("from_s = 1\nto_s = 2")), HasSubstr("neither speed_m_s nor discharge_m3_s"));
    EXPECT_THAT(mistakes_of(tank + "[[event]]\ndo = \"ramp\"\nboundary = \"free\"\nspeed_m_s = 1\nfrom_s = 1\nto_s = 2\n"),
                HasSubstr("Boundaries with an inflow or an outflow are out. Name one of them"));
    EXPECT_THAT(mistakes_of(tank + ramp("speed_m_s = 1\nfrom_s = 1\nto_s = 2\nrate_kg_s = 1")),
                HasSubstr("It belongs to do = \"feed\" and \"extract\""));
}

TEST_F(RoomFlow, a_laminar_room_has_no_turbulence_and_a_closed_one_a_reference_of_pressure) {
    std::string text = k_tank;
    text.replace(text.find("cell_m"), 6, "turbulence = \"laminar\"\ncell_m");
    const RoomRequest room = request(text);
    EXPECT_TRUE(file_of(room, "0/k").empty());
    EXPECT_THAT(file_of(room, "constant/turbulenceProperties"), ContainsRegex("simulationType +laminar"));
    EXPECT_THAT(file_of(room, "system/fvSolution"), HasSubstr("pRefCell"));
    const std::string coupling = grain_files(room.scene, "", 1).front().text;
    EXPECT_THAT(coupling, Not(HasSubstr("patches")));
    EXPECT_THAT(coupling, Not(ContainsRegex("medium +none")));
}

/// Nine times as many steps of a flow that the Courant number bounds: 0.9 of a cell of 20 mm at 40 m/s, and 0.1 of one.
TEST_F(RoomFlow, largest_courant_number_is_a_key) {
    std::string text = k_tank + "[[boundary]]\non = \"top\"\nname = \"jet\"\nflow = { inflow_m_s = 40 }\n" + k_free;
    const RoomRequest shipped = request(text);
    EXPECT_EQ(shipped.scene.run.max_courant, 0.9);
    text.replace(text.find("end_s = 2\n"), 10, "end_s = 2\nmax_courant = 0.1\n");
    const RoomRequest small = request(text);
    EXPECT_THAT(file_of(small, "system/controlDict"), ContainsRegex("maxCo +0.1;"));
    const auto step_of = [](const RoomRequest& of) { return predict(of.scene, of.pieces, of.mesh).flow_step; };
    EXPECT_NEAR(step_of(small), 0.1 * small.mesh->smallest_cell() / 40.0, 1e-12);
    EXPECT_LT(step_of(small), step_of(shipped));
    text.replace(text.find("max_courant = 0.1"), 17, "max_courant = 0.0");
    EXPECT_THAT(mistakes_of(text), HasSubstr("run.max_courant = 0"));
}

TEST_F(RoomFlow, closures_have_the_solver_s_defaults_and_go_into_the_case) {
    RoomRequest room = request(k_tank);
    EXPECT_EQ(room.scene.closures.hindrance, coupling::ClosureSettings().hindrance);
    EXPECT_EQ(room.scene.kernel.gamma, coupling::KernelSettings().gamma);
    room = request(k_tank + "[closures]\ndrag = \"gidaspow\"\nhindrance = \"none\"\nadded_mass = 0.0\n[kernel]\ngamma = 0.5\n");
    const std::string coupling = grain_files(room.scene, "", 1).front().text;
    EXPECT_THAT(coupling, ContainsRegex("drag +gidaspow;"));
    EXPECT_THAT(coupling, ContainsRegex("addedMass +0;"));
    EXPECT_THAT(coupling, ContainsRegex("gamma +0.5;"));
    EXPECT_THAT(coupling, ContainsRegex("wetRestitution +true;"));
}

TEST_F(RoomFlow, pressure_drops_are_recorded_at_their_two_places) {
    const RoomRequest room = request(k_tank + k_free +
                                     "[[measure]]\nname = \"drop\"\nwhat = \"pressure_drop\"\nupstream_m = [0.1, 0, 0.05]\n"
                                     "downstream_m = [0.1, 0, 0.25]\ndensity_kg_m3 = 1000\n");
    EXPECT_THAT(file_of(room, "system/controlDict"), HasSubstr("((0.1 0 0.05) (0.1 0 0.25))"));
}

TEST_F(RoomFlow, prediction_counts_cells_and_steps_of_the_flow) {
    const RoomRequest room = request(k_tank + k_out + k_free);
    const RoomPrediction found = predict(room.scene, room.pieces, room.mesh);
    EXPECT_NEAR(found.cells, 20.0 * 10.0 * 15.0, 0.05 * 3000.0);
    // Courant number 0.9 of 1.5 m/s in 20 mm: 12 ms; the longest step is 0.1 sqrt(d/g) = 2.86 ms.
    EXPECT_NEAR(found.flow_step, 0.1 * std::sqrt(0.008 / 9.81), 1e-9);
    EXPECT_GT(found.flow_seconds, 0.0);
    EXPECT_THAT(to_text(found), HasSubstr("flow step"));
}

TEST_F(RoomFlow, warns_of_what_a_run_may_be_asked_in_spite_of) {
    const std::string open = k_tank + k_out + k_free;
    // The bore has 10 grains of 8 mm. Its radius of 40 mm has 1.3 kernels of 1.5 cells, as cells of 20 mm are larger than grains, and 5
    // kernels of 8 mm in cells of 5 mm. The wall of 10 mm is thinner than cells of 20 mm.
    EXPECT_THAT(warnings_of(request(open)), HasSubstr("riser is 0.01 m thin in cells of 0.02 m"));
    EXPECT_THAT(warnings_of(request(open)), HasSubstr("radius of riser = 0.04. It is 1.3 times the kernel width in cells of 0.02 m"));
    EXPECT_THAT(warnings_of(request(open)), HasSubstr("Compare with smaller cells"));
    std::string fine = open;
    fine.replace(fine.find("cell_m = 0.02"), 13, "cell_m = 0.005");
    EXPECT_THAT(warnings_of(request(fine)), Not(HasSubstr("times the kernel width")));
    EXPECT_THAT(warnings_of(request(fine + "[kernel]\nsampling = \"quadratic\"\n")), HasSubstr("It is 5 times the kernel width"));
    EXPECT_THAT(warnings_of(request(open + "[closures]\ndrag_modifier = 3\n")), HasSubstr("counts it twice"));
    EXPECT_THAT(warnings_of(request(open + "[closures]\nhindrance = \"none\"\n")), HasSubstr("the drag of a single rock is too small"));
    EXPECT_THAT(warnings_of(request(fine + "[kernel]\ngamma = 2\n")), HasSubstr("2.5 times the kernel width of rock of 0.008 m"));
    EXPECT_THAT(warnings_of(request(fine + "[kernel]\ngamma = 2\nmap = \"centroid\"\n")), Not(HasSubstr("times the kernel width")));
    const std::string bin =
        "[[solid]]\nname = \"bin\"\ngenerate = \"hopper\"\ncentre_m = [0.12, 0, 0.15]\ninner_radius_m = 0.05\nheight_m = 0.1\n"
        "wall_m = 0.02\norifice_radius_m = 0.0125\n";
    EXPECT_THAT(warnings_of(request(fine + bin)), HasSubstr("opening of bin = 0.025. It is 3.1 times the kernel width"));
    std::string coarse = open;
    coarse.replace(coarse.find("diameter_m = 0.008"), 18, "diameter_m = 0.03");
    coarse.replace(coarse.find("count = 50"), 10, "count = 5");
    EXPECT_THAT(warnings_of(request(coarse)), HasSubstr("may block an opening below 3 lengths"));
}

struct Bad {
    const char *text, *what;
};

class BadFlow : public RoomFlow, public ::testing::WithParamInterface<Bad> {};

TEST_P(BadFlow, is_refused_with_what_value_rule_and_remedy) {
    const std::string mistakes = mistakes_of(k_tank + GetParam().text);
    EXPECT_THAT(mistakes, HasSubstr(GetParam().what));
    EXPECT_THAT(mistakes, HasSubstr("room.toml:"));
}

INSTANTIATE_TEST_SUITE_P(
    Rooms, BadFlow,
    ::testing::Values(
        Bad{"[[boundary]]\non = \"top\"\ninside = \"riser\"\nflow = { outflow_m_s = 1 }\n", "an outflow without an inlet"},
        Bad{"[[boundary]]\non = \"x_min\"\nflow = { inflow_m_s = 1 }\n[[boundary]]\non = \"x_max\"\nflow = { outflow_m_s = 1 }\n",
            "an inflow without an outlet"},
        Bad{"[[boundary]]\non = \"x_min\"\nflow = { inflow_m_s = 1, inflow_m3_s = 1 }\n", "inflow_m_s and inflow_m3_s"},
        Bad{"[[boundary]]\non = \"top\"\nflow = { inflow_m_s = 0.1 }\n[[boundary]]\non = \"top\"\ninside = \"riser\"\nflow = "
            "\"pressure\"\n",
            "covers a part of top_1"},
        Bad{"[[boundary]]\non = \"top\"\ndisc = { centre_m = [0, 0, 0.2], radius_m = 0.05 }\nflow = \"pressure\"\n",
            "is about no part of the side top"},
        Bad{"[[boundary]]\non = \"x_min\"\nrectangle = { lower_m = [-0.2, -0.3, 0], upper_m = [-0.2, 0.1, 0.1] }\nflow = \"pressure\"\n",
            "is about no part of the side x_min"},
        Bad{"[[boundary]]\non = \"sides\"\nabove_m = 0.5\nflow = \"pressure\"\n", "is about no part of the side x_min"},
        Bad{"[[boundary]]\non = \"top\"\nbelow_m = 0.1\nflow = \"pressure\"\n",
            "boundary.below_m = 0.1 on the side top. It bounds a part of vertical sides"},
        Bad{"[[boundary]]\non = \"bottom\"\nabove_m = 0.1\nflow = \"slip\"\n", "boundary.above_m = 0.1 on the side bottom"},
        Bad{"[[boundary]]\non = \"top\"\ninside = \"riser\"\ngrains = \"wall\"\n", "boundary.inside is given. The table has no flow"},
        Bad{"[[boundary]]\non = \"bottom\"\nflow = { rough_m = 0.001, ramp_s = 1 }\n",
            "boundary.flow.ramp_s is given. Only one speed or discharge grows"},
        Bad{"[[boundary]]\non = \"x_min\"\nflow = { times_s = [0, 1], speeds_m_s = [0, 1], ramp_s = 1 }\n",
            "boundary.flow.ramp_s is given. Only one speed or discharge grows"},
        Bad{"[[boundary]]\non = \"x_min\"\nflow = { inflow_m_s = 1, times_s = [0, 1] }\n",
            "boundary.flow.times_s is given. They are those of speeds_m_s"},
        Bad{"[[boundary]]\non = \"top\"\nname = \"riser\"\nflow = \"pressure\"\n", "boundary.name = \"riser\" is the name of another"},
        Bad{"[[boundary]]\non = \"top\"\nname = \"bottom\"\nflow = \"pressure\"\n", "boundary.name = \"bottom\" is the name of another"},
        Bad{"[[solid]]\nname = \"gate\"\ngenerate = \"box\"\nlower_m = [0.1, 0, 0.1]\nupper_m = [0.15, 0.05, 0.15]\n"
            "[[measure]]\nname = \"drop\"\nwhat = \"pressure_drop\"\nupstream_m = [0.1, 0, 0.05]\ndownstream_m = [0.12, 0.02, 0.12]\n"
            "density_kg_m3 = 1000\n",
            "measure.downstream_m of drop lies inside gate"},
        Bad{"[[measure]]\nname = \"drop\"\nwhat = \"pressure_drop\"\nupstream_m = [0.1, 0, 0.05]\ndownstream_m = [0.1, 0, 0.15]\n"
            "density_kg_m3 = 2\n",
            "measure.density_kg_m3 = 2 of drop. The room's water has 1000 kg/m3"},
        Bad{"[closures]\ndrag = \"gidaspow\"\n", "hindrance would count it twice"},
        Bad{"[kernel]\ncluster_size_m = 0.05\n", "kernel.cluster_size_m = 0.05 with kernel.map"},
        Bad{"[kernel]\nmap = \"cluster\"\ncluster_size_m = 0.01\n", "kernel.cluster_size_m = 0.01"},
        Bad{"[closures]\nadded_mass = 3\n", "closures.added_mass = 3"},
        Bad{"[[solid]]\nname = \"gate\"\ngenerate = \"box\"\nlower_m = [0.1, 0, 0.1]\nupper_m = [0.15, 0.05, 0.15]\nremoved_at_s = 1\n",
            "gate is taken away in water"},
        Bad{"[[room.refine]]\nbox = { lower_m = [-0.2, -0.1, 0], upper_m = [0.2, 0.1, 0.3] }\ncell_m = 0.001\n", "the mesh has"}));

TEST_F(RoomFlow, a_room_without_grains_is_refused) {
    const std::string water = "[scene]\nkind = \"room\"\n[room]\nsize_m = [1, 1, 1]\nmedium = \"water\"\ncell_m = 0.1\n[run]\nend_s = 1\n";
    EXPECT_THAT(mistakes_of(water), HasSubstr("The room has no grains"));
}

TEST_F(RoomFlow, closures_without_a_medium_are_refused) {
    std::string text = k_tank;
    text.replace(text.find("medium = \"water\"\ncell_m = 0.02\n"), 31, "");
    EXPECT_THAT(mistakes_of(text + "[closures]\nadded_mass = 0.3\n[kernel]\ngamma = 2\n"),
                testing::AllOf(HasSubstr("closures.added_mass is given"), HasSubstr("kernel.gamma is given")));
}

}  // namespace
}  // namespace cutterflow::cases
