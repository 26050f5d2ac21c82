/// Studies of rooms: reading, mistakes, preparation, files of the cases.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cases/runner/room_stages.hpp"
#include "cases/scenes/room/room_case.hpp"
#include "cases/scenes/room/room_prediction.hpp"
#include "cases/scenes/room/room_study.hpp"
#include "cases/scenes/study_kind.hpp"
#include "cases/study/contact_rules.hpp"
#include "cases/sweep/room_sweep.hpp"
#include "cases/testing/stone.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/io/write_stl.hpp"
#include "geometry/surface/simple_solids.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;
using test::k_stone;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

class RoomStudy : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("cutterflow_room_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// pair.clump: two spheres of radius 1, their centres `apart`.
    void write_pair(double apart) const {
        const auto sphere = [](double x) { return fmt::format("[[sphere]]\nx_m = {:.1f}\ny_m = 0.0\nz_m = 0.0\nradius_m = 1.0\n", x); };
        write(sphere(0.0) + sphere(apart), "pair.clump");
    }

    fs::path write(const std::string& text, const std::string& name = "room.toml") const {
        write_file(folder_ / name, text);
        return folder_ / name;
    }
    /// The template with one part exchanged.
    static std::string changed(const std::string& from, const std::string& to) {
        std::string text = room_template("heap");
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    }
    std::string mistakes_of(const std::string& text) const {
        try {
            read_room_request(write(text));
        } catch (const UserError& error) {
            EXPECT_EQ(error.code(), ExitCode::user_input);
            return error.what();
        }
        return {};
    }
    std::string warnings_of(const std::string& text) const {
        const RoomRequest request = read_room_request(write(text));
        std::string warnings;
        for (const Mistake& warning : room_warnings(request.values, request.scene, request.pieces, request.mesh))
            warnings += warning.text() + "\n";
        return warnings;
    }

    fs::path folder_;
};

const char* const k_end = "[run]\n";
const char* const k_dry = "medium = \"none\"              # weight and contacts alone\n";

double mass_of(const std::vector<PlacedGrain>& grains) {
    double mass = 0.0;
    for (const PlacedGrain& g : grains) mass += g.density * k_pi / 6.0 * std::pow(g.diameter, 3);
    return mass;
}

TEST_F(RoomStudy, template_reads_and_predicts_its_cost) {
    const RoomRequest request = read_room_request(write(room_template("heap \"1\"")));
    EXPECT_EQ(request.scene.name, "heap \"1\"");
    ASSERT_EQ(request.scene.solids.size(), 2u);
    EXPECT_EQ(request.scene.solids[1].travels.at(0).velocity, Vec3(0.0, 0.0, 0.03));
    EXPECT_EQ(request.scene.pairs.size(), 2u);
    ASSERT_EQ(request.pieces.size(), 1u);
    // 0.6 of a cylinder of radius 20 mm and height 60 mm, of grains whose mean volume is that of 4 mm and a bit more.
    const double mass = 2500.0 * 0.6 * k_pi * 4e-4 * 0.06;
    EXPECT_NEAR(mass_of(request.pieces[0].grains), mass, 0.5e-3 * mass);
    EXPECT_NEAR(static_cast<double>(request.pieces[0].grains.size()), mass / (2500.0 * k_pi / 6.0 * 6.4e-8 * (1.0 + 0.01 / 12.0)), 30.0);
    const RoomPrediction prediction = predict(request.scene, request.pieces, request.mesh);
    // 0.15 of the Rayleigh time of 3.8 mm at 5 MPa: pi R sqrt(rho/G)/(0.1631 nu + 0.8766)
    const double rayleigh = k_pi * 0.0019 * std::sqrt(2500.0 * 2.5 / 5e6) / (0.1631 * 0.25 + 0.8766);
    EXPECT_LE(prediction.contact_step, 0.15 * rayleigh * (1.0 + 1e-12));
    EXPECT_GT(prediction.contact_step, 0.05 * rayleigh);
    EXPECT_THAT(to_text(prediction), HasSubstr("tube moves from 0 to 4 s"));
}

/// Its grains find places too.
TEST_F(RoomStudy, template_measures_the_angle_of_its_heap) {
    const RoomScene scene = read_room(write(room_template("heap")));
    ASSERT_EQ(scene.measures.size(), 1u);
    EXPECT_EQ(scene.measures[0].at("what"), "angle");
}

TEST_F(RoomStudy, every_example_reads) {
    int studies = 0;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples")) {
        if (entry.path().extension() != ".toml" || kind_named_in(entry.path()) != "room") continue;
        EXPECT_NO_THROW(read_room_request(entry.path())) << entry.path();
        ++studies;
    }
    EXPECT_EQ(studies, 16);
}

/// The lines of a section of a study.
std::string section_of(const std::string& text, const std::string& name) {
    const std::size_t start = text.find("\n[" + name + "]\n");
    return start == std::string::npos ? "" : text.substr(start, text.find("\n[", start + 1) - start);
}

/// What lifts gravel into a pipe slows it in a box too: nothing is fitted to one of the two.
TEST_F(RoomStudy, examples_of_gravel_under_water_have_one_set_of_closures) {
    const fs::path examples = fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples";
    const std::string closures = section_of(read_file(examples / "suction_pipe/study.toml"), "closures");
    EXPECT_THAT(closures, HasSubstr("haider_levenspiel"));
    for (const char* study : {"suction_pipe/short.toml", "draw_down/submerged.toml", "draw_down/small_submerged.toml"}) {
        const std::string text = read_file(examples / study);
        EXPECT_EQ(section_of(text, "closures"), closures) << study;
        EXPECT_EQ(section_of(text, "kernel"), "") << study;
    }
}

/// Grains of a pour lie in its region as a whole, clear of each other and of the solids; batches come when earlier ones have fallen.
TEST_F(RoomStudy, poured_grains_have_room) {
    const RoomRequest request = read_room_request(write(changed("depth_m = 0.06", "depth_m = 0.07")));
    const std::vector<PlacedGrain>& grains = request.pieces.at(0).grains;
    std::set<int> ids;
    std::set<double> times;
    for (std::size_t i = 0; i < grains.size(); ++i) {
        const PlacedGrain& a = grains[i];
        ids.insert(a.id);
        times.insert(a.time);
        EXPECT_GE(a.diameter, 0.0038);
        EXPECT_LE(a.diameter, 0.0042);
        EXPECT_LE(a.position.head<2>().norm() + 0.5 * a.diameter, 0.02 + 1e-12);
        EXPECT_GE(a.position.z() - 0.5 * a.diameter, 0.03);
        EXPECT_LE(a.position.z() + 0.5 * a.diameter, 0.15 + 1e-12);
        EXPECT_EQ(a.velocity, Vec3(0.0, 0.0, -1.0));
        for (std::size_t j = 0; j < i; ++j)
            if (grains[j].time == a.time) {
                ASSERT_GE((grains[j].position - a.position).norm(), 0.5 * (a.diameter + grains[j].diameter)) << i << " " << j;
            }
    }
    EXPECT_EQ(ids.size(), grains.size());
    // 0.3 of a tube of 0.12 m is less than 0.6 of 0.07 m of it: two batches and more.
    EXPECT_GE(times.size(), 2u);
    const double fall = (std::sqrt(1.0 + 2.0 * 9.81 * 0.12) - 1.0) / 9.81;
    EXPECT_GE(*std::next(times.begin()), 2.0 * fall - 1e-12);
    // A place of a later batch may be taken by a grain that bounced, and buried before that has gone.
    for (const PlacedGrain& a : grains) {
        ASSERT_EQ(a.above.has_value(), a.time > 0.0);
        if (!a.above) continue;
        EXPECT_EQ(a.above->head<2>(), a.position.head<2>());
        EXPECT_NEAR(a.above->z() + 0.5 * a.diameter, 0.15, 1e-12);
    }
    // Later batches begin above a bed of half solids and the bumps of its surface: a place within the bed would never be free.
    for (const PlacedGrain& a : grains) {
        double volume = 0.0;
        for (const PlacedGrain& earlier : grains)
            if (earlier.time < a.time) volume += k_pi / 6.0 * std::pow(earlier.diameter, 3);
        if (volume > 0.0) {
            EXPECT_GE(a.position.z() - 0.5 * a.diameter, 0.03 + volume / (0.5 * k_pi * 0.02 * 0.02) + 2.0 * 0.0042 - 1e-9);
        }
    }
}

/// A block over 7 tenths of a region, 38 mm high: a depth is that of the grains beside it, and so is what the region holds.
TEST_F(RoomStudy, pours_beside_a_solid_are_for_the_room_that_it_leaves) {
    const auto with_block = [&](const std::string& pour) {
        std::string text =
            changed("depth_m = 0.06\nregion = { cylinder = { from_m = [0, 0, 0.03], to_m = [0, 0, 0.15], radius_m = 0.02 } }",
                    pour + "\nregion = { box = { lower_m = [-0.05, -0.05, 0.0], upper_m = [0.05, 0.05, 0.08] } }");
        text.erase(text.find("[[solid]]"), text.find("[[material]]") - text.find("[[solid]]"));
        return text + "\n[[solid]]\nname = \"block\"\ngenerate = \"box\"\nlower_m = [-0.05, -0.05, 0]\nupper_m = [0.02, 0.05, 0.038]\n";
    };
    const auto mass_with = [&](const std::string& pour) { return mass_of(read_room_request(write(with_block(pour))).pieces.at(0).grains); };
    EXPECT_NEAR(mass_with("depth_m = 0.02"), 2500.0 * 0.6 * 0.1 * 0.03 * 0.02, 0.02 * 0.09);
    EXPECT_NEAR(mass_with("depth_m = 0.05"), 2500.0 * 0.6 * 0.01 * (0.3 * 0.038 + 0.012), 0.02 * 0.351);
    // 0.8 litres less 0.266 hold 0.8 kg at 1500 kg/m3.
    EXPECT_EQ(mistakes_of(with_block("mass_kg = 0.45")), "");
    EXPECT_THAT(mistakes_of(with_block("mass_kg = 0.9")), ContainsRegex("Their region holds 0.00053[0-9]* m3 beside the solids"));
    // The second batch begins above a bed of half solids that fills the gap and then the whole width.
    const RoomRequest request = read_room_request(write(with_block("mass_kg = 0.45")));
    double first = 0.0, lowest = 1.0;
    for (const PlacedGrain& grain : request.pieces.at(0).grains)
        if (grain.time == 0.0)
            first += k_pi / 6.0 * std::pow(grain.diameter, 3);
        else
            lowest = std::min(lowest, grain.position.z());
    EXPECT_GE(lowest, 0.038 + (first / 0.5 - 0.3 * 0.038 * 0.01) / 0.01);
    EXPECT_LT(lowest, 0.08);
}

