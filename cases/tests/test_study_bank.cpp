/// The bank of a study: its keys, its rules beside a head, what a swing cuts.
#include "cases/scenes/cutter/study_bank.hpp"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cases/scenes/cutter/case_builder.hpp"
#include "cases/scenes/cutter/feed.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/head/crown_cutter.hpp"
#include "geometry/io/write_stl.hpp"
#include "geometry/surface/simple_solids.hpp"
#include "geometry/surface/soundness.hpp"

namespace cutterflow::cases {
namespace {

const geometry::Head& model_head() {
    static const geometry::Head head = geometry::understand_head(geometry::generate_crown_cutter(
        geometry::read_crown_parameters(std::string(CUTTERFLOW_SOURCE_DIR) + "/cases/examples/model_cutter/crown.toml")));
    return head;
}

ParameterValues values_of(const std::string& more) {
    return parse_parameters(study_table(), "[cutter]\nfile = \"c.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n" + more,
                            "study.toml");
}

ParameterValues resolved_of(const std::string& more) {
    return resolve_study(values_of(more), head_size(model_head()));
}

Study study_of(const std::string& more) {
    return make_study(resolved_of(more), "/tmp");
}

geometry::Contour contour_of(const Study& study) {
    return head_contour(model_head(), study.suction.gap);
}

std::vector<std::string> texts(const std::vector<Mistake>& mistakes) {
    std::vector<std::string> all;
    for (const Mistake& mistake : mistakes) all.push_back(mistake.text());
    return all;
}

bool has(const std::vector<std::string>& all, const std::string& part) {
    return std::any_of(all.begin(), all.end(), [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

std::vector<std::string> mistakes_of(const std::string& more) {
    const ParameterValues resolved = resolved_of(more);
    return texts(bank_mistakes(resolved, make_study(resolved, "/tmp"), head_size(model_head()), model_head().contour));
}

TEST(StudyBank, is_none_by_default_and_follows_the_ring_otherwise) {
    EXPECT_FALSE(study_of("").bank);
    const Study study = study_of("[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n");
    ASSERT_TRUE(study.bank);
    EXPECT_NEAR(study.bank->swing_speed, 0.1, 1e-15);
    EXPECT_NEAR(study.bank->cut_height, 0.32, 1e-12);
    EXPECT_NEAR(study.bank->step, 0.16, 1e-12);
    EXPECT_NEAR(study.bank->clearance, 0.008, 1e-12);
    EXPECT_NEAR(study.bank->pick_length, 0.04, 1e-12);  // the model cutter has none of its own
    EXPECT_EQ(study.bank->grain_density, 2650.0);
    EXPECT_EQ(study.bank->porosity, 0.15);
}

TEST(StudyBank, of_a_head_with_picks_adds_none) {
    HeadSize size = head_size(model_head());
    size.tip_radius = 1.05 * size.ring_radius;
    const ParameterValues values = values_of("[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n");
    EXPECT_EQ(resolve_study(values, size).number("bank.pick_length_m"), 0.0);
}

// 1 m3/s of soil with a third of pores and grains of 3000 kg/m3 is 2 t/s; Froude: lengths 4, speeds 2, areas 16, flows 32.
TEST(StudyBank, figures_are_those_of_the_swing_and_scale_by_froude) {
    const std::string keys = "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n[soil]\ngrain_density_kg_m3 = 3000\nporosity = 0.25\n";
    const Study study = study_of(keys + "[scale]\nlength_ratio = 4\n");
    const CutFigures figures = cut_figures(study, contour_of(study));
    EXPECT_NEAR(figures.section, 0.16 * 0.32, 0.02 * 0.16 * 0.32);
    EXPECT_NEAR(figures.in_situ, 0.1 * figures.section, 1e-15);
    EXPECT_NEAR(figures.dry, 2250.0 * figures.in_situ, 1e-12);
    const CutFigures prototype = scaled(figures, 4.0);
    EXPECT_NEAR(prototype.section, 16.0 * figures.section, 1e-12);
    EXPECT_NEAR(prototype.swing_speed, 0.2, 1e-15);
    EXPECT_NEAR(prototype.in_situ, prototype.section * prototype.swing_speed, 1e-12);
    EXPECT_NEAR(bank_json(study, contour_of(study)).at("prototype").at("dry_kg_s").get<double>(), 32.0 * figures.dry, 1e-9);
    EXPECT_NE(bank_text(study, contour_of(study)).find("prototype"), std::string::npos);
    EXPECT_EQ(bank_text(study_of(""), contour_of(study)), "");
    EXPECT_NE(bank_text(study, contour_of(study)).find(fmt::format("{:.2g} m of soil in a revolution", 0.1 * study.period())),
              std::string::npos);
}

TEST(StudyBank, warns_of_a_swing_that_no_blade_and_no_pump_keeps_up_with) {
    const auto warnings = [](double speed_m_min) {
        const ParameterValues resolved = resolved_of(fmt::format("[swing]\nspeed_m_min = {}\n[bank]\nmodel = \"wall\"\n", speed_m_min));
        const Study study = make_study(resolved, "/tmp");
        return texts(swing_warnings(resolved, study, head_size(model_head()), contour_of(study)));
    };
    const Study study = study_of("");
    const double tip_m_min = 60.0 * study.rotation_speed * head_size(model_head()).tip_radius;
    EXPECT_TRUE(has(warnings(1.01 * tip_m_min), "The head swings faster than its blades' tips"));
    // 0.85 of a section of 0.051 m2 through 0.12 m3/s: 30 % at 50 m/min.
    EXPECT_TRUE(warnings(45.0).empty());
    const std::vector<std::string> fast = warnings(55.0);
    ASSERT_EQ(fast.size(), 1u);
    EXPECT_TRUE(has(fast, "of suction.discharge_m3_s by volume"));
}

// The model cutter, ring radius 0.4 m, tips at 0.43 m, at 1:4: 60 rpm, 6 m/min and a mouth of 0.1 m radius are 30 rpm, 12 m/min and 6.4
// m/s.
TEST(StudyBank, warns_in_one_line_of_all_that_lies_outside_of_usual_practice) {
    const auto warnings = [](double ratio, const std::string& bank) {
        ParameterValues values = values_of("[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n" + bank);
        values.set("scale.length_ratio", ratio);
        values.set("suction.discharge_m3_s", 0.1);
        values.set("suction.mouth_radius_m", 0.1);
        values.set("rotor.speed_rpm", 60.0);
        const Study study = make_study(resolve_study(values, head_size(model_head())), "/tmp");
        return texts(practice_warnings(study, head_size(model_head())));
    };
    EXPECT_TRUE(warnings(4.0, "cut_height_m = 0.45\nstep_m = 0.4\n").empty());
    const std::vector<std::string> odd = warnings(4.0, "cut_height_m = 0.3\nstep_m = 0.6\n");
    ASSERT_EQ(odd.size(), 1u);
    EXPECT_TRUE(has(odd, "step 2.4 m (0.5 to 2), cut height 0.375 ring diameters (0.5 to 1.2)"));
    const std::vector<std::string> unscaled = warnings(1.0, "cut_height_m = 0.45\nstep_m = 0.4\n");
    ASSERT_EQ(unscaled.size(), 1u);
    for (const char* part : {"ring diameter 0.8 m", "rotor speed 60 rpm", "swing speed 6 m/min", "Check scale.length_ratio"})
        EXPECT_TRUE(has(unscaled, part)) << unscaled[0];
    const Study without = study_of("");
    EXPECT_TRUE(practice_warnings(without, head_size(model_head())).empty()) << "no head at work";
}

TEST(StudyBank, stands_on_the_side_where_rock_is_fed) {
    for (const char* swing : {"over_cut", "under_cut"})
        for (const char* rotor : {"right_handed", "left_handed"}) {
            const std::string directions = std::string("direction = \"") + swing + "\"\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n";
            ParameterValues values = values_of("[swing]\n" + directions);
            values.set("rotor.direction", std::string(rotor));
            const Study study = make_study(resolve_study(values, head_size(model_head())), "/tmp");
            EXPECT_EQ(study.bank_side() > 0.0, bank_azimuth_deg(swing, rotor) > 0.0) << swing << " " << rotor;
        }
}

// A short step from a low bank is cut by the nose, from where rock has the longest way to the mouth.
TEST(StudyBank, tells_how_far_below_the_ring_it_is_cut) {
    const std::string swing = "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n";
    const Study nose = study_of(swing), deep = study_of(swing + "cut_height_m = 0.45\nstep_m = 0.4\n");
    const double of_nose = cut_figures(nose, contour_of(nose)).depth, of_deep = cut_figures(deep, contour_of(deep)).depth;
    EXPECT_LT(of_nose, 0.485);
    EXPECT_LT(of_deep, of_nose - 0.05);
    EXPECT_GT(of_deep, 0.1);
    EXPECT_NE(bank_text(nose, contour_of(nose)).find(fmt::format("{:.2g} m below the ring in the mean", of_nose)), std::string::npos);
    EXPECT_NEAR(bank_json(nose, contour_of(nose)).at("model").at("mean_depth_m").get<double>(), of_nose, 1e-12);
}

TEST(StudyBank, can_stand_beside_the_model_cutter_and_is_a_solid) {
    const std::string keys = "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n";
    EXPECT_TRUE(mistakes_of(keys).empty());
    const Study study = study_of(keys);
    const geometry::TriangleSurface soil = bank_surface(study, head_size(model_head()), contour_of(study));
    EXPECT_TRUE(geometry::inspect_surface(soil).sound());
    const geometry::SolidSearch search(soil);
    for (const Vec3& point : model_head().surface.points) EXPECT_FALSE(search.contains(point));
}

TEST(StudyBank, is_refused_with_all_its_mistakes) {
    const std::string keys = "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n";
    const auto high = mistakes_of(keys + "cut_height_m = 6.0\nstep_m = 2.0\nclearance_m = 0.0\npick_length_m = 0.0\n");
    EXPECT_TRUE(has(high, "study.toml:11: bank.cut_height_m = 6. The head with picks and clearance is")) << high.front();
    EXPECT_TRUE(has(high, "above the water"));
    EXPECT_TRUE(has(high, "bank.step_m = 2. The head with picks and clearance is"));
    EXPECT_TRUE(has(high, "bank.clearance_m = 0. The bank would touch the head"));
    EXPECT_EQ(high.size(), 4u);
    const auto overhanging = mistakes_of(keys + "cut_height_m = 0.7\nstep_m = 0.3\n");
    ASSERT_EQ(overhanging.size(), 1u);
    EXPECT_TRUE(has(overhanging, "soil would overhang"));
}

TEST(StudyBank, and_its_keys_need_each_other) {
    const auto broken = [](const std::string& more) { return texts(check_file_rules(values_of(more), "study.toml")); };
    EXPECT_TRUE(has(broken("[bank]\nmodel = \"wall\"\n"), "swing.speed_m_min is missing"));
    const auto without = broken("[swing]\nspeed_m_min = 6\n[bank]\nstep_m = 0.1\n[soil]\nporosity = 0.3\n");
    EXPECT_EQ(without.size(), 3u);
    EXPECT_TRUE(has(without, "bank.step_m = 0.1. It belongs to a bank"));
    EXPECT_TRUE(has(broken("[bed]\nspill_layer_m = 0.1\n"), "bed.spill_layer_m = 0.1. It belongs to a bank"));
    EXPECT_TRUE(has(broken("[bank]\npermeability_m2 = 1e-9\n"), "bank.permeability_m2 = 1e-09. It belongs to a bank"));
    const std::string batch =
        "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n[[feed]]\ncount = 3\n[[feed.class]]\ndiameter_m = 0.02\n";
    EXPECT_TRUE(has(broken(batch + "[bed]\nspill_layer_m = 0.1\n"), "beside rock from a cut face, and no feed is of one"));
    EXPECT_TRUE(broken(batch + "[bed]\nspill_layer_m = 0\n").empty());
    EXPECT_TRUE(has(mistakes_of(std::string("[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n[bed]\nspill_layer_m = 1\n")),
                    "as high as the bank"));
    EXPECT_TRUE(broken("").empty());
    EXPECT_THROW(values_of("[soil]\nporosity = 0.95\n"), UserError);
    EXPECT_THROW(values_of("[swing]\nspeed_m_min = -1\n"), UserError);
}

constexpr const char* k_bank = "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n";
constexpr const char* k_rock = "[[feed]]\ncount = 5\n[[feed.class]]\ndiameter_m = 0.02\ndensity_kg_m3 = 2650\n";

TEST(StudyBank, is_felt_by_water_and_by_rock) {
    const geometry::Head& head = model_head();
    const auto inputs_of = [&](const std::string& more) {
        const Study study = make_study(resolved_of(more), "/tmp");
        return case_inputs_of(study, head_size(head), head_contour(head, study.suction.gap), 1);
    };
    EXPECT_FALSE(solver_settings(inputs_of("")).soil);
    EXPECT_FALSE(solver_settings(inputs_of(k_rock)).soil);
    EXPECT_EQ(dem_settings(inputs_of(k_rock)).walls.size(), 3u);
    EXPECT_TRUE(solver_settings(inputs_of(k_bank)).soil);
    EXPECT_EQ(solver_settings(inputs_of(k_bank)).soil->permeability, 0.0);
    EXPECT_EQ(solver_settings(inputs_of(std::string(k_bank) + "permeability_m2 = 1e-8\n")).soil->permeability, 1e-8);
    const CaseInputs both = inputs_of(std::string(k_bank) + k_rock + "[rock]\nfriction_soil = 0.7\n");
    EXPECT_TRUE(solver_settings(both).soil);
    const coupling::DemSettings dem = dem_settings(both);
    ASSERT_EQ(dem.walls.size(), 5u);
    EXPECT_EQ(dem.walls[0].material, coupling::k_steel);
    EXPECT_TRUE(dem.walls[3].rotating) << "picks";
    EXPECT_EQ(dem.walls[4].material, coupling::k_soil);
    EXPECT_FALSE(dem.walls[4].rotating);
    EXPECT_EQ(dem.contact.rock_soil.friction, 0.7);
    EXPECT_EQ(dem.contact.rock_soil.rolling_friction, 0.15);
}

TEST(StudyBank, moves_past_a_head_that_travels) {
    const geometry::Head& head = model_head();
    const auto inputs_of = [&](const std::string& more) {
        const Study study = make_study(resolved_of(more), "/tmp");
        return case_inputs_of(study, head_size(head), head_contour(head, study.suction.gap), 1);
    };
    const std::string keys = std::string(k_bank) + k_rock;
    const CaseInputs still = inputs_of(keys);
    EXPECT_EQ(still.hauling, Vec3(0, 0, 0));
    EXPECT_EQ(coupling_dictionary(still).text().find("elocity (0 "), std::string::npos);
    // Over-cut of a right-handed rotor: the bank stands at -y, so that ground and water come from there.
    const CaseInputs over = inputs_of(keys + "[hauling]\nwater = true\n");
    EXPECT_NEAR(over.hauling.y(), 0.1, 1e-12);
    EXPECT_EQ(solver_settings(over).soil->velocity, over.hauling);
    EXPECT_EQ(dem_settings(over).walls.back().surface_velocity, over.hauling);
    EXPECT_EQ(dem_settings(over).walls.front().surface_velocity, Vec3(0, 0, 0)) << "steel travels with the frame";
    const std::string text = coupling_dictionary(over).text();
    EXPECT_NE(text.find("surfaceVelocity (0 0.1 0);"), std::string::npos) << text;
    EXPECT_TRUE(has(texts(check_file_rules(values_of("[hauling]\nwater = true\n"), "study.toml")), "hauling.water = true. A head travels"));
}

// Half a millimetre at 0.4 m is what rock may feel wrong.
TEST(StudyBank, has_a_surface_for_rock_on_its_soil) {
    const Study study = study_of(k_bank);
    const HeadSize size = head_size(model_head());
    const geometry::TriangleSurface soil = bank_surface(study, size, contour_of(study));
    const MadeWall wall = bank_contact_wall(study, size, contour_of(study), soil);
    EXPECT_EQ(wall.file, bank_wall().file);
    EXPECT_GT(wall.report.smallest_angle, 4.9 * k_pi / 180.0);
    EXPECT_LT(wall.report.deviation, 5e-4);
    EXPECT_LT(wall.report.triangles, 20000u);
    geometry::TriangleSurface piece = soil;  // what a bank with a hole would be held against
    piece.triangles.resize(soil.triangles.size() / 50);
    EXPECT_THROW(bank_contact_wall(study, size, contour_of(study), piece), CheckFailure);
}

// Rock that a blade pushes does not slip away between its edge and the soil, where picks are.
TEST(StudyBank, has_picks_for_rock_where_the_head_has_none) {
    const Study study = study_of(k_bank);
    const geometry::Contour contour = contour_of(study);
    const MadeWall picks = pick_contact_wall(study, contour, model_head().surface);
    ASSERT_GT(picks.report.triangles, 100u);
    EXPECT_GT(picks.report.smallest_angle, 5.0 * k_pi / 180.0);
    const geometry::SolidSearch soil(bank_surface(study, head_size(model_head()), contour));
    double nearest = 1.0;
    for (const Vec3& point : picks.surface.points) nearest = std::min(nearest, soil.contains(point) ? 0.0 : soil.nearest(point).distance);
    EXPECT_GT(nearest, 0.5 * study.bank->clearance) << "picks clear the soil at any rotor angle";
    const auto walls_of = [&](const std::string& more) {
        const Study made = make_study(resolved_of(std::string(k_bank) + more + k_rock), "/tmp");
        std::vector<std::string> names;
        for (const coupling::WallSettings& wall : dem_settings(case_inputs_of(made, head_size(model_head()), contour, 1)).walls)
            names.push_back(wall.name);
        return names;
    };
    EXPECT_EQ(walls_of(""), (std::vector<std::string>{"cutter", "backplate", "suction_pipe", "picks", "bank"}));
    EXPECT_EQ(walls_of("pick_length_m = 0.0\n"), (std::vector<std::string>{"cutter", "backplate", "suction_pipe", "bank"}));
}

geometry::TriangleSurface box_between(const Vec3& lower, const Vec3& upper) {
    geometry::TriangleSurface box = geometry::generate_box(upper - lower, 1.0);
    const Vec3 shift(0.5 * (lower.x() + upper.x()), 0.5 * (lower.y() + upper.y()), lower.z());
    for (Vec3& point : box.points) point += shift;
    return box;
}

/// Soil of a file: a box beside, in or above the head, or with a hole.
class SoilOfAFile : public ::testing::Test {
protected:
    SoilOfAFile() : file_(std::filesystem::path(::testing::TempDir()) / "soil_of_a_file.stl") {}
    ~SoilOfAFile() override { std::filesystem::remove(file_); }

    /// \return a study's keys with this soil
    std::string with(const geometry::TriangleSurface& soil) const {
        geometry::write_stl(soil, file_);
        return std::string(k_bank) + "file = \"" + file_.string() + "\"\n";
    }

    std::filesystem::path file_;
};

TEST_F(SoilOfAFile, stands_beyond_the_picks) {
    const std::string keys = with(box_between(Vec3(0.0, 0.41, -0.5), Vec3(0.8, 1.1, -0.02)));
    EXPECT_TRUE(has(mistakes_of(keys), "whose picks stand out by 0.04 m"));
    EXPECT_FALSE(has(mistakes_of(keys + "pick_length_m = 0.0\n"), "picks"));
}

TEST_F(SoilOfAFile, stands_in_the_place_of_the_computed_one) {
    const geometry::TriangleSurface box = box_between(Vec3(0.1, 0.6, -0.5), Vec3(0.8, 1.1, -0.05));
    const std::string keys = with(box);
    EXPECT_TRUE(mistakes_of(keys).empty()) << mistakes_of(keys).front();
    const Study study = study_of(keys);
    const HeadSize size = head_size(model_head());
    const geometry::TriangleSurface soil = bank_surface(study, size, contour_of(study));
    EXPECT_NEAR(geometry::inspect_surface(soil).volume, 0.7 * 0.5 * 0.45, 1e-7);  // STL has single precision
    const MadeWall wall = bank_contact_wall(study, size, contour_of(study), soil);
    EXPECT_EQ(wall.report.wall, "bank");
    EXPECT_LE(wall.report.deviation, wall.report.allowed_deviation);
    EXPECT_NEAR(geometry::inspect_surface(wall.surface).volume, 0.7 * 0.5 * 0.45, 1e-4);
    EXPECT_DOUBLE_EQ(cut_figures(study, contour_of(study)).section, cut_figures(study_of(k_bank), contour_of(study)).section);
    EXPECT_NE(bank_text(study, contour_of(study)).find("soil_of_a_file.stl"), std::string::npos);
}

TEST_F(SoilOfAFile, must_be_closed_beside_the_head_and_below_the_water) {
    geometry::TriangleSurface open = box_between(Vec3(0.1, 0.6, -0.5), Vec3(0.8, 1.1, -0.05));
    open.triangles.pop_back();
    EXPECT_TRUE(has(mistakes_of(with(open)), "open")) << mistakes_of(with(open)).front();
    const auto both = mistakes_of(with(open) + "cut_height_m = 6.0\n");
    EXPECT_TRUE(has(both, "open")) << "the file is read although keys of the cut are wrong";
    EXPECT_TRUE(has(both, "bank.cut_height_m = 6"));
    EXPECT_TRUE(has(mistakes_of(with(box_between(Vec3(0.1, 0.0, -0.3), Vec3(0.8, 1.1, -0.05)))), "The soil cuts the head"));
    const double inside = 0.01;  // a box within the head, which touches no wall of it
    EXPECT_TRUE(has(mistakes_of(with(box_between(Vec3(0, 0, -0.1), Vec3(inside, inside, -0.1 + inside)))), "The soil cuts the head"));
    EXPECT_TRUE(has(mistakes_of(with(box_between(Vec3(-9.0, 0.6, -0.5), Vec3(0.8, 1.1, -0.05)))), "m above the water"));
    EXPECT_TRUE(has(texts(check_file_rules(values_of("[bank]\nfile = \"soil.stl\"\n"), "study.toml")), "It belongs to a bank"));
}

// Rock is fed within the head's contour, from which soil keeps its distance.
TEST(StudyBank, has_no_fed_rock_in_its_soil) {
    const std::string keys = std::string(k_bank) + "[run]\nflow_revolutions = 1\nmax_revolutions = 2\n[[feed]]\n";
    const Study without = study_of(k_bank);
    const HeadSize size = head_size(model_head());
    const geometry::SolidSearch soil(bank_surface(without, size, contour_of(without)));
    for (const char* feed : {"count = 200\n[[feed.class]]\ndiameter_m = 0.02\ndensity_kg_m3 = 2650\n",
                             "kind = \"cut_face\"\n[[feed.class]]\ndiameter_m = 0.02\n"}) {
        const Study study = study_of(keys + feed);
        const auto feeds = place_feeds(study, feed_scene(study, size, contour_of(study), model_head().surface));
        ASSERT_EQ(feeds.size(), 1u);
        ASSERT_GT(feeds.front().rocks.size(), 20u);
        for (const PlacedRock& rock : feeds.front().rocks)
            for (const coupling::FeedPlace& place : rock.places) {
                EXPECT_FALSE(soil.contains(place.position));
                EXPECT_GT(soil.nearest(place.position).distance, 0.01);
            }
    }
}

}  // namespace
}  // namespace cutterflow::cases
