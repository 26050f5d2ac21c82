/// Rock of a cutter's study that is clumps: from feed.class.shape to the case.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cases/runner/pipeline.hpp"
#include "cases/scenes/cutter/case_builder.hpp"
#include "cases/scenes/cutter/checked_study.hpp"
#include "cases/scenes/cutter/feed.hpp"
#include "cases/scenes/cutter/study_bank.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "cases/study/contact_rules.hpp"
#include "cases/study/study_shapes.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/sphere.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/head/crown_cutter.hpp"

using namespace cutterflow;
using namespace cutterflow::cases;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

namespace {

/// Two spheres of radius 1 whose centres are `apart` from each other.
std::string dumbbell(double apart) {
    return fmt::format(
        "sphericity = 0.8\n[[sphere]]\nx_m = 0.0\ny_m = 0.0\nz_m = 0.0\nradius_m = 1.0\n"
        "[[sphere]]\nx_m = {}\ny_m = 0.0\nz_m = 0.0\nradius_m = 1.0\n",
        apart);
}

/// Diameter of the sphere around a dumbbell over that of the sphere of its volume: the two share a lens of 2 pi/3 (1 - a/2)^2 (2 + a/2).
double girth_of_dumbbell(double apart) {
    const double volume = 2.0 * sphere_volume(2.0) - 2.0 * k_pi / 3.0 * std::pow(1.0 - 0.5 * apart, 2) * (2.0 + 0.5 * apart);
    return (2.0 + apart) / std::cbrt(6.0 * volume / k_pi);
}

const geometry::Head& crown() {
    static const geometry::Head head = geometry::understand_head(geometry::generate_crown_cutter(
        geometry::read_crown_parameters(std::string(CUTTERFLOW_SOURCE_DIR) + "/cases/examples/model_cutter/crown.toml")));
    return head;
}

class FeedShapes : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "cutterflow_shapes_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
        for (const char* below : {"river", "hill"}) fs::create_directories(folder_ / below);
        write_file(folder_ / "river/peanut.clump", dumbbell(1.0));
        write_file(folder_ / "hill/peanut.clump", dumbbell(1.9));
    }
    void TearDown() override { fs::remove_all(folder_); }

    static std::string text_of(const std::string& feed) {
        return "[cutter]\nfile = \"c.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n" + feed;
    }
    static std::string batch(const std::string& classes) { return text_of("[[feed]]\ncount = 60\n" + classes); }
    static std::string rock(double diameter, const std::string& shape) {
        return fmt::format("[[feed.class]]\ndiameter_m = {}\n{}", diameter, shape.empty() ? "" : "shape = \"" + shape + "\"\n");
    }
    ParameterValues resolved(const std::string& text) const {
        return resolve_study(parse_parameters(study_table(), text, "study.toml"), head_size(crown()));
    }
    Study study(const std::string& text) const { return make_study(resolved(text), folder_); }
    /// Backplate and pipe do not depend on the feed: they are made once.
    std::vector<PlacedFeed> placed(const Study& study) const {
        const geometry::Contour contour = head_contour(crown(), study.suction.gap);
        static const FeedScene of_water = feed_scene(this->study(text_of("")), head_size(crown()), contour, crown().surface);
        FeedScene scene = of_water;
        if (study.is_fed_by_cutting()) scene.cut_face = bank_of(study, contour).cut_face(0.01);
        return place_feeds(study, scene);
    }

    fs::path folder_;
};

TEST_F(FeedShapes, are_read_from_beside_the_study_and_named_apart) {
    write_file(folder_ / "3 mm-chip.clump", dumbbell(0.5));
    const Study made = study(batch(rock(0.02, "river/peanut.clump") + rock(0.03, "hill/peanut.clump") + rock(0.01, "") +
                                   rock(0.01, "river/peanut.clump") + rock(0.01, "3 mm-chip.clump")));
    const std::vector<FeedClass>& classes = made.feeds.at(0).classes;
    EXPECT_EQ(classes.at(0).shape->name, "peanut");
    EXPECT_EQ(classes.at(1).shape->name, "peanut_2");
    EXPECT_FALSE(classes.at(2).shape);
    EXPECT_EQ(classes.at(3).shape->name, "peanut");
    EXPECT_EQ(classes.at(4).shape->name, "shape_3_mm_chip") << "a word of a dictionary";
    EXPECT_NEAR(classes.at(0).extent(), 0.02 * girth_of_dumbbell(1.0), 1e-8);
    EXPECT_NEAR(classes.at(1).extent(), 0.03 * girth_of_dumbbell(1.9), 1e-8);
    EXPECT_EQ(classes.at(2).extent(), 0.01);
    EXPECT_EQ(made.shapes().size(), 3u);
}