/// A bed knows what grains meet at the sides, not where its study says so.
TEST_F(RoomStudy, beds_are_the_same_whatever_else_the_boundaries_say) {
    const auto inputs_with = [&](const std::string& boundaries) {
        return bed_inputs(parse_parameters(room_table(), changed("[run]\n", boundaries + "\n[run]\n"), "room.toml"));
    };
    const std::string side = "[[boundary]]\non = \"y_min\"\ngrains = \"frictionless\"\n";
    const std::string top = "[[boundary]]\non = \"top\"\nflow = \"pressure\"\n", slip = "flow = \"slip\"\n";
    const auto inputs = inputs_with(side);
    EXPECT_EQ(inputs.at("boundary.y_min.grains"), "frictionless");
    EXPECT_EQ(inputs_with(top + side), inputs);
    EXPECT_EQ(inputs_with(side + slip + top), inputs);
    EXPECT_NE(inputs_with(top), inputs);
    EXPECT_NE(inputs_with("[[boundary]]\non = \"x_min\"\ngrains = \"frictionless\"\n"), inputs) << "another side";
}

TEST_F(RoomStudy, seeds_draw_other_grains_and_the_same_seed_the_same) {
    const auto grains_of = [&](const std::string& text) { return read_room_request(write(text)).pieces.at(0).grains; };
    const auto a = grains_of(room_template("heap")), b = grains_of(room_template("heap")),
               c = grains_of(changed("[run]\n", "[run]\nseed = 2\n"));
    EXPECT_EQ(a.front().position, b.front().position);
    EXPECT_NE(a.front().position, c.front().position);
    EXPECT_NEAR(mass_of(a), mass_of(c), 1e-4);
}

TEST_F(RoomStudy, classes_have_their_shares_of_the_mass) {
    const std::string text =
        changed("diameter_m = { uniform_by_number = [0.0038, 0.0042] }\n",
                "[[grains.class]]\ndiameter_m = 0.004\nmass_share = 3\n[[grains.class]]\ndiameter_m = 0.002\nmass_share = 1\n");
    const RoomRequest request = read_room_request(write(text));
    double fine = 0.0, all = 0.0;
    for (const PlacedGrain& g : request.pieces.at(0).grains) {
        const double volume = std::pow(g.diameter, 3);
        all += volume;
        if (g.diameter < 0.003) fine += volume;
    }
    EXPECT_NEAR(fine / all, 0.25, 0.03);
}

/// Half the mass is of light grains: of the same size they are 2.5 times as many. Those of a class that says nothing have the kind's
/// density.
TEST_F(RoomStudy, classes_may_have_densities_of_their_own) {
    const auto with = [&](const std::string& light) {
        return changed("diameter_m = { uniform_by_number = [0.0038, 0.0042] }\n",
                       "[[grains.class]]\ndiameter_m = 0.004\n[[grains.class]]\ndiameter_m = 0.004\n" + light);
    };
    const RoomRequest mixed = read_room_request(write(with("density_kg_m3 = 1000\n")));
    const RoomGrains& beads = mixed.scene.grains.front();
    const double sphere = k_pi / 6.0 * 6.4e-8;
    EXPECT_NEAR(beads.mean_density(), 2.0 / (1.0 / 2500.0 + 1.0 / 1000.0), 1e-9);
    EXPECT_NEAR(beads.mean_mass(), beads.mean_density() * sphere, 1e-12);
    EXPECT_EQ(mixed.scene.densest_grain(), 2500.0);
    std::map<double, int> grains;
    for (const PlacedGrain& g : mixed.pieces.at(0).grains) ++grains[g.density];
    ASSERT_EQ(grains.size(), 2u);
    EXPECT_NEAR(grains[1000.0] / static_cast<double>(grains[2500.0]), 2.5, 0.45);  // three standard deviations of 1,270 draws
    // The bed is as deep as one of heavy grains alone: 0.6 of the same volume is full.
    const double depth = 0.06 * k_pi * 4e-4;
    EXPECT_NEAR((grains[1000.0] + grains[2500.0]) * sphere, 0.6 * depth, 0.02 * depth);
    EXPECT_NEAR(mass_of(mixed.pieces.at(0).grains), 0.6 * depth * beads.mean_density(), 1e-4);

    // Light grains make the contact step shorter: the Rayleigh time goes with the root of the density.
    const RoomRequest heavy = read_room_request(write(with("")));
    EXPECT_NEAR(contact_step(mixed.scene, mixed.scene.contact) / contact_step(heavy.scene, heavy.scene.contact), std::sqrt(0.4), 0.15);
    EXPECT_LT(contact_step(mixed.scene, mixed.scene.contact), contact_step(heavy.scene, heavy.scene.contact));
    std::string given = with("density_kg_m3 = 2500\n");
    EXPECT_EQ(bed_name(read_room_request(write(given)).scene, read_room_request(write(given)).pieces), bed_name(heavy.scene, heavy.pieces))
        << "a density that is given changes nothing";
    EXPECT_THAT(mistakes_of(with("density_kg_m3 = 1\n")), HasSubstr("grains.class.density_kg_m3 = 1"));
}

/// Before grains are taken out or frozen they come to rest, and so they do at the end.
TEST_F(RoomStudy, preparation_is_cut_into_pieces_that_end_at_rest) {
    const std::string text = changed("[[prepare]]\ndo = \"settle\"\n",
                                     "[[prepare]]\ndo = \"trim\"\nabove_m = 0.06\n\n[[prepare]]\ndo = \"freeze\"\nbelow_m = 0.035\n");
    const RoomRequest request = read_room_request(write(text));
    ASSERT_EQ(request.pieces.size(), 2u);
    EXPECT_FALSE(request.pieces[0].grains.empty());
    EXPECT_TRUE(request.pieces[0].events.empty());
    EXPECT_TRUE(request.pieces[1].grains.empty());
    ASSERT_EQ(request.pieces[1].events.size(), 2u);
    EXPECT_EQ(request.pieces[1].events[0].what, "remove");
    EXPECT_TRUE(is_within(request.pieces[1].events[0].region, Vec3(0.0, 0.0, 0.061)));
    EXPECT_FALSE(is_within(request.pieces[1].events[0].region, Vec3(0.0, 0.0, 0.059)));
    EXPECT_EQ(request.pieces[1].events[1].what, "freeze");

    const std::vector<CaseText> files = bed_case(request.scene, request.pieces[1], "../1/checkpoints/0.5", "../../");
    EXPECT_EQ(files.front().path, "constant/couplingProperties");
    EXPECT_THAT(files.front().text, ContainsRegex("start +\"../1/checkpoints/0.5\";"));
    EXPECT_THAT(files.front().text, HasSubstr("halfSpace"));
    EXPECT_THAT(files.front().text, HasSubstr("atRest"));
    EXPECT_THAT(files.front().text, HasSubstr("calming")) << "of the preparation alone";
    for (const CaseText& file : grain_files(request.scene, "bed", 1)) EXPECT_THAT(file.text, Not(HasSubstr("calming")));
    EXPECT_THAT(files.front().text, Not(HasSubstr("travel")));
    for (const CaseText& file : files) EXPECT_NE(file.path, "constant/rockFeed.csv");
}

/// 250 grains of 5 mm lie 20 mm high at their loosest, in a room of 45 mm.
TEST_F(RoomStudy, a_pour_after_a_trim_begins_above_what_is_left) {
    const auto steps = [](const std::vector<std::string>& between) {
        const std::string pour = "[[prepare]]\ndo = \"pour\"\ngrains = \"stones\"\ncount = 250\n";
        std::string text = R"([scene]
kind = "room"
[room]
size_m = [0.04, 0.04, 0.045]
)" + k_stone + R"([[grains]]
name = "stones"
material = "stone"
density_kg_m3 = 2650
diameter_m = 0.005
)" + pour;
        for (const std::string& step : between) text += "[[prepare]]\ndo = \"trim\"\n" + step + "\n" + pour;
        return text + "[run]\nend_s = 1\n";
    };
    const std::string level = "above_m = 0.005",
                      box = "region = { box = { lower_m = [-0.02, -0.02, 0.005], upper_m = [0.02, 0.02, 0.045] } }";
    const auto pieces = read_room_request(write(steps({level, level}))).pieces;
    ASSERT_EQ(pieces.size(), 3u);
    for (const BedPiece& piece : pieces) EXPECT_EQ(piece.grains.size(), 250u);
    for (const PlacedGrain& grain : pieces[1].grains)
        EXPECT_GE(grain.position.z(), 0.005 + 2.0 * 0.005 + 0.5 * 0.005 - 1e-9) << "above the bumps of what is left";
    EXPECT_THAT(mistakes_of(steps({"above_m = 0.03"})),
                AllOf(ContainsRegex("[0-9]+ of 250 grains of stones find no place"), Not(HasSubstr("trim takes out"))));
    EXPECT_THAT(mistakes_of(steps({box})),
                AllOf(ContainsRegex("[0-9]+ of 250 grains of stones find no place"), HasSubstr("another region than one above a level")));
}

