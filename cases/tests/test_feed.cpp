#include "cases/scenes/cutter/feed.hpp"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cases/scenes/cutter/study_case.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/surface/revolve.hpp"

using namespace cutterflow;
using namespace cutterflow::cases;

namespace {

const HeadSize k_head{0.40, 0.40, 0.485};

Study study_of(const std::string& feed) {
    const std::string text = "[cutter]\nfile = \"c.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n" + feed;
    return make_study(resolve_study(parse_parameters(study_table(), text, "study.toml"), k_head), "/");
}

/// A bar across the head along x, 60 mm thick: what stands in for the cutter.
geometry::TriangleSurface bar() {
    geometry::TriangleSurface box;
    for (int i = 0; i < 8; ++i) box.points.emplace_back((i & 1) ? 0.38 : -0.38, (i & 2) ? 0.03 : -0.03, (i & 4) ? -0.01 : -0.40);
    box.triangles = {{0, 3, 1}, {0, 2, 3}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                     {2, 7, 3}, {2, 6, 7}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    if (geometry::volume_of(box) < 0.0)
        for (geometry::Triangle& triangle : box.triangles) std::swap(triangle[0], triangle[1]);
    return box;
}

geometry::Contour cylinder() {
    return {{-0.485, 0.0}, {0.40, 0.40}, 0.40, 0.03};
}

/// The backplate and pipe do not depend on the feed: they are made once.
const FeedScene& scene() {
    static const FeedScene made = feed_scene(study_of(""), k_head, cylinder(), bar());
    return made;
}

}  // namespace

TEST(RockFeed, classes_share_the_mass_and_keep_the_count) {
    FeedRequest request;
    request.classes = {{0.02, 2650.0, 1.0}, {0.01, 2650.0, 1.0}};  // one large rock weighs as much as eight small ones
    request.count = 90;
    EXPECT_EQ(rocks_per_class(request), (std::vector<std::size_t>{10, 80}));
    request.count = 100;
    const std::vector<std::size_t> hundred = rocks_per_class(request);
    EXPECT_EQ(hundred[0] + hundred[1], 100u);
    EXPECT_EQ(hundred[0], 11u);
    request.count.reset();
    request.mass = 4.08;
    request.classes = {{0.02, 2650.0, 3.0}};
    EXPECT_EQ(rocks_per_class(request), std::vector<std::size_t>{368});  // the reference experiment's batch
}

TEST(RockFeed, rocks_touch_neither_steel_nor_each_other_when_the_cutter_has_turned) {
    const Study study = study_of("[[feed]]\ncount = 368\nstart_revolution = 1.125\n[[feed.class]]\ndiameter_m = 0.02\n");
    const std::vector<PlacedFeed> feeds = place_feeds(study, scene());
    ASSERT_EQ(feeds.size(), 1u);
    EXPECT_EQ(feeds[0].requested, 368u);
    ASSERT_EQ(feeds[0].rocks.size(), 368u);
    const RotationAxis axis;
    for (std::size_t i = 0; i < feeds[0].rocks.size(); ++i) {
        const Vec3& place = feeds[0].rocks[i].places.front().position;
        EXPECT_EQ(feeds[0].rocks[i].time, study.feeds[0].start);
        const Vec3 in_rotor = rotate_about(axis, -study.rotation_speed * study.feeds[0].start, place);
        const double gap =
            std::max({std::abs(in_rotor.x()) - 0.38, std::abs(in_rotor.y()) - 0.03, in_rotor.z() + 0.01, -0.40 - in_rotor.z()});
        EXPECT_GE(gap, 0.0099) << "rock " << i << " overlaps the turned bar";
        const Cylindrical at = to_cylindrical(axis, Vec3::UnitX(), place);
        EXPECT_LE(at.radius, 0.39 + 1e-9);
        const double from_centre = std::remainder(at.azimuth - study.feeds[0].azimuth_centre, 2.0 * k_pi);
        EXPECT_LE(std::abs(from_centre), 0.5 * study.feeds[0].azimuth_width + 1e-9);
        for (std::size_t j = 0; j < i; ++j) EXPECT_GE((place - feeds[0].rocks[j].places.front().position).norm(), 0.03 - 1e-9);
    }
}

TEST(RockFeed, a_seed_repeats_and_another_varies_the_placement) {
    const auto positions = [](const char* seed) {
        const Study study = study_of(std::string("[[feed]]\ncount = 50\nseed = ") + seed + "\n[[feed.class]]\ndiameter_m = 0.02\n");
        return place_feeds(study, scene())[0].rocks.front().places.front().position;
    };
    EXPECT_EQ(positions("1"), positions("1"));
    EXPECT_NE(positions("1"), positions("2"));
}

TEST(RockFeed, counts_what_was_placed_and_rejected) {
    const Study study = study_of("[[feed]]\ncount = 20000\n[[feed.class]]\ndiameter_m = 0.02\n[[feed.class]]\ndiameter_m = 0.01\n");
    const std::vector<PlacedFeed> feeds = place_feeds(study, scene());
    const nlohmann::json report = nlohmann::json::parse(feed_json(feeds, study)).at("feeds")[0];
    EXPECT_EQ(report.at("requested"), 20000);
    EXPECT_EQ(report.at("placed").get<int>() + report.at("rejected").get<int>(), 20000);
    EXPECT_GT(report.at("rejected").get<int>(), 0);
    EXPECT_FALSE(report.at("reasons").empty());
    EXPECT_EQ(report.at("classes")[0].at("count").get<int>() + report.at("classes")[1].at("count").get<int>(),
              report.at("placed").get<int>());
    const std::string csv = rock_feed_csv(feeds);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), report.at("placed").get<int>() + 1);
    EXPECT_EQ(csv.substr(0, csv.find('\n')), "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3");
}