TEST_F(FeedShapes, that_are_no_clumps_are_told_with_all_other_mistakes) {
    write_file(folder_ / "rock.stl", "solid rock\nendsolid\n");
    write_file(folder_ / "loose.clump", dumbbell(2.5));
    write_file(folder_ / "study.toml", batch(rock(0.02, "gone.clump") + rock(0.02, "rock.stl") + rock(0.02, "loose.clump") +
                                             "[[feed]]\n[[feed.class]]\ndiameter_m = 0.02\n"));
    try {
        require_study_file(folder_ / "study.toml");
        FAIL() << "accepted";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("study.toml:11"), HasSubstr("feed.class.shape = \"gone.clump\""),
                                        HasSubstr("There is no file " + (folder_ / "gone.clump").string()), HasSubstr("rock.stl"),
                                        HasSubstr("sphere 2 is not joined to sphere 1"), HasSubstr("neither count nor mass_kg")));
    }
}

TEST_F(FeedShapes, warn_of_the_passage_by_their_length) {
    const auto warnings = [&](double diameter, const std::string& shape) {
        const ParameterValues values = resolved(batch(rock(diameter, shape)));
        std::string all;
        for (const Mistake& warning : study_warnings(values, make_study(values, folder_), head_size(crown()))) all += warning.text() + "\n";
        return all;
    };
    const HeadSize size = head_size(crown());
    const double passage = std::min(0.5 * size.ring_radius, size.passage.value_or(1.0)), girth = girth_of_dumbbell(1.9);
    const double fits = 0.99 * passage / 3.0;
    EXPECT_THAT(warnings(fits, ""), Not(HasSubstr("third of the smallest passage")));
    EXPECT_THAT(warnings(fits / girth, "hill/peanut.clump"), Not(HasSubstr("third of the smallest passage")));
    EXPECT_THAT(warnings(fits, "hill/peanut.clump"),
                AllOf(HasSubstr("third of the smallest passage"), HasSubstr(fmt::format("this rock is {:.4g} m long", fits * girth))));
}

TEST_F(FeedShapes, of_a_batch_have_room_for_any_orientation) {
    const Study made = study(batch("spacing_diameters = 1.02\n" + rock(0.02, "hill/peanut.clump") + rock(0.025, "")));
    const std::vector<PlacedFeed> feeds = placed(made);
    const double extent = 0.02 * girth_of_dumbbell(1.9);
    ASSERT_GT(extent, 0.025);
    const geometry::TriangleSurface turned = geometry::transformed(
        crown().surface, Eigen::Affine3d(Eigen::AngleAxisd(made.rotation_speed * made.feeds[0].start, Vec3::UnitZ())));
    const geometry::SolidSearch cutter(turned);
    ASSERT_EQ(feeds.at(0).rocks.size(), 60u);
    for (std::size_t i = 0; i < 60; ++i) {
        const Vec3& place = feeds[0].rocks[i].places.front().position;
        EXPECT_GE(cutter.nearest(place).distance, 0.5 * extent);
        for (std::size_t j = 0; j < i; ++j) EXPECT_GT((place - feeds[0].rocks[j].places.front().position).norm(), extent);
    }
    const std::string csv = rock_feed_csv(feeds);
    EXPECT_THAT(csv, HasSubstr("id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3,shape\n"));
    const auto lines_with = [&](const std::string& part) {
        std::size_t count = 0;
        for (std::size_t at = csv.find(part); at != std::string::npos; at = csv.find(part, at + 1)) ++count;
        return count;
    };
    const nlohmann::json classes = nlohmann::json::parse(feed_json(feeds, made)).at("feeds")[0].at("classes");
    EXPECT_EQ(lines_with(",0.02,2650,peanut\n"), classes[0].at("count").get<std::size_t>());
    EXPECT_EQ(lines_with(",0.025,2650,\n"), classes[1].at("count").get<std::size_t>());
    EXPECT_EQ(classes[0].at("shape"), "peanut.clump");
    EXPECT_FALSE(classes[1].contains("shape"));
}

TEST_F(FeedShapes, settle_with_their_own_sphericity) {
    const Study made =
        study(batch(rock(0.02, "river/peanut.clump") + rock(0.02, "")) + "[closures]\ndrag = \"haider_levenspiel\"\nsphericity = 0.95\n");
    Study as_spheres = made;
    as_spheres.closures.sphericity = 0.8;
    const FeedClass &clump = made.feeds[0].classes[0], &sphere = made.feeds[0].classes[1];
    EXPECT_EQ(settling_speed(made, clump), settling_speed(as_spheres, sphere));
    EXPECT_LT(settling_speed(made, clump), 0.95 * settling_speed(made, sphere));
}