TEST_F(RoomStudy, a_step_freeze_that_finds_no_grains_is_a_mistake) {
    const std::string steps = "[[prepare]]\ndo = \"trim\"\nabove_m = 0.06\n\n[[prepare]]\ndo = \"freeze\"\nabove_m = 0.055\n\n";
    const RoomRequest request = read_room_request(write(changed("[[prepare]]\ndo = \"settle\"\n", steps)));
    const BedPiece& piece = request.pieces.at(1);
    EXPECT_TRUE(empty_freezes(piece, {Vec3(0, 0, 0.04), Vec3(0, 0, 0.056)}).empty());
    const std::vector<Mistake> mistakes = empty_freezes(piece, {Vec3(0, 0, 0.04), Vec3(0.001, 0, 0.05), Vec3(0, 0, 0.061)});
    ASSERT_EQ(mistakes.size(), 1u) << "the highest one was taken out before";
    EXPECT_THAT(mistakes[0].text(), ContainsRegex("room.toml:[0-9]+: do = \"freeze\" finds 0 grains"));
    EXPECT_THAT(mistakes[0].text(), HasSubstr("those of its 2 lie from (0, 0, 0.04) to (0.001, 0, 0.05) m"));
    EXPECT_THAT(empty_freezes(piece, {Vec3(0, 0, 0.07)}).at(0).text(), HasSubstr("the bed has none"));
}

TEST_F(RoomStudy, a_run_is_at_rest_while_its_bed_still_rings) {
    const RoomRequest request = read_room_request(write(room_template("heap")));
    EXPECT_THAT(bed_case(request.scene, request.pieces.front(), "", "../../").front().text, ContainsRegex("energy +1e-06;"));
    EXPECT_THAT(grain_files(request.scene, "bed", 1).front().text, ContainsRegex("energy +1e-05;"));
}

TEST_F(RoomStudy, grains_may_be_clumps_and_begin_with_room_for_any_orientation) {
    const std::string two =
        "[[sphere]]\nx_m = 0.0\ny_m = 0.0\nz_m = 0.0\nradius_m = 1.0\n"
        "[[sphere]]\nx_m = 1.0\ny_m = 0.0\nz_m = 0.0\nradius_m = 1.0\n";
    write(two, "flat.clump");
    const RoomRequest request = read_room_request(write(changed("[[grains]]\n", "[[grains]]\nshape = \"flat.clump\"\n")));
    const RoomGrains& grains = request.scene.grains.front();
    EXPECT_GT(grains.girth(), 1.1);
    const std::vector<CaseText> files = bed_case(request.scene, request.pieces.front(), "", "../../");
    EXPECT_THAT(files.front().text, ContainsRegex("shapes"));
    int found = 0;
    for (const CaseText& file : files) {
        if (file.path == "constant/shapes/" + grains.name + ".clump") found += file.text == two ? 1 : 0;
        if (file.path == "constant/rockFeed.csv") {
            EXPECT_THAT(file.text, HasSubstr(",shape\n1,"));
            EXPECT_THAT(file.text, HasSubstr("," + grains.name + "\n2,"));
        }
    }
    EXPECT_EQ(found, 1);
    const std::vector<PlacedGrain>& placed = request.pieces.front().grains;
    for (std::size_t i = 0; i < placed.size(); ++i)
        for (std::size_t j = i + 1; j < placed.size() && placed[j].time == placed[i].time; ++j)
            EXPECT_GT((placed[i].position - placed[j].position).norm(), grains.girth() * 0.5 * (placed[i].diameter + placed[j].diameter));
}

/// Contacts are of a clump's spheres, which are smaller and more.
TEST_F(RoomStudy, clumps_are_predicted_by_their_spheres) {
    write_pair(1.0);
    const std::string feed =
        "[[event]]\ndo = \"feed\"\ngrains = \"beads\"\nfrom_s = 1\nto_s = 2\nrate_kg_s = 0.05\n"
        "region = { box = { lower_m = [-0.01, -0.01, 0.13], upper_m = [0.01, 0.01, 0.15] } }\n";
    const auto predicted = [&](const std::string& study) {
        const RoomRequest request = read_room_request(write(study + feed));
        return predict(request.scene, request.pieces, request.mesh);
    };
    const RoomPrediction round = predicted(room_template("heap"));
    const RoomPrediction pairs = predicted(changed("[[grains]]\n", "[[grains]]\nshape = \"pair.clump\"\n"));
    const RoomScene scene = read_room(folder_ / "room.toml");
    const RoomGrains& kind = scene.grains.front();
    EXPECT_EQ(pairs.contact_step, contact_step(scene.contact, *kind.shape, kind.smallest(), kind.density));
    EXPECT_LT(pairs.contact_step, 0.9 * round.contact_step);
    EXPECT_GT(pairs.contact_step, 0.4 * round.contact_step);
    // Steps times grains that are there; those that are fed are from the middle of the feed on.
    const auto per_grain_and_step = [](const RoomPrediction& of) {
        const double time = static_cast<double>(of.grains) * (of.bed_time + of.end) + of.fed * (of.end - 1.5);
        return of.grain_seconds * of.contact_step / time;
    };
    EXPECT_NEAR(per_grain_and_step(pairs), 2.0 * per_grain_and_step(round), 1e-6 * per_grain_and_step(round));
}

/// The DEM would leave them waiting for ever.
TEST_F(RoomStudy, clumps_that_reach_too_far_for_the_room_are_refused) {
    write_pair(1.5);
    const auto room = [](double side, double diameter) {
        return fmt::format(R"([scene]
kind = "room"
[room]
size_m = [0.04, {}, 0.2]
{}[[grains]]
name = "pairs"
material = "stone"
density_kg_m3 = 2650
diameter_m = {}
shape = "pair.clump"
[[prepare]]
do = "pour"
grains = "pairs"
count = 2
[run]
end_s = 1
)",
                           side, k_stone, diameter);
    };
    const RoomScene scene = read_room(write(room(0.08, 0.004)));
    const double girth = scene.grains.front().girth(), longest = 0.125 * 0.08;  // [m]: a quarter of half of the larger side
    const double largest = longest / (0.5 * girth);
    EXPECT_EQ(mistakes_of(room(0.08, 0.99 * largest)), "");
    EXPECT_THAT(mistakes_of(room(0.08, 1.01 * largest)),
                AllOf(ContainsRegex("room.toml:[0-9]+: clumps pairs of up to"), HasSubstr("an eighth of the room's larger horizontal side"),
                      HasSubstr("0.01 m")));
    EXPECT_EQ(mistakes_of(room(0.081, 1.01 * largest)), "");
}

TEST_F(RoomStudy, an_opening_is_measured_by_the_length_of_clumps) {
    write_pair(1.5);
    const std::string shape = changed("[[grains]]\n", "[[grains]]\nshape = \"pair.clump\"\n");
    const RoomScene scene = read_room(write(shape));
    EXPECT_GT(scene.longest_grain(), 1.2 * scene.largest_grain());
    const auto with_bin = [&](double orifice) {
        std::string study = shape;
        return study.replace(study.find("[run]\n"), 6,
                             fmt::format("[[solid]]\nname = \"bin\"\ngenerate = \"hopper\"\ncentre_m = [0, 0, 0.01]\n"
                                         "inner_radius_m = 0.01\nheight_m = 0.01\nwall_m = 0.001\norifice_radius_m = {}\n[run]\n",
                                         0.5 * orifice));
    };
    EXPECT_THAT(mistakes_of(with_bin(2.9 * scene.longest_grain())), HasSubstr("An opening below 3 lengths of the longest grain"));
    EXPECT_THAT(mistakes_of(with_bin(3.1 * scene.longest_grain())), Not(HasSubstr("An opening below 3 lengths")));
}

