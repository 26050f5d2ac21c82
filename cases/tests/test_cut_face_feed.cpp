// Rock from a cut face: sizes by a law, leading faces of a head's steel, and a schedule that delivers the mass rate ahead of the blades.
#include "cases/scenes/cutter/cut_face_feed.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cases/scenes/cutter/feed.hpp"
#include "cases/scenes/cutter/study_bank.hpp"
#include "cases/study/size_law.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/head/blade_faces.hpp"
#include "geometry/head/crown_cutter.hpp"
#include "geometry/head/revolution_contour.hpp"
#include "geometry/tests/solids.hpp"

namespace cutterflow::cases {
namespace {

constexpr double k_period = 1.0;  // 60 rpm
constexpr double k_swing_speed = 0.1, k_density = 2650.0, k_porosity = 0.15;

TEST(SizeLaw, is_the_published_one) {
    const SizeDistribution rosin{SizeLaw::rosin_rammler, 0.02, 2.0, 0.005, 0.05};
    EXPECT_NEAR(rosin.mass_below(0.02), 1.0 - std::exp(-1.0), 1e-15);
    EXPECT_NEAR(rosin.mass_below(0.01), 1.0 - std::exp(-0.25), 1e-15);
    const SizeDistribution log_normal{SizeLaw::log_normal, 0.02, 0.5, 0.005, 0.08};
    EXPECT_NEAR(log_normal.mass_below(0.02), 0.5, 1e-15);
    EXPECT_NEAR(log_normal.mass_below(0.02 * std::exp(0.5)), 0.841344746068543, 1e-12);
}

TEST(SizeLaw, classes_share_the_mass_within_the_bounds) {
    const SizeDistribution sizes{SizeLaw::rosin_rammler, 0.02, 2.0, 0.01, 0.04};
    const std::vector<double> diameters = equal_mass_diameters(sizes, 5);
    ASSERT_EQ(diameters.size(), 5u);
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(sizes.truncated_mass_below(diameters[i]), (i + 0.5) / 5.0, 1e-9);
    // By hand: F = 0.22120 at 10 mm, 0.98168 at 40 mm; the middle of the mass between them is at F = 0.60144.
    EXPECT_NEAR(diameters[2], 0.02 * std::sqrt(-std::log(1.0 - 0.601444)), 1e-7);
}

/// The model crown and its contour; places are found once.
struct Crown {
    Crown() : surface(geometry::generate_crown_cutter(geometry::testing::model_crown())), contour(contour_of(surface)) {}
    static geometry::Contour contour_of(const geometry::TriangleSurface& surface) {
        const geometry::RevolutionContour fitted = geometry::fit_contour(geometry::RadiusProfile(surface), -0.485, 0.0, 1e-3);
        return {fitted.z, fitted.radius, 0.40, 0.03};
    }
    CuttingHead head(double sense) const { return {contour, surface, sense * 2.0 * k_pi / k_period}; }
    geometry::TriangleSurface surface;
    geometry::Contour contour;
};

const Crown& crown() {
    static const Crown made;
    return made;
}

/// A face over 150 degrees of azimuth and 0.3 m of height, by the sine of the azimuth from its lowest line.
geometry::CutFace face() {
    geometry::CutFace made;
    for (int i = 0; i < 30; ++i)
        for (int k = 0; k < 20; ++k) {
            geometry::CutFacePatch patch;
            patch.azimuth_rad = (5.0 * i + 2.5) * k_pi / 180.0;
            patch.depth_m = 0.06 + 0.015 * (k + 0.5);
            patch.radius_m = crown().contour.radius_at(-patch.depth_m) + 0.008;
            patch.flux_area_m2 = 0.05 * std::sin(patch.azimuth_rad) * k_pi / 36.0 / 20.0 / 1.87;
            made.patches.push_back(patch);
        }
    return made;
}

CutRequest request() {
    CutRequest made;
    made.face = face();
    made.mass_rate = cut_mass_rate(made.face, k_swing_speed, k_density, k_porosity);
    made.begin = 2.0 * k_period;
    made.end = 5.0 * k_period;
    made.seed = 3;
    made.classes = {{0.02, k_density, 2.0}, {0.03, k_density, 1.0}};
    return made;
}

double mass_of(const CutRequest& request, const std::vector<CutRock>& rocks) {
    return std::accumulate(rocks.begin(), rocks.end(), 0.0, [&](double sum, const CutRock& rock) {
        const FeedClass& its = request.classes[rock.rock_class];
        return sum + sphere_mass(its.diameter, its.density);
    });
}

/// By which share the mass of a schedule between two times is off the rate.
double rate_error(const CutRequest& request, const std::vector<CutRock>& rocks, double from, double to) {
    std::vector<CutRock> between;
    std::copy_if(rocks.begin(), rocks.end(), std::back_inserter(between), [&](const CutRock& r) { return r.time >= from && r.time < to; });
    return std::abs(mass_of(request, between) / (request.mass_rate * (to - from)) - 1.0);
}

constexpr double k_rate_tolerance = 0.01;

// What does not make a whole rock is carried: over whole turns the mass is exact but for one rock of each class, here 0.3 % of a turn's.
TEST(CutFaceFeed, delivers_the_mass_rate_in_every_turn) {
    const CutRequest asked = request();
    double area = 0.0;
    for (const geometry::CutFacePatch& patch : asked.face.patches) area += patch.flux_area_m2;
    EXPECT_NEAR(asked.mass_rate, 0.1 * area * 2650.0 * 0.85, 1e-12);
    const double one_of_each = sphere_mass(0.02, k_density) + sphere_mass(0.03, k_density);
    for (const double sense : {1.0, -1.0}) {
        const std::vector<CutRock> rocks = cut_face_schedule(asked, crown().head(sense)).rocks;
        EXPECT_LE(rate_error(asked, rocks, asked.begin, asked.end), k_rate_tolerance);
        for (double turn = asked.begin; turn < asked.end; turn += k_period)
            EXPECT_LE(rate_error(asked, rocks, turn, turn + k_period), one_of_each / (asked.mass_rate * k_period));
        std::vector<double> by_class(2, 0.0);
        for (const CutRock& rock : rocks) by_class[rock.rock_class] += sphere_mass(asked.classes[rock.rock_class].diameter, k_density);
        EXPECT_NEAR(by_class[0] / by_class[1], 2.0, 0.02);
        EXPECT_TRUE(std::is_sorted(rocks.begin(), rocks.end(), [](const CutRock& a, const CutRock& b) { return a.time < b.time; }));
    }
}

TEST(CutFaceFeed, that_loses_a_fiftieth_of_its_rock_fails_the_check_of_the_rate) {
    CutRequest asked = request();
    asked.classes = {{0.02, k_density, 1.0}};
    std::vector<CutRock> rocks = cut_face_schedule(asked, crown().head(1.0)).rocks;
    EXPECT_LE(rate_error(asked, rocks, asked.begin, asked.end), k_rate_tolerance);
    for (std::size_t i = rocks.size() / 50 * 50; i > 0; i -= 50) rocks.erase(rocks.begin() + static_cast<std::ptrdiff_t>(i) - 1);
    EXPECT_GT(rate_error(asked, rocks, asked.begin, asked.end), k_rate_tolerance);
}

TEST(CutFaceFeed, starts_every_rock_ahead_of_a_blade_within_the_head_and_outside_steel) {
    const CutRequest asked = request();
    const geometry::SolidSearch cutter(crown().surface);
    for (const double sense : {1.0, -1.0}) {
        const CuttingHead head = crown().head(sense);
        const std::vector<CutRock> rocks = cut_face_schedule(asked, head).rocks;
        ASSERT_GT(rocks.size(), 500u);
        for (const CutRock& rock : rocks) {
            const double diameter = asked.classes[rock.rock_class].diameter;
            double radius = 1.0;
            for (const Vec3& place : rock.places) {
                const Vec3 in_rotor = rotate_about({}, -head.rotation_speed * rock.time, place);
                EXPECT_FALSE(cutter.contains(in_rotor));
                EXPECT_GE(cutter.nearest(in_rotor).distance, 0.5 * diameter);
                EXPECT_LE(crown().contour.signed_distance(place.head<2>().norm(), place[2]), -0.5 * diameter);
                EXPECT_LT(place.head<2>().norm(), radius - 0.99 * diameter * (radius < 1.0)) << "farther inwards by a diameter";
                radius = place.head<2>().norm();
            }
            // Behind the first place, against the sense of rotation, is steel before the pitch of six blades is half over.
            const Vec3 in_rotor = rotate_about({}, -head.rotation_speed * rock.time, rock.places.front());
            bool blade = false;
            for (double back = 0.0; back < k_pi / 6.0 && !blade; back += 0.005)
                blade = cutter.contains(rotate_about({}, -sense * back, in_rotor));
            EXPECT_TRUE(blade) << "at z " << in_rotor.z();
        }
    }
}

TEST(CutFaceFeed, places_follow_the_flux_areas) {
    CutRequest asked = request();
    asked.classes = {{0.02, k_density, 1.0}};
    const std::vector<CutRock> rocks = cut_face_schedule(asked, crown().head(1.0)).rocks;
    // 10 sectors of 15 degrees; the flux through each is the difference of cosines.
    std::vector<double> counts(10, 0.0), expected(10, 0.0);
    for (const CutRock& rock : rocks) {
        const double azimuth = to_cylindrical({}, Vec3::UnitX(), rock.places.front()).azimuth;
        counts.at(static_cast<std::size_t>(azimuth * 12.0 / k_pi)) += 1.0;
    }
    double area = 0.0;
    for (const geometry::CutFacePatch& patch : asked.face.patches) {
        expected.at(static_cast<std::size_t>(patch.azimuth_rad * 12.0 / k_pi)) += patch.flux_area_m2;
        area += patch.flux_area_m2;
    }
    double chi_square = 0.0;
    for (std::size_t i = 0; i < 10; ++i) {
        const double due = expected[i] / area * static_cast<double>(rocks.size());
        chi_square += std::pow(counts[i] - due, 2) / due;
    }
    EXPECT_LE(chi_square, 21.7) << "1 % of fair draws exceed this, with 9 degrees of freedom";
}

TEST(CutFaceFeed, of_closed_steel_goes_in_beside_it) {
    CutRequest asked = request();
    asked.classes = {{0.02, k_density, 1.0}};
    EXPECT_EQ(cut_face_schedule(asked, crown().head(1.0)).share_without_blade, 0.0);
    const double open = asked.face.patches.back().depth_m;
    // As if the nose were cut: the hub closes all azimuths from 0.4 m on.
    for (geometry::CutFacePatch& patch : asked.face.patches) patch.depth_m += 0.485 - open;
    const CutSchedule schedule = cut_face_schedule(asked, crown().head(1.0));
    double closed = 0.0, all = 0.0, lowest = 0.0, highest = -1.0;
    for (const geometry::CutFacePatch& patch : asked.face.patches) {
        all += patch.flux_area_m2;
        if (patch.depth_m > 0.4) closed += patch.flux_area_m2;
    }
    EXPECT_NEAR(schedule.share_without_blade, closed / all, 0.08);
    for (const CutRock& rock : schedule.rocks) {
        lowest = std::min(lowest, rock.places.front().z());
        highest = std::max(highest, rock.places.front().z());
    }
    EXPECT_LT(lowest, -0.36);
    EXPECT_GT(highest, -0.25);
}

TEST(CutFaceFeed, sizes_follow_their_law) {
    CutRequest asked = request();
    asked.mass_rate *= 4.0;
    const SizeDistribution sizes{SizeLaw::rosin_rammler, 0.02, 2.0, 0.01, 0.04};
    constexpr int classes = 6;
    asked.classes.clear();
    for (const double diameter : equal_mass_diameters(sizes, classes)) asked.classes.push_back({diameter, k_density, 1.0});
    const std::vector<CutRock> rocks = cut_face_schedule(asked, crown().head(1.0)).rocks;
    // Numbers between the classes' bounds, against the law of mass over the mass of a rock there.
    std::vector<double> counts(classes, 0.0);
    for (const CutRock& rock : rocks) {
        const double share = sizes.truncated_mass_below(asked.classes[rock.rock_class].diameter);
        counts.at(static_cast<std::size_t>(share * classes)) += 1.0;
    }
    double chi_square = 0.0;
    const double total = asked.mass_rate * (asked.end - asked.begin);
    for (int i = 0; i < classes; ++i) {
        // Rosin and Rammler by hand, at the middle of the class' mass.
        const double low = 1.0 - std::exp(-0.25), high = 1.0 - std::exp(-4.0);
        const double diameter = 0.02 * std::sqrt(-std::log(1.0 - (low + (i + 0.5) / classes * (high - low))));
        const double due = total / classes / (k_density * k_pi / 6.0 * std::pow(diameter, 3));
        chi_square += std::pow(counts[static_cast<std::size_t>(i)] - due, 2) / due;
    }
    EXPECT_LE(chi_square, 15.1) << "1 % of fair draws exceed this, with 5 degrees of freedom";
}

TEST(CutFaceFeed, of_a_study_follows_from_its_bank_and_soil) {
    const std::string text =
        "[cutter]\nfile = \"c.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n[swing]\nspeed_m_min = 6\n"
        "[bank]\nmodel = \"wall\"\n[soil]\nporosity = 0.3\ngrain_density_kg_m3 = 2700\n[run]\nflow_revolutions = 1\nmax_revolutions = 4\n"
        "[[feed]]\nkind = \"cut_face\"\ndisintegration = 0.8\nsize_law = \"log_normal\"\nsize_d50_m = 0.02\nsize_spread = 0.3\n"
        "size_min_m = 0.01\nsize_max_m = 0.04\nsize_classes = 4\n";
    HeadSize size{0.40, 0.40, 0.485};
    size.blades = 6;
    const Study study = make_study(resolve_study(parse_parameters(study_table(), text, "study.toml"), size), "/");
    const std::vector<PlacedFeed> feeds = place_feeds(study, feed_scene(study, size, crown().contour, crown().surface));
    ASSERT_EQ(feeds.size(), 1u);
    double mass = 0.0;
    for (const PlacedRock& rock : feeds[0].rocks) {
        const FeedClass& its = feeds[0].request.classes.at(rock.rock_class);
        EXPECT_EQ(its.density, 2700.0);
        for (const coupling::FeedPlace& place : rock.places)
            EXPECT_NEAR((*place.velocity - 0.5 * 2.0 * k_pi * Vec3::UnitZ().cross(place.position)).norm(), 0.0, 1e-12);
        mass += sphere_mass(its.diameter, its.density);
    }
    const geometry::Bank bank = bank_of(study, crown().contour);
    const double expected = 0.1 * bank.cut_section() * 2700.0 * 0.7 * 0.8 * 3.0;  // over the three turns after the first
    EXPECT_NEAR(mass, expected, 0.01 * expected);
    const std::string csv = rock_feed_csv(feeds);
    EXPECT_EQ(csv.substr(0, csv.find('\n')), "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3,vx_m_s,vy_m_s,vz_m_s,place");
}

TEST(CutFaceFeed, of_a_study_has_the_density_of_its_soil_and_leaves_out_the_fines_of_its_law) {
    const auto feed_of = [](const std::string& feed_keys) {
        const std::string text =
            "[cutter]\nfile = \"c.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n[swing]\nspeed_m_min = 6\n"
            "[bank]\nmodel = \"wall\"\n[soil]\ngrain_density_kg_m3 = 2000\n[[feed]]\nkind = \"cut_face\"\n" +
            feed_keys;
        const ParameterValues resolved = resolve_study(parse_parameters(study_table(), text, "study.toml"), {0.40, 0.40, 0.485});
        // As a run reads it again from its folder.
        return make_study(parse_parameters(study_table(), commented_toml(study_table(), &resolved), "study.toml"), "/").feeds.at(0);
    };
    const std::string law = "size_law = \"rosin_rammler\"\nsize_d63_m = 0.02\nsize_spread = 2\nsize_min_m = 0.01\nsize_max_m = 0.06\n";
    const FeedRequest by_law = feed_of(law);
    EXPECT_NEAR(by_law.disintegration, std::exp(-0.25), 1e-9);
    EXPECT_EQ(by_law.classes.at(0).density, 2000.0);
    EXPECT_EQ(feed_of(law + "disintegration = 1\n").disintegration, 1.0);
    const FeedRequest by_classes = feed_of("[[feed.class]]\ndiameter_m = 0.02\n[[feed.class]]\ndiameter_m = 0.03\ndensity_kg_m3 = 2650\n");
    EXPECT_EQ(by_classes.disintegration, 1.0);
    EXPECT_EQ(by_classes.classes.at(0).density, 2000.0);
    EXPECT_EQ(by_classes.classes.at(1).density, 2650.0) << "given, though it is the default";
}

TEST(CutFaceFeed, of_a_study_brings_what_the_swing_before_left) {
    const std::string text =
        "[cutter]\nfile = \"c.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n[swing]\nspeed_m_min = 6\n"
        "[bank]\nmodel = \"wall\"\n[bed]\nspill_layer_m = 0.05\n[soil]\nbulking = 1.25\n[run]\nflow_revolutions = 1\nmax_revolutions = 4\n"
        "[[feed]]\nkind = \"cut_face\"\ndisintegration = 0.8\n[[feed.class]]\ndiameter_m = 0.02\n";
    HeadSize size{0.40, 0.40, 0.485};
    size.blades = 6;
    const Study study = make_study(resolve_study(parse_parameters(study_table(), text, "study.toml"), size), "/");
    const std::vector<PlacedFeed> feeds = place_feeds(study, feed_scene(study, size, crown().contour, crown().surface));
    ASSERT_EQ(feeds.size(), 2u);
    EXPECT_FALSE(feeds[0].is_spill_layer);
    EXPECT_TRUE(feeds[1].is_spill_layer);
    const geometry::Bank bank = bank_of(study, crown().contour);
    // Of 20 layers up to the bank's height: what the next swing takes of each.
    ASSERT_EQ(feeds[0].layers.size(), 20u);
    EXPECT_NEAR(feeds[0].layers.back().first, study.bank->cut_height, 1e-12);
    EXPECT_NEAR(feeds[0].layers[4].second, bank.layer_section(0.25 * study.bank->cut_height), 1e-12);
    EXPECT_TRUE(feeds[1].layers.empty());
    // Loose rock without fines, over three turns.
    const double one = sphere_mass(0.02, 2650.0), left = 0.1 * bank.layer_section(0.05) * 2650.0 * 0.85 / 1.25 * 3.0;
    EXPECT_NEAR(static_cast<double>(feeds[1].rocks.size()) * one, left, std::max(0.01 * left, one));
    EXPECT_GT(feeds[1].rocks.size(), 50u);
    EXPECT_EQ(nlohmann::json::parse(feed_json(feeds, study)).at("feeds").at(1).at("left_by_swing_before"), true);
    const std::vector<std::string> lines = feed_lines(feeds);
    EXPECT_TRUE(std::any_of(lines.begin(), lines.end(),
                            [](const std::string& line) { return line.find("left by the swing before") != std::string::npos; }));
}

TEST(CutFaceFeed, a_seed_repeats_and_another_varies_the_places) {
    CutRequest asked = request();
    asked.end = asked.begin + 0.2;
    const auto first = cut_face_schedule(asked, crown().head(1.0)).rocks.front().places;
    EXPECT_EQ(cut_face_schedule(asked, crown().head(1.0)).rocks.front().places, first);
    asked.seed = 4;
    EXPECT_NE(cut_face_schedule(asked, crown().head(1.0)).rocks.front().places, first);
}

TEST(CutFaceFeed, refuses_rock_without_room_ahead_of_any_blade) {
    CutRequest asked = request();
    asked.classes = {{0.5, k_density, 1.0}};
    EXPECT_THROW(cut_face_schedule(asked, crown().head(1.0)), UserError);
}

/// A bar along x through the axis, 60 mm wide, to a radius of 0.38 m in a contour of 0.40 m.
TEST(SteelIntervals, of_a_bar_are_its_two_ends) {
    const geometry::TriangleSurface bar = geometry::testing::box(Vec3(-0.38, -0.03, -0.4), Vec3(0.38, 0.03, -0.01));
    const geometry::Contour contour({-0.485, 0.0}, {0.40, 0.40}, 0.40, 0.03);
    const double edge = std::asin(0.03 / 0.36);  // on the innermost circle, at 0.9 of the radius
    for (const double sense : {1.0, -1.0}) {
        auto intervals = geometry::steel_intervals(geometry::SolidSearch(bar), contour, -0.2, sense);
        ASSERT_EQ(intervals.size(), 2u);
        std::vector<double> leading;
        for (const geometry::SteelInterval& interval : intervals) {
            leading.push_back(interval.leading);
            EXPECT_NEAR(interval.width, 2.0 * edge, 2e-5);
        }
        std::sort(leading.begin(), leading.end());
        EXPECT_NEAR(leading[0], sense > 0.0 ? edge : k_pi - edge, 1e-5);
        EXPECT_NEAR(leading[1], sense > 0.0 ? k_pi + edge : 2.0 * k_pi - edge, 1e-5);
    }
    EXPECT_TRUE(geometry::steel_intervals(geometry::SolidSearch(bar), contour, -0.45, 1.0).empty());
}

}  // namespace
}  // namespace cutterflow::cases