TEST_F(FeedShapes, from_a_cut_face_start_clear_of_steel_and_weigh_as_spheres) {
    const std::string keys = "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n[run]\nflow_revolutions = 1\nmax_revolutions = 2\n";
    const Study made = study(text_of(keys + "[[feed]]\nkind = \"cut_face\"\n" + rock(0.02, "hill/peanut.clump")));
    const Study spheres = study(text_of(keys + "[[feed]]\nkind = \"cut_face\"\n" + rock(0.02, "")));
    const std::vector<PlacedFeed> feeds = placed(made);
    const double extent = 0.02 * girth_of_dumbbell(1.9);
    const geometry::SolidSearch cutter(crown().surface);
    ASSERT_GT(feeds.at(0).rocks.size(), 100u);
    EXPECT_NEAR(static_cast<double>(feeds[0].rocks.size()), static_cast<double>(placed(spheres)[0].rocks.size()), 1.0);
    for (const PlacedRock& rock : feeds[0].rocks)
        for (const coupling::FeedPlace& place : rock.places)
            EXPECT_GE(cutter.nearest(rotate_about({}, -made.rotation_speed * rock.time, place.position)).distance, 0.5 * extent);
    EXPECT_THAT(rock_feed_csv(feeds), AllOf(HasSubstr(",place,shape\n"), HasSubstr(",0,peanut\n"), HasSubstr(",1,peanut\n")));
}

TEST_F(FeedShapes, go_into_the_case_with_their_files) {
    const Study made = study(batch(rock(0.02, "river/peanut.clump") + rock(0.01, "hill/peanut.clump")));
    const CaseInputs inputs = case_inputs_of(made, head_size(crown()), head_contour(crown(), made.suction.gap), 1);
    EXPECT_TRUE(check_case_inputs(inputs).empty());
    EXPECT_THAT(coupling_dictionary(inputs).text(), AllOf(HasSubstr("\"constant/shapes/peanut.clump\""), HasSubstr("peanut_2")));
    write_replay_case(folder_ / "case", inputs);
    EXPECT_EQ(read_file(folder_ / "case/constant/shapes/peanut.clump"), dumbbell(1.0));
    EXPECT_EQ(read_file(folder_ / "case/constant/shapes/peanut_2.clump"), dumbbell(1.9));
}

TEST_F(FeedShapes, are_inputs_by_their_content) {
    const ParameterValues values = resolved(batch(rock(0.02, "") + rock(0.02, "river/peanut.clump")));
    const auto input = [&] { return stage_inputs(values, folder_, k_case_stage).at("feed[1].class[2].shape"); };
    EXPECT_EQ(input(), sha256(dumbbell(1.0)));
    write_file(folder_ / "river/peanut.clump", dumbbell(1.1));
    EXPECT_EQ(input(), sha256(dumbbell(1.1)));
}

TEST_F(FeedShapes, of_the_example_are_three_and_find_places) {
    const fs::path file = fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples/shapes/study.toml";
    const ParameterValues values = resolve_study(read_study(file), head_size(crown()));
    EXPECT_TRUE(check_study(values, head_size(crown())).empty());
    const Study made = make_study(values, file.parent_path());
    std::vector<std::string> names;
    for (const ShapeFile& shape : made.shapes()) {
        names.push_back(shape.name);
        EXPECT_TRUE(shape.clump.sphericity.has_value());
    }
    EXPECT_THAT(names, ::testing::ElementsAre("block", "pebble", "slab"));
    EXPECT_EQ(placed(made).at(0).rocks.size(), 120u);
}

// A push at the arm s meets M/(1 + M s^2/I): small spheres far out are met sooner than the sphere of the clump's volume.
TEST_F(FeedShapes, have_the_contact_step_of_their_smallest_and_outermost_sphere) {
    coupling::ContactSettings contact;
    contact.youngs_modulus = 1e8;
    contact.max_speed = 3.0;
    const geometry::UnitClump one{
        std::vector<geometry::Ball>{{Vec3::Zero(), 0.5}}, Vec3::Constant(k_pi / 60.0), Eigen::Matrix3d::Identity(), {}};
    EXPECT_NEAR(contact_step(contact, one, 0.02, 2650.0), contact_step(contact, 0.02, 2650.0), 1e-12);
    geometry::UnitClump two = one;
    two.balls.push_back({Vec3(0.4, 0.0, 0.0), 0.2});
    const double mass = sphere_mass(0.02, 2650.0) / (1.0 + k_pi / 6.0 * 0.16 / (k_pi / 60.0));
    EXPECT_NEAR(contact_step(contact, two, 0.02, 2650.0), contact_step(contact, 0.008, mass / sphere_volume(0.008)), 1e-12);
    EXPECT_LT(contact_step(contact, two, 0.02, 2650.0), contact_step(contact, 0.02, 2650.0));
}

}  // namespace