TEST_F(RoomStudy, run_has_the_solids_that_are_left_and_their_motion) {
    const RoomRequest request = read_room_request(fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples/hopper/study.toml");
    const std::string bed = bed_case(request.scene, request.pieces.at(0), "", "../../").front().text;
    EXPECT_THAT(bed, HasSubstr("\"../../geometry/plug.stl\""));
    const std::string run = grain_files(request.scene, "bed/checkpoints/x", 1).front().text;
    EXPECT_THAT(run, Not(HasSubstr("plug")));
    EXPECT_THAT(run, ContainsRegex("medium +none;"));
    EXPECT_THAT(run, HasSubstr("rock_steel"));
    EXPECT_THAT(run, Not(HasSubstr("rock_polypropylene")));  // no wall is of it: the solver refuses such a pair
    EXPECT_THAT(run, Not(HasSubstr("feed ")));
    EXPECT_THAT(run, HasSubstr("gates"));
    EXPECT_THAT(run, HasSubstr("idle"));
    const std::string heap = grain_files(read_room(write(room_template("heap"))), "bed/checkpoints/x", 1).front().text;
    EXPECT_THAT(heap, HasSubstr("travel"));
}

/// 50 g of beads of 4 mm and 2500 kg/m3 in all, 25 g and half of their grains when the run ends in the middle of the feed.
TEST_F(RoomStudy, prediction_counts_fed_grains) {
    const std::string feed =
        "[[event]]\ndo = \"feed\"\ngrains = \"beads\"\nfrom_s = 1\nto_s = 2\nrate_kg_s = 0.05\n"
        "region = { box = { lower_m = [-0.01, -0.01, 0.13], upper_m = [0.01, 0.01, 0.15] } }\n";
    const auto predicted = [&](const std::string& text) {
        const RoomRequest request = read_room_request(write(text));
        return predict(request.scene, request.pieces, request.mesh);
    };
    const RoomPrediction without = predicted(room_template("heap")), with = predicted(room_template("heap") + feed);
    EXPECT_NEAR(with.fed_mass, 0.05, 1e-12);
    EXPECT_NEAR(with.fed, 0.05 / (2500.0 * k_pi / 6.0 * 6.4e-8 * (1.0 + 0.01 / 12.0)), 3.0);
    // The fed ones are there from the middle of the feed on.
    const double per_grain_and_second = without.grain_seconds / (static_cast<double>(without.grains) * (without.bed_time + without.end));
    EXPECT_NEAR(with.grain_seconds - without.grain_seconds, per_grain_and_second * with.fed * (with.end - 1.5), 1e-3 * with.grain_seconds);
    EXPECT_THAT(to_text(with), HasSubstr(" fed, 0.05 kg"));
}

TEST_F(RoomStudy, fed_grains_come_at_their_rate) {
    const std::string text = room_template("heap") +
                             "[[event]]\ndo = \"feed\"\ngrains = \"beads\"\nfrom_s = 1\nto_s = 2\nrate_kg_s = 0.05\n"
                             "region = { box = { lower_m = [-0.01, -0.01, 0.13], upper_m = [0.01, 0.01, 0.15] } }\n";
    const RoomScene scene = read_room(write(text));
    std::mt19937_64 random(1);
    const std::vector<PlacedGrain> fed = place_feeds(scene, 5000, random);
    EXPECT_NEAR(mass_of(fed), 0.05, 1e-4);
    EXPECT_EQ(fed.front().id, 5000);
    EXPECT_EQ(fed.front().time, 1.0);
    EXPECT_LT(fed.back().time, 2.0);
    double half = 0.0;
    for (const PlacedGrain& g : fed)
        if (g.time < 1.5) half += g.density * k_pi / 6.0 * std::pow(g.diameter, 3);
    EXPECT_NEAR(half, 0.025, 2e-4);
}

/// A block fills the region of a feed that begins at 1 s, until it is taken away or moves.
TEST_F(RoomStudy, feeds_are_clear_of_the_solids_that_are_there) {
    const auto with_block = [&](const std::string& fate) {
        return room_template("heap") +
               "\n[[solid]]\nname = \"block\"\ngenerate = \"box\"\nlower_m = [0.025, -0.01, 0.1]\nupper_m = [0.045, 0.01, 0.12]\n" + fate +
               "[[event]]\ndo = \"feed\"\ngrains = \"beads\"\nfrom_s = 1\nto_s = 2\nrate_kg_s = 0.01\n"
               "region = { box = { lower_m = [0.026, -0.01, 0.1], upper_m = [0.044, 0.01, 0.12] } }\n";
    };
    const std::string moves = "velocity_m_s = [0, 0, 0.1]\nto_s = 3\n";
    for (const std::string& fate : {std::string("removed_at_s = 0\n"), std::string("removed_at_s = 1\n"), moves + "from_s = 0\n"})
        EXPECT_EQ(mistakes_of(with_block(fate)), "") << fate;
    for (const std::string& fate : {std::string(), std::string("removed_at_s = 1.5\n"), moves + "from_s = 2\n"})
        EXPECT_THAT(mistakes_of(with_block(fate)),
                    ContainsRegex("room.toml:[0-9]+: grains of beads find no place in the region of their feed at 1 s"))
            << fate;
    // Every feed without a place is told.
    std::string two = with_block("");
    two += two.substr(two.find("[[event]]"));
    const std::string mistakes = mistakes_of(two);
    EXPECT_NE(mistakes.find("find no place"), mistakes.rfind("find no place"));
}

TEST_F(RoomStudy, solids_turn_about_an_axis_of_their_own) {
    const std::string turn = "turn_rpm = -30\nturn_axis = [0, 3, 4]\nturn_origin_m = [0, 0.01, 0.08]";
    const RoomScene scene = read_room(write(changed("velocity_m_s = [0, 0, 0.03]", turn)));
    ASSERT_TRUE(scene.solids[1].turn);
    EXPECT_TRUE(scene.solids[1].travels.empty());
    EXPECT_NEAR(scene.solids[1].turn->speed, -k_pi, 1e-12);
    EXPECT_NEAR((scene.solids[1].turn->axis.direction - Vec3(0, 0.6, 0.8)).norm(), 0.0, 1e-12);
    EXPECT_EQ(scene.solids[1].turn->axis.origin, Vec3(0, 0.01, 0.08));
    EXPECT_EQ(scene.solids[1].turn->end, 4.0);
}

/// The tube moves by its own table until 4 s; events move it before and after, in any order of the file.
TEST_F(RoomStudy, events_move_solids_beside_their_own_motion) {
    const auto move = [](const char* rest) { return fmt::format("[[event]]\ndo = \"move\"\nsolid = \"tube\"\n{}\n\n", rest); };
    std::string text = changed("from_s = 0.0\nto_s = 4.0", "from_s = 1.0\nto_s = 2.0");
    text.insert(text.find(k_end),
                move("velocity_m_s = [0, 0, -0.5]\nfrom_s = 3\nto_s = 3.5") + move("velocity_m_s = [0.1, 0, 0]\nfrom_s = 2\nto_s = 3"));
    const RoomRequest request = read_room_request(write(text));
    const RoomSolid& tube = request.scene.solids.at(1);
    ASSERT_EQ(tube.travels.size(), 3u);
    EXPECT_EQ(tube.travels[1].velocity, Vec3(0.1, 0, 0));
    EXPECT_EQ(tube.travels[2].begin, 3.0);
    EXPECT_EQ(tube.fastest(), 0.5);
    EXPECT_TRUE(request.scene.is_as_at_first(tube, 1.0));
    EXPECT_FALSE(request.scene.is_as_at_first(tube, 1.5));
    const std::string run = grain_files(request.scene, "bed/checkpoints/x", 1).front().text;
    EXPECT_THAT(run, ContainsRegex("travel *\n? *\\("));
    EXPECT_THAT(to_text(predict(request.scene, request.pieces, request.mesh)), HasSubstr("tube moves from 2 to 3 s"));
    // Down 0.25 m in half a second, through the floor; the second look is at its events as well.
    EXPECT_THAT(warnings_of(text), HasSubstr("through a side of the room"));

    const RoomRequest one = read_room_request(write(room_template("heap")));
    EXPECT_EQ(bed_name(request.scene, request.pieces), bed_name(one.scene, one.pieces)) << "the preparation does not move solids";
}

TEST_F(RoomStudy, bed_is_named_by_what_makes_it) {
    const auto name_of = [&](const std::string& text) {
        const RoomRequest request = read_room_request(write(text));
        return bed_name(request.scene, request.pieces);
    };
    const std::string name = name_of(room_template("heap"));
    EXPECT_EQ(name_of(room_template("another name")), name);
    EXPECT_EQ(name_of(changed("velocity_m_s = [0, 0, 0.03]", "velocity_m_s = [0, 0, 0.06]")), name);
    EXPECT_NE(name_of(changed("rolling = 0.015", "rolling = 0.02")), name);
    EXPECT_NE(name_of(changed("inner_radius_m = 0.02", "inner_radius_m = 0.0201")), name);
    EXPECT_NE(name_of(changed("[run]\n", "[run]\nseed = 2\n")), name);
}

/// Stages know a bed by its inputs, a run finds it by its name. Tilts leave |g| other last digits, a fall through the room ends at 1.77
/// m/s.
TEST_F(RoomStudy, beds_of_equal_inputs_have_one_name) {
    const std::string way = "velocity_m_s = [0, 0, 0.03]", depth = "depth_m = 0.06", size = "size_m = [0.10, 0.10, 0.16]";
    const std::string pressed = "[[prepare]]\ndo = \"compress\"\nsolid = \"tube\"\npressure_pa = 1000\n\n[run]\n";
    const auto bed_of = [&](const std::string& text) {
        const RoomRequest request = read_room_request(write(text));
        return std::pair{bed_inputs(request.values), bed_name(request.scene, request.pieces)};
    };
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = changed(k_end, pressed);
        return text.replace(text.find(from), from.size(), to);
    };
    const auto bed = bed_of(with(way, way));
    for (const char* other : {"velocity_m_s = [0, 0, 3]", "turn_rpm = 1000\nturn_axis = [0, 0, 1]\nturn_origin_m = [0, 0, 0]"})
        EXPECT_EQ(bed_of(with(way, other)), bed) << other;
    for (int tilt = 1; tilt <= 90; ++tilt) EXPECT_EQ(bed_of(with(size, size + fmt::format("\ntilt_deg = {}", tilt))), bed) << tilt;
    EXPECT_NE(bed_of(with(size, size + "\ngravity_m_s2 = 1.62")), bed);
    EXPECT_NE(bed_of(with(depth, "depth_m = 0.05")), bed);
}