TEST(RockFeed, settling_speed_is_that_of_the_reference) {
    // 10 mm, 2650 kg/m3 in water: 0.736 m/s (Nieuwboer, van Rhee, Keetels 2023: 0.74 m/s).
    const Study study = study_of("");
    EXPECT_NEAR(settling_speed(study, {0.01, 2650.0, 1.0}), 0.736, 0.002);
}

TEST(StudyCase, carries_the_study_into_the_case) {
    Study study = study_of("[[feed]]\ncount = 3\n[[feed.class]]\ndiameter_m = 0.02\ndensity_kg_m3 = 2700\n");
    study.suction.mouth_azimuth = k_pi / 2.0;
    const CaseInputs inputs = case_inputs_of(study, k_head, cylinder(), 2);
    EXPECT_TRUE(check_case_inputs(inputs).empty());
    EXPECT_NEAR(inputs.rotor.speed, 2.0 * k_pi, 1e-12);
    EXPECT_NEAR((inputs.fates.mouth.centre - Vec3(0.0, 0.22, 0.05)).norm(), 0.0, 1e-12);
    EXPECT_NEAR(inputs.fates.mouth.depth, 0.2, 1e-12);
    EXPECT_NEAR(inputs.tank.z_min, -0.875, 1e-12);
    EXPECT_NEAR(inputs.tank.z_max, 0.435, 1e-12);
    EXPECT_NEAR(inputs.gravity.x(), inputs.gravity.norm() * std::cos(k_pi / 4.0), 1e-12);
    ASSERT_TRUE(inputs.rock.has_value());
    EXPECT_EQ(inputs.rock->density, 2700.0);
    EXPECT_EQ(inputs.ranks, 2);
    EXPECT_TRUE(inputs.stop.has_value());
    const CaseInputs flow = case_inputs_of(study_of(""), k_head, cylinder(), 1);
    EXPECT_FALSE(flow.rock.has_value()) << "without feed it is a pure flow run";
    EXPECT_FALSE(flow.stop.has_value()) << "cutterFoam takes no rule of rock without rock";
}