TEST_F(RoomStudy, sweep_addresses_tables_by_name_and_shares_the_bed) {
    const fs::path study = write(room_template("heap"));
    const auto axes = [](const std::vector<std::string>& words) { return key_axes(room_table(), words, "params"); };
    const auto points_of = [&](const std::vector<KeyAxis>& varied, int repeats) {
        return room_sweep_points(study, read_placed_room(study), varied, repeats, 1);
    };
    auto points = points_of(axes({"solid.tube.velocity_m_s=[0,0,0.03],[0,0,0.015]"}), 2);
    ASSERT_EQ(points.size(), 4u);
    EXPECT_EQ(points[2].name, "room_tube.velocity_m_s_0_0_0.015_repeat1");
    EXPECT_EQ(room_scene(parse_parameters(room_table(), points[2].text, "x"), folder_).solids[1].travels.at(0).velocity.z(), 0.015);
    EXPECT_EQ(points[0].design, points[2].design);  // one bed for both speeds, of each pour
    EXPECT_NE(points[0].design, points[1].design);
    EXPECT_EQ(points[0].shared, (std::vector<std::string>{"geometry", "bed"}));

    points = points_of(axes({"contact.steel-glass.friction=0.1,0.2"}), 1);
    ASSERT_EQ(points.size(), 2u);
    EXPECT_TRUE(points[0].design.empty());  // its bed is its own
    const RoomScene scene = room_scene(parse_parameters(room_table(), points[1].text, "x"), folder_);
    EXPECT_EQ(scene.pairs[0].settings.friction, 0.3);
    EXPECT_EQ(scene.pairs[1].settings.friction, 0.2);

    const auto text_of = [&](const std::string& word) {
        try {
            points_of(axes({word}), 1);
        } catch (const UserError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_THAT(text_of("contact.glass-wood.friction=1"), HasSubstr("no table [[contact]] is called glass-wood"));
    EXPECT_THAT(text_of("contact.glass-glass.friction=abc"), HasSubstr("--set contact.glass-glass.friction=abc. The value is a number"));
    EXPECT_THAT(text_of("solid.tube.velocity_m_s=1"), HasSubstr("in brackets"));
    for (const char* seed : {"run.seed=1.5", "run.seed=1e300"}) EXPECT_THAT(text_of(seed), HasSubstr("a whole number"));
    EXPECT_THAT(text_of("contact.glass-glass.frictoin=1"), HasSubstr("there is no such key"));
    EXPECT_THAT(text_of("grains.beads.diameter_m=0.004"), HasSubstr("the study gives grains.diameter_m.uniform_by_number"));
    EXPECT_EQ(text_of("grains.beads.diameter_m.uniform_by_number=[0.003,0.004]"), "");
    EXPECT_THAT(text_of("contact.glass-glass.friction=0.1,0.2,0.1"), HasSubstr("friction has 0.1 twice"));
    EXPECT_THAT(text_of("contact.glass-glass.friction=0.1,0.2,0.10"), HasSubstr("friction has 0.10 twice"));
    EXPECT_THAT(text_of("contact.glass-glass.friction=0.1,-2"), HasSubstr("--set contact.glass-glass.friction = -2 is too low"));
    EXPECT_THAT(text_of("contact.glass-glass.friction=abc,-2"), AllOf(HasSubstr("friction=abc"), HasSubstr("friction = -2 is too low")));
    EXPECT_THAT(text_of("run.seed=1,1.0"), HasSubstr("run.seed has 1.0 twice"));
    EXPECT_THAT(text_of("solid.tube.velocity_m_s=[0,0,0.03],[0, 0, 3e-2]"), HasSubstr("has [0, 0, 3e-2] twice"));
    EXPECT_THROW(axes({"run.end_s=1", "run.end_s=2"}), UserError);
    // The later of two keys of one table would decide alone.
    for (const auto& words : {std::vector<std::string>{"contact.glass-glass.friction=0.1,0.2", "contact.friction=0.3"},
                              {"contact.glass-steel.friction=0.1", "contact.steel-glass.friction=0.2"}})
        try {
            points_of(axes(words), 1);
            ADD_FAILURE() << words.front();
        } catch (const UserError& error) {
            EXPECT_THAT(error.what(), HasSubstr("set the same key of one table"));
        }
    EXPECT_EQ(points_of(axes({"contact.glass-glass.friction=0.1", "contact.glass-steel.friction=0.2"}), 1).size(), 1u);
    // Placement is checked as well, before anything is run.
    EXPECT_THAT(text_of("prepare.depth_m=0.06,0.13"), HasSubstr("Their region holds"));
    EXPECT_NO_THROW(points_of(axes({"run.seed=1,2"}), 1));
    EXPECT_THROW(points_of(axes({"run.seed=1,2"}), 2), UserError);
}

TEST_F(RoomStudy, names_mistakes_of_all_sections_at_once) {
    std::string text = changed("generate = \"disc_with_rim\"", "generate = \"disk\"");
    text += "[[prepare]]\ndo = \"freeze\"\n\n[[event]]\ndo = \"extract\"\nfrom_s = 1\n";
    const std::string mistakes = mistakes_of(text);
    EXPECT_THAT(mistakes, HasSubstr("solid.generate = \"disk\" is no choice"));
    EXPECT_THAT(mistakes, HasSubstr("room.toml:"));

    text = changed("centre_m = [0, 0, 0.03]\nradius_m = 0.04", "centre_m = [0, 0, 0.03]\nradius_m = 0.06");
    text +=
        "[[prepare]]\ndo = \"freeze\"\n\n[[event]]\ndo = \"extract\"\nfrom_s = 1\nregion = { sphere = { centre_m = [9, 9, 9], radius_m = 1 "
        "} }\n";
    const std::string more = mistakes_of(text);
    EXPECT_THAT(more, HasSubstr("disc reaches from"));
    EXPECT_THAT(more, HasSubstr("do = \"freeze\" without a region"));
    EXPECT_THAT(more, HasSubstr("event.to_s is missing"));
    EXPECT_THAT(more, HasSubstr("event.rate_kg_s is missing"));
    EXPECT_THAT(more, HasSubstr("a region outside the room"));
}

TEST_F(RoomStudy, a_wrong_region_is_told_once_and_not_as_missing) {
    const auto with = [&](const std::string& keys) { return mistakes_of(changed(k_end, keys + "\n\n[run]\n")); };
    for (const char* step : {"[[prepare]]\ndo = \"freeze\"\n", "[[prepare]]\ndo = \"trim\"\n"}) {
        const std::string mistakes = with(std::string(step) + "above_m = 0.1\nbelow_m = 0.05");
        EXPECT_THAT(mistakes, AllOf(HasSubstr("A step has one region"), Not(HasSubstr("without a region"))));
    }
    const std::string two = "region = { above_m = 0.1, below_m = 0.05 }";
    for (const std::string step : {"[[prepare]]\ndo = \"freeze\"\n", "[[event]]\ndo = \"freeze\"\nat_s = 1\n"}) {
        EXPECT_THAT(with(step + two), AllOf(HasSubstr("A table has one region"), Not(HasSubstr("without a region"))));
        EXPECT_THAT(with(step + "region = {}"), AllOf(HasSubstr("region gives no part of space"), Not(HasSubstr("without a region"))));
    }
    // A pour whose region is wrong is not judged as one into the whole room.
    const std::string cylinder = "cylinder = { from_m = [0, 0, 0.03], to_m = [0, 0, 0.15], radius_m = 0.02 }";
    std::string text = changed(cylinder, "box = { lower_m = [0, 0, 0.1], upper_m = [0.01, 0.01, 0.05] }");
    text.replace(text.find("depth_m = 0.06"), 14, "depth_m = 9");
    EXPECT_THAT(mistakes_of(text), AllOf(HasSubstr("a box from"), Not(HasSubstr("Their region holds"))));
}

TEST_F(RoomStudy, a_solid_s_file_in_millimetres_is_told_so) {
    const auto mistakes = [&](double size) {
        geometry::write_stl(geometry::generate_box(Vec3(size, size, size), size), folder_ / "block.stl");
        return mistakes_of(changed(k_end, "[[solid]]\nname = \"block\"\nfile = \"block.stl\"\n\n[run]\n"));
    };
    EXPECT_THAT(mistakes(20.0),
                ContainsRegex("room.toml:[0-9]+: block reaches from .* m. It must lie in the room.*Export solid.file in metres"));
    for (const double size : {0.5, 2000.0}) EXPECT_THAT(mistakes(size), HasSubstr("Move it, or make the room larger")) << size;
}

TEST_F(RoomStudy, measures_are_checked_each_by_itself_and_all_in_their_room) {
    const std::string mistakes = mistakes_of(room_template("heap") + R"(
[[measure]]
name = "a"
what = "angel"
[[measure]]
name = "b"
what = "profile_error"
against = "gone.csv"
[[measure]]
name = "b"
what = "pressure_drop"
upstream_m = [0, 0, 0.01]
downstream_m = [0, 0, 9]
density_kg_m3 = 1
[[measure]]
name = "door"
what = "passed_mass"
gate = { disc_m = [0, 0, 0.1], radius_m = -1 }
[[measure]]
name = "c"
what = "rate"
gate = "door"
)");
    for (const char* part : {"what = \"angel\"", "measure.name = \"b\" is given twice", "gate.radius_m = -1",
                             "measure.downstream_m = (0, 0, 9) of b lies outside the room"})
        EXPECT_THAT(mistakes, HasSubstr(part));
    EXPECT_THAT(mistakes, HasSubstr("there is no file " + (folder_ / "gone.csv").string()));
    EXPECT_THAT(mistakes, Not(HasSubstr("measure.gate = \"door\""))) << "its own mistake is told";
    EXPECT_THAT(mistakes, Not(HasSubstr("measure.upstream_m")));
}

TEST_F(RoomStudy, a_wrong_name_of_a_measure_is_told_with_its_number) {
    const std::string measure = "[[measure]]\nname = \"{}\"\nwhat = \"wall_force\"\nwall = \"disc\"\n";
    const std::string mistakes = mistakes_of(room_template("heap") + fmt::format(measure, "b") + fmt::format(measure, "c d"));
    EXPECT_THAT(mistakes, HasSubstr("measure 3: name = \"c d\". A name has letters, digits, _ and -. Change it."));
    EXPECT_THAT(mistakes, Not(HasSubstr("measure 1")));
}

TEST_F(RoomStudy, a_given_profile_is_read_before_the_run) {
    const auto with = [&](const std::string& csv) {
        write(csv, "p.csv");
        return mistakes_of(
            changed(k_end, "[[measure]]\nname = \"x\"\nwhat = \"profile_error\"\nagainst = \"p.csv\"\n\n" + std::string(k_end)));
    };
    EXPECT_EQ(with("x_m,height_m\n0,0.02\n0.03,0.01\n"), "");
    EXPECT_THAT(with("x,h\n0,0.02\n0.03,0.01\n"), HasSubstr("p.csv:1: column 'x_m' is missing"));
    EXPECT_THAT(with("x_m,height_m\n0,high\n0.03,0.01\n"), HasSubstr("p.csv:2: height_m = 'high'"));
    EXPECT_THAT(with("x_m,height_m\n0.03,0.02\n0.01,0.01\n"), HasSubstr("p.csv:3: x_m = 0.01 after 0.03"));
    EXPECT_THAT(with(""), HasSubstr("p.csv: the file cannot be read or is empty"));
}

TEST_F(RoomStudy, corners_of_a_measure_s_region_have_words_that_hold_for_every_measure) {
    std::set<std::string> helps;
    for (const char* key : {"measure.region.box.lower_m", "measure.region.box.upper_m", "measure.region.sphere.centre_m",
                            "measure.region.cylinder.from_m", "measure.region.half_space.point_m"}) {
        const auto row = std::find_if(room_table().begin(), room_table().end(), [&](const Parameter& one) { return one.key == key; });
        ASSERT_NE(row, room_table().end()) << key;
        EXPECT_TRUE(helps.insert(row->help).second) << row->help;
        EXPECT_THAT(row->help, Not(HasSubstr("Mass that leaves")));
    }
}

TEST_F(RoomStudy, gates_may_lie_on_a_side_of_the_room) {
    const std::string gate = "[[measure]]\nname = \"x\"\nwhat = \"passed_mass\"\ngate = { disc_m = [0, 0, 0], radius_m = 0.01 }\n\n";
    EXPECT_EQ(mistakes_of(changed("[run]\n", gate + "[run]\n")), "");
}

struct Bad {
    const char *from, *to, *what;
};

class BadRoom : public RoomStudy, public ::testing::WithParamInterface<Bad> {};

TEST_P(BadRoom, is_refused_with_what_value_rule_and_remedy) {
    const std::string mistakes = mistakes_of(changed(GetParam().from, GetParam().to));
    EXPECT_THAT(mistakes, HasSubstr(GetParam().what));
    EXPECT_THAT(mistakes, HasSubstr("room.toml:"));
}

INSTANTIATE_TEST_SUITE_P(
    Rooms, BadRoom,
    ::testing::Values(
        Bad{"generate = \"tube\"", "generate = \"tubes\"", "Did you mean \"tube\""},
        Bad{"generate = \"tube\"\n", "", "neither generate nor file"},
        Bad{"generate = \"tube\"\n", "file = \"missing.stl\"\n", "missing.stl"},
        Bad{"to_m = [0, 0, 0.15]", "to_m = [0, 0, 0.17]", "It must lie in the room"},
        Bad{"wall_m = 0.002\nvelocity_m_s", "velocity_m_s", "solid.wall_m is missing for tube"},
        Bad{"wall_m = 0.002\nvelocity_m_s", "wall_m = 0.002\nslot_m = 0.1\nvelocity_m_s", "solid.slot_m of tube"},
        Bad{k_end,
            "[[solid]]\nname = \"bin\"\ngenerate = \"hopper\"\ncentre_m = [0, 0, 0.01]\ninner_radius_m = 0.01\nheight_m = 0.01\nwall_m = "
            "0.001\n"
            "orifice_radius_m = 0.0062\n\n[run]\n",
            "An opening below 3 lengths"},
        Bad{"name = \"tube\"\n", "name = \"xMin\"\n", "A side of the room is called so"},
        Bad{k_dry, "medium = \"none\"\ngravity_m_s2 = 0\n", "gravity_m_s2"},
        Bad{k_end, "[[measure]]\nname = \"push\"\nwhat = \"wall_force\"\nwall = \"x_min\"\n\n[run]\n", "Name one of disc, tube"},
        Bad{"name = \"tube\"\n", "name = \"disc\"\n", "is given twice"}, Bad{"from_s = 0.0\n", "", "the motion of tube is not complete"},
        Bad{"to_s = 4.0\n", "to_s = 0.0\n", "It must be after from_s"},
        Bad{"from_s = 0.0\nto_s = 4.0", "from_s = 5\nto_s = 6", "solid.from_s = 5. The run ends at 4 s"},
        Bad{"from_s = 0.0\n", "from_s = 2\nremoved_at_s = 1\n",
            "solid.removed_at_s = 1 of tube. Its motion begins at 2 s, when it is gone"},
        Bad{"velocity_m_s", "turn_rpm = 5\nvelocity_m_s", "A solid travels or turns"},
        Bad{"velocity_m_s = [0, 0, 0.03]", "turn_rpm = 5", "the motion of tube is not complete"},
        Bad{"velocity_m_s = [0, 0, 0.03]", "turn_rpm = 5\nturn_axis = [0, 0, 0]\nturn_origin_m = [0, 0, 0]", "It is a direction"},
        Bad{"[[contact]]\npair = [\"glass\", \"steel\"]", "[[contact]]\npair = [\"glass\", \"steeel\"]", "Did you mean steel"},
        Bad{"pair = [\"glass\", \"steel\"]", "pair = [\"glass\", \"glass\"]", "[[contact]] of glass and steel is missing"},
        Bad{"pair = [\"glass\", \"steel\"]", "pair = [\"wood\", \"steel\"]", "One of the two is the grains' material"},
        Bad{"youngs_modulus_pa = 5e6\n", "", "Young's modulus of glass"},
        Bad{k_end, "[[material]]\nname = \"rubber\"\npoisson = 0.49\n\n[run]\n",
            "material.name = \"rubber\". Grains are of glass, and touch glass, steel"},
        Bad{k_end, "[[material]]\nname = \"steal\"\n\n[run]\n", "Did you mean steel?"},
        Bad{"uniform_by_number = [0.0038, 0.0042]", "uniform_by_number = [0.0042, 0.0038]", "The smaller diameter comes first"},
        Bad{"diameter_m = { uniform_by_number = [0.0038, 0.0042] }\n", "", "have no diameter"},
        Bad{"grains = \"beads\"", "grains = \"bead\"", "Did you mean beads"}, Bad{"depth_m = 0.06", "depth_m = 0.13", "Their region holds"},
        Bad{"depth_m = 0.06", "count = 12.5", "prepare.count"},
        Bad{k_end, "[run]\nwrite_interval_s = 1e-12\n", "A run has at most 10000 of them"},
        Bad{k_end,
            "[[event]]\ndo = \"feed\"\ngrains = \"beads\"\nfrom_s = 1\nto_s = 2\nrate_kg_s = 1e8\n"
            "region = { box = { lower_m = [-0.01, -0.01, 0.1], upper_m = [0.01, 0.01, 0.15] } }\n\n[run]\n",
            "A feed has at most 1000000"},
        Bad{"depth_m = 0.06", "depth_m = 0.06\ncount = 10", "a pour with 2 of depth_m, mass_kg and count"},
        Bad{"radius_m = 0.02 } }", "radius_m = 0.0018 } }", "grains of up to 0.0042 m in a region of 0.0036 m"},
        Bad{"depth_m = 0.06\nregion = { cylinder = { from_m = [0, 0, 0.03], to_m = [0, 0, 0.15], radius_m = 0.02 } }",
            "depth_m = 0.004\nregion = { box = { lower_m = [-0.01, -0.01, 0.021], upper_m = [0.01, 0.01, 0.029] } }",
            "prepare.depth_m = 0.004. It counts from the lower end of the region, and solids take all of that"},
        Bad{"depth_m = 0.06\nregion = { cylinder = { from_m = [0, 0, 0.03], to_m = [0, 0, 0.15], radius_m = 0.02 } }",
            "count = 1\nregion = { box = { lower_m = [-0.005, -0.005, 0.0255], upper_m = [0.005, 0.005, 0.0335] } }",
            "find no place in the region of their pour"},
        Bad{"uniform_by_number = [0.0038, 0.0042]", "uniform_by_number = [0.00002, 0.000021]", "A pour has at most 1000000"},
        Bad{"radius_m = 0.02 } }", "radius_m = 0.06 } }", "a cylinder of radius 0.06 m about (0, 0, 0.03) reaches out of the room"},
        Bad{"from_m = [0, 0, 0.03], to_m = [0, 0, 0.15], radius_m = 0.02", "from_m = [9, 0, 0.03], to_m = [9, 0, 0.15], radius_m = 0.02",
            "prepare.region is about a region outside the room"},
        Bad{"to_s = 4.0\n",
            "to_s = 4.0\nremoved_at_s = 2\n\n[[measure]]\nname = \"x\"\nwhat = \"wall_force\"\nwall = \"tube\"\nfrom_s = 2.5\n",
            "tube is taken away at 2 s, and the measure begins at 2.5 s"},
        Bad{"stop = { settled = true }",
            "stop = { measure = \"x\", idle_s = 1 }\n\n[[measure]]\nname = \"through\"\nwhat = \"rate\"\n"
            "gate = { disc_m = [0, 0, 0.1], radius_m = 0.01 }",
            "measures with a gate are through"},
        Bad{"[[prepare]]\ndo = \"pour\"", "[[prepare]]\ndo = \"settle\"\n\n[[prepare]]\ndo = \"pour\"", "before anything is poured"},
        Bad{k_end, "[[prepare]]\ndo = \"freeze\"\nabove_m = 0.2\n\n[run]\n", "a region outside the room"},
        Bad{k_end, "[[prepare]]\ndo = \"trim\"\nabove_m = 0.1\nbelow_m = 0.2\n\n[run]\n", "A step has one region"},
        Bad{k_end, "[[prepare]]\ndo = \"compress\"\nsolid = \"lid\"\npressure_pa = 1000\n\n[run]\n", "The study's solids are disc, tube"},
        Bad{k_end, "[[prepare]]\ndo = \"compress\"\nsolid = \"disc\"\n\n[run]\n", "prepare.pressure_pa is missing"},
        Bad{k_end, "[[prepare]]\ndo = \"compress\"\nsolid = \"disc\"\npressure_pa = 1e8\n\n[run]\n",
            "prepare.pressure_pa = 100000000 is too high"},
        Bad{k_end, "[[prepare]]\ndo = \"compress\"\nsolid = \"disc\"\npressure_pa = 10\ndirection = [0, 0, 0]\n\n[run]\n",
            "It must not be zero"},
        Bad{k_end, "[[prepare]]\ndo = \"trim\"\nabove_m = 0.1\npressure_pa = 10\n\n[run]\n", "It belongs to do = \"compress\""},
        Bad{k_end, "[[event]]\ndo = \"remove\"\nat_s = 9\nregion = { above_m = 0.05 }\n\n[run]\n", "The run ends at 4 s"},
        Bad{k_end, "[[event]]\ndo = \"move\"\nsolid = \"tube\"\nvelocity_m_s = [0, 0, 1]\nfrom_s = 3\nto_s = 5\n\n[run]\n",
            "A solid has one velocity at a time, and it moves from 0 to 4 s"},
        Bad{k_end, "[[event]]\ndo = \"move\"\nsolid = \"pipe\"\nvelocity_m_s = [0, 0, 1]\nfrom_s = 3\nto_s = 5\n\n[run]\n",
            "The study's solids are disc, tube"},
        Bad{k_end, "[[event]]\ndo = \"move\"\nsolid = \"disc\"\nfrom_s = 3\nto_s = 5\n\n[run]\n", "event.velocity_m_s is missing"},
        Bad{k_end, "[[event]]\ndo = \"move\"\nvelocity_m_s = [0, 0, 1]\nfrom_s = 3\nto_s = 2\n\n[run]\n", "do = \"move\" without solid"},
        Bad{k_end, "[[event]]\ndo = \"move\"\nsolid = \"disc\"\nvelocity_m_s = [0, 0, 1]\nfrom_s = 3\nto_s = 2\n\n[run]\n",
            "event.to_s = 2. It must be after from_s = 3"},
        Bad{k_end,
            "[[event]]\ndo = \"move\"\nsolid = \"disc\"\nvelocity_m_s = [0, 0, 1]\nfrom_s = 1\nto_s = 2\n"
            "region = { above_m = 0.05 }\n\n[run]\n",
            "event.region is given. It belongs to what is done to grains"},
        Bad{k_end, "[[event]]\ndo = \"move\"\nsolid = \"disc\"\nvelocity_m_s = [0, 0, 90]\nfrom_s = 1\nto_s = 2\n\n[run]\n",
            "disc moves at up to 90 m/s: grains that it meets sink into it"},
        Bad{"velocity_m_s = [0, 0, 0.03]\nfrom_s = 0.0\nto_s = 4.0\n",
            "removed_at_s = 1\n\n[[event]]\ndo = \"move\"\nsolid = \"tube\"\nvelocity_m_s = [0, 0, 1]\nfrom_s = 1\nto_s = 2\n",
            "a move of tube from 1 s on. It is taken away at 1 s"},
        Bad{k_end, "[[event]]\ndo = \"remove\"\nat_s = 1\nsolid = \"disc\"\nregion = { above_m = 0.05 }\n\n[run]\n",
            "event.solid is given. It belongs to do = \"move\""},
        Bad{k_end, "[[event]]\ndo = \"ramp\"\nboundary = \"top\"\nspeed_m_s = 1\nfrom_s = 1\nto_s = 2\n\n[run]\n",
            "No boundary has an inflow or an outflow"},
        Bad{"material = \"glass\"\ndensity", "material = \"glass beads\"\ndensity", "letters, digits"},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"angel\"\n\n[run]\n", "angel"},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"passed_mass\"\ngate = \"door\"\n\n[run]\n", "measure.gate = \"door\""},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"profile_error\"\nagainst = \"gone.csv\"\n\n[run]\n",
            "gone.csv. It is a CSV file of a profile"},
        Bad{k_end,
            "[[measure]]\nname = \"x\"\nwhat = \"passed_mass\"\n"
            "gate = { lower_m = [0.02, -0.025, 0], upper_m = [0.03, 0.025, 0.09], normal = [1, 0, 0] }\n\n[run]\n",
            "gate.lower_m = [0.02,-0.025,0.0] and upper_m = [0.03,0.025,0.09] are no rectangle"},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"angle\"\nat_s = -1\n\n[run]\n", "at_s = -1"},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"cavity\"\ncell_m = 1e-7\n\n[run]\n",
            "measure.cell_m = 1e-07 gives a map of 5.78e+09 cells"},
        Bad{k_end,
            "[[measure]]\nname = \"x\"\nwhat = \"pressure_drop\"\nupstream_m = [0, 0, 0]\ndownstream_m = [0, 0, 1]\n"
            "density_kg_m3 = 1\n\n[run]\n",
            "in a room without a medium"},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"wall_force\"\nwall = \"lid\"\n\n[run]\n", "measure.wall = \"lid\""},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"passed_mass\"\ngate = { disc_m = [0, 0, 9], radius_m = 0.1 }\n\n[run]\n",
            "measure.gate.disc_m = (0, 0, 9) of x lies outside the room. The room reaches from"},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"rate\"\ngate = { lower_m = [1, 1, 0], upper_m = [2, 2, 0] }\n\n[run]\n",
            "measure.gate.lower_m = (1, 1, 0) of x lies outside the room"},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"mass_in\"\nregion = { sphere = { centre_m = [0, 0, 9], radius_m = 1 } }\n\n[run]\n",
            "measure.x is about a region outside the room"},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"angle\"\nbase_m = 9\n\n[run]\n",
            "measure.base_m of x lies outside the room along z. The room reaches from"},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"angle\"\ncentre_m = [0, 9]\n\n[run]\n",
            "measure.centre_m of x lies outside the room along y"},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"cavity\"\nundisturbed_m = -9\n\n[run]\n",
            "measure.undisturbed_m of x lies outside the room along z"},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"profile\"\nalong = \"y\"\nfrom_m = 9\n\n[run]\n",
            "measure.from_m of x lies outside the room along y"},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"angle\"\nat_s = 9\n\n[run]\n", "measure.at_s = 9. The run ends at 4 s"},
        Bad{k_end, "[[measure]]\nname = \"x\"\nwhat = \"wall_force\"\nwall = \"disc\"\nto_s = 4.5\n\n[run]\n",
            "measure.to_s = 4.5. The run ends at 4 s"},
        Bad{"name = \"tube\"", "name = \"tube\"\nremoved_at_s = 4.5", "solid.removed_at_s = 4.5. The run ends at 4 s"},
        Bad{"stop = { settled = true }", "stop = { measure = \"gone\", idle_s = 1 }",
            "It names a measure with a gate, and the study has none"},
        Bad{"stop = { settled = true }", "stop = { measure = \"gone\", below_kg_s = 1, window_s = 1 }",
            "It names a measure with a gate, and the study has none"},
        Bad{"stop = { settled = true }", "stop = { measure = \"angle\", below_kg_s = 1 }", "only one of below_kg_s and window_s"},
        Bad{"stop = { settled = true }", "stop = { below_kg_s = 1, window_s = 1 }", "Give measure, and idle_s or below_kg_s"},
        Bad{"stop = { settled = true }", "stop = { measure = \"angle\", idle_s = 1, below_kg_s = 1, window_s = 1 }",
            "run.stop with idle_s and below_kg_s. A run has one stop rule"},
        Bad{"stop = { settled = true }", "stop = { measure = \"angle\", below_kg_s = 1, window_s = 5 }",
            "run.stop.window_s = 5. The run ends at 4 s"},
        Bad{"stop = { settled = true }",
            "stop = { measure = \"push\", below_kg_s = 1, window_s = 1 }\n\n[[measure]]\nname = \"push\"\nwhat = \"wall_force\"\n"
            "wall = \"disc\"\n\n[[measure]]\nname = \"through\"\nwhat = \"rate\"\n"
            "gate = { disc_m = [0, 0, 0.1], radius_m = 0.01 }",
            "Only what passes gates is counted while the run goes on; measures with a gate are through"},
        Bad{"stop = { settled = true }", "write_interval_s = 5", "run.write_interval_s = 5"},
        Bad{k_end, "[run]\nmax_courant = 0.5\n", "Without a medium nothing flows"},
        Bad{k_dry, "medium = \"none\"\ncell_m = 0.01\n", "Without a medium there are neither flow nor mesh"},
        Bad{k_dry, "medium = \"water\"\n", "room.cell_m is missing"},
        Bad{k_dry, "medium = \"water\"\ncell_m = 0.01\n\n[[boundary]]\non = \"top\"\nflow = { inflow_m_s = 1 }\n",
            "an inflow without an outlet"},
        Bad{k_dry, "medium = \"water\"\ncell_m = 0.01\n\n[[boundary]]\non = \"top\"\ninside = \"disc\"\nflow = \"pressure\"\n",
            "boundary.inside = \"disc\""},
        Bad{k_dry, "medium = \"none\"\n\n[[boundary]]\non = \"top\"\nflow = \"pressure\"\n", "boundary.flow in a room without a medium"},
        Bad{k_dry,
            "medium = \"none\"\n\n[[boundary]]\non = \"bottom\"\ngrains = \"open\"\ndisc = { centre_m = [0, 0, 0], radius_m = 0.01 }\n",
            "boundary.disc is given. The table has no flow"},
        Bad{k_dry, "medium = \"none\"\n\n[[boundary]]\non = \"sides\"\ngrains = \"open\"\nabove_m = 0.1\n",
            "boundary.above_m is given. The table has no flow"},
        Bad{k_dry, "medium = \"water\"\ncell_m = 0.01\n", "The mesh stands still"}));

TEST_F(RoomStudy, a_misspelt_key_is_told_once_and_hides_no_other_mistake) {
    const std::string misspelt = mistakes_of(changed("end_s = 4", "ennd_s = 4"));
    EXPECT_THAT(misspelt, HasSubstr("Did you mean run.end_s?"));
    EXPECT_THAT(misspelt, Not(HasSubstr("is missing")));
    std::string text = changed("to_m = [0, 0, 0.15]", "to_m = [0, 0, 0.17]");
    text.replace(text.find("poisson"), 7, "x_key = 1\npoisson");
    const std::string both = mistakes_of(text);
    EXPECT_LT(both.find("It must lie in the room"), both.find("x_key"));  // as the file has them
    EXPECT_NE(both.find("x_key"), std::string::npos);
}

TEST_F(RoomStudy, a_missing_file_of_a_solid_is_its_only_mistake) {
    std::string text =
        changed(k_dry, "medium = \"water\"\ncell_m = 0.01\n\n[[boundary]]\non = \"top\"\ninside = \"tube\"\nflow = \"pressure\"\n");
    text.replace(text.find("generate = \"tube\""), 17, "fluid = true\nfile = \"gone.stl\"");
    const std::string mistakes = mistakes_of(text);
    EXPECT_THAT(mistakes, ContainsRegex("room.toml:[0-9]+: .*gone.stl: the file does not exist"));
    EXPECT_THAT(mistakes, Not(HasSubstr("boundary.inside")));
}

TEST_F(RoomStudy, warns_of_grains_that_are_soft_for_their_bed) {
    const auto warnings = [&](const std::string& modulus) {
        const RoomRequest request = read_room_request(write(changed("youngs_modulus_pa = 5e6", "youngs_modulus_pa = " + modulus)));
        return room_warnings(request.values, request.scene, request.pieces, request.mesh);
    };
    EXPECT_TRUE(warnings("1e6").empty());
    const auto soft = warnings("5000");
    ASSERT_EQ(soft.size(), 2u);  // and of the tube that lifts them
    EXPECT_THAT(soft[1].text(),
                ContainsRegex("room.toml:[0-9]+: youngs_modulus_pa = 5000. Grains under the poured bed sink 0\\.[0-9]+ diam"));
}

/// Grains of 5 MPa, 2500 kg/m3: delta/R = (5 pi/4 rho u^2 (2 - 2 nu^2)/E)^0.4.
TEST_F(RoomStudy, contacts_allow_for_the_speed_of_solids) {
    const std::string way = "velocity_m_s = [0, 0, 0.03]";
    const auto with_speed = [&](const char* speed) { return changed(way, fmt::format("velocity_m_s = [0, 0, {}]", speed)); };
    const auto overlap = [](double speed) { return std::pow(1.25 * k_pi * 2500.0 * speed * speed * 1.875 / 5e6, 0.4); };
    const double fall = std::sqrt(2.0 * 9.81 * read_room(write(room_template("heap"))).size.z());
    EXPECT_NEAR(read_room(write(with_speed("0.03"))).contact.max_speed, fall, 1e-12);
    ASSERT_LT(fall, 3.0);
    EXPECT_NEAR(read_room(write(with_speed("3"))).contact.max_speed, 3.0, 1e-12);
    // A turning tube of 40 mm: its rim.
    const RoomScene turning = read_room(write(changed(way, "turn_rpm = 1000\nturn_axis = [0, 0, 1]\nturn_origin_m = [0, 0, 0]")));
    EXPECT_NEAR(turning.contact.max_speed, rpm_to_rad_s(1000.0) * turning.solids[1].fastest() / turning.solids[1].turn->speed, 1e-9);
    EXPECT_GT(turning.contact.max_speed, rpm_to_rad_s(1000.0) * 0.0199);

    ASSERT_GT(overlap(3.0), 0.05);
    const RoomRequest request = read_room_request(write(with_speed("3")));
    const auto warnings = room_warnings(request.values, request.scene, request.pieces, request.mesh);
    EXPECT_THAT(warnings.front().text(), HasSubstr(fmt::format("sink into it by {:.2g} of their radius", overlap(3.0))));
    ASSERT_GT(overlap(50.0), 0.5);
    EXPECT_THAT(mistakes_of(with_speed("50")), ContainsRegex("room.toml:[0-9]+: tube moves at up to 50 m/s"));
    std::string slow_step = with_speed("3");
    slow_step.replace(slow_step.find(k_end), std::strlen(k_end), "[dem]\nmax_speed_m_s = 2\n\n[run]\n");
    EXPECT_THAT(mistakes_of(slow_step), HasSubstr("impacts at up to dem.max_speed_m_s = 2"));
}

TEST_F(RoomStudy, warns_of_a_solid_that_goes_through_a_closed_side) {
    EXPECT_EQ(warnings_of(room_template("heap")), "");  // up, where the room is open
    const std::string way = "velocity_m_s = [0, 0, 0.03]", through = "through a side of the room";
    EXPECT_THAT(warnings_of(changed(way, "velocity_m_s = [0, 0, -0.03]")), HasSubstr("tube moves 0.0899 m " + through));
    EXPECT_THAT(warnings_of(changed(way, "removed_at_s = 0.5\nvelocity_m_s = [0, 0, -0.03]")), Not(HasSubstr(through)));  // gone before
    EXPECT_THAT(warnings_of(changed(way, "turn_rpm = 5\nturn_axis = [1, 0, 0]\nturn_origin_m = [0, 0, 0.03]")), HasSubstr(through));
}

/// A bar is within the room again after each of its 20 turns; its way ends with to_s, not with the run.
TEST_F(RoomStudy, looks_at_a_solid_within_its_turns) {
    const auto with_bar = [&](const std::string& motion) {
        return warnings_of(
            changed("size_m = [0.10, 0.10, 0.16]", "size_m = [0.14, 0.10, 0.40]") +
            "\n[[solid]]\nname = \"bar\"\ngenerate = \"box\"\nlower_m = [-0.06, -0.005, 0.38]\nupper_m = [0.06, 0.005, 0.39]\n"
            "turn_axis = [0, 0, 1]\nturn_origin_m = [0, 0, 0]\nfrom_s = 0\n" +
            motion);
    };
    EXPECT_THAT(with_bar("turn_rpm = 300\nto_s = 4\n"), HasSubstr("bar moves 0.0102 m through a side"));  // hypot(0.06, 0.005) less 0.05
    EXPECT_EQ(with_bar("turn_rpm = 5\nto_s = 1\n"), "") << "30 degrees";
}

TEST_F(RoomStudy, warns_of_solids_that_overlap_or_run_into_one_another) {
    const auto with_block = [&](const std::string& from, const std::string& to, const std::string& more = "") {
        return warnings_of(room_template("heap") + "\n[[solid]]\nname = \"block\"\ngenerate = \"box\"\nlower_m = " + from +
                           "\nupper_m = " + to + "\n" + more);
    };
    const std::string beneath = with_block("[-0.02, -0.02, 0.005]", "[0.02, 0.02, 0.025]");
    EXPECT_THAT(beneath, ContainsRegex("room.toml:[0-9]+: block and disc overlap by 0.005 m at the start"));
    EXPECT_EQ(with_block("[-0.02, -0.02, 0.005]", "[0.02, 0.02, 0.02]"), "") << "the disc stands on it";
    EXPECT_THAT(with_block("[-0.05, -0.002, 0.08]", "[0.05, 0.002, 0.084]"), HasSubstr("block and tube overlap"))
        << "no corner lies in the tube";
    const std::string comes = "velocity_m_s = [0.05, 0, 0]\nfrom_s = 1\nto_s = 2\n";
    EXPECT_THAT(with_block("[-0.05, -0.005, 0.14]", "[-0.03, 0.005, 0.15]", comes),
                HasSubstr("block and tube run into one another at 1.1"));
    EXPECT_EQ(with_block("[-0.05, -0.005, 0.14]", "[-0.03, 0.005, 0.15]", comes + "removed_at_s = 1.1\n"), "") << "gone before";
    // The tube, of 64 corners around, moves up in a sleeve of its own radius that turns.
    EXPECT_EQ(warnings_of(room_template("heap") +
                          "\n[[solid]]\nname = \"sleeve\"\ngenerate = \"tube\"\nfrom_m = [0, 0, 0.05]\nto_m = [0, 0, 0.1]\n"
                          "inner_radius_m = 0.022\nwall_m = 0.002\nturn_rpm = 7\nturn_axis = [0, 0, 1]\nturn_origin_m = [0, 0, 0]\n"
                          "from_s = 0\nto_s = 4\n"),
              "");
}

TEST_F(RoomStudy, warns_of_a_feed_that_the_run_s_end_cuts_short) {
    const auto warnings = [&](const std::string& times) {
        const RoomRequest request = read_room_request(
            write(changed(k_end, "[[event]]\ndo = \"feed\"\ngrains = \"beads\"\n" + times +
                                     "\nrate_kg_s = 0.01\nregion = { box = { lower_m = [-0.01, -0.01, 0.1], upper_m = [0.01, 0.01, 0.15] "
                                     "} }\n\n[run]\n")));
        return room_warnings(request.values, request.scene, request.pieces, request.mesh);
    };
    EXPECT_TRUE(warnings("from_s = 1\nto_s = 4").empty());
    const std::vector<Mistake> cut = warnings("from_s = 1\nto_s = 7");
    ASSERT_EQ(cut.size(), 1u);
    EXPECT_THAT(cut[0].text(),
                ContainsRegex("room.toml:[0-9]+: event.to_s = 7 of a feed of beads. The run ends at 4 s: 0.03 of the 0.06 kg "
                              "that are ordered come in"));
}

TEST_F(RoomStudy, a_pour_of_as_many_grains_as_are_allowed_is_not_too_many) {
    const std::string mistakes = mistakes_of(changed("depth_m = 0.06", "count = 1000000"));
    EXPECT_THAT(mistakes, HasSubstr("poured grains fill"));
    EXPECT_THAT(mistakes, Not(HasSubstr("A pour has at most")));
}

TEST_F(RoomStudy, warns_of_a_thaw_where_nothing_is_frozen) {
    const auto warnings = [&](const std::string& steps) {
        const RoomRequest request =
            read_room_request(write(changed(k_end, steps + "[[event]]\ndo = \"thaw\"\nat_s = 2\nregion = { above_m = 0 }\n\n[run]\n")));
        return room_warnings(request.values, request.scene, request.pieces, request.mesh);
    };
    const auto freeze_at = [](const char* time) {
        return fmt::format("[[event]]\ndo = \"freeze\"\nat_s = {}\nregion = {{ above_m = 0 }}\n\n", time);
    };
    for (const std::string& steps : {std::string(), freeze_at("3")}) {
        const std::vector<Mistake> found = warnings(steps);
        ASSERT_EQ(found.size(), 1u) << steps;
        EXPECT_THAT(found[0].text(), ContainsRegex("room.toml:[0-9]+: do = \"thaw\" at 2 s. No step and no event freezes grains"));
    }
    EXPECT_TRUE(warnings(freeze_at("1")).empty());
    EXPECT_TRUE(warnings("[[prepare]]\ndo = \"freeze\"\nabove_m = 0\n\n").empty());
}

TEST_F(RoomStudy, grains_without_a_way_into_the_room_are_refused) {
    std::string text = room_template("heap");
    const std::size_t from = text.find("[[prepare]]"), to = text.find("[run]");
    text.erase(from, to - from);
    EXPECT_THAT(mistakes_of(text), HasSubstr("No grains come into the room"));
}

}  // namespace
}  // namespace cutterflow::cases
