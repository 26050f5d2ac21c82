#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <nlohmann/json.hpp>

#include "geometry/base/error.hpp"
#include "geometry/head/geometry_report.hpp"
#include "geometry/head/head.hpp"
#include "geometry/head/rotational_symmetry.hpp"
#include "geometry/surface/revolve.hpp"
#include "geometry/tests/solids.hpp"

namespace cutterflow::geometry {
namespace {

using testing::model_crown;

/// A head, how it was moved, and how rough its points are.
struct MovedHead {
    int blades;
    double wrap_deg;
    Vec3 turn_about;
    double turn;
    Vec3 shift;
    double noise;  // standard deviation of the points, share of the ring radius
};

TriangleSurface head_surface(const MovedHead& moved) {
    CrownParameters p = model_crown();
    p.blade_count = moved.blades;
    p.blade_wrap = moved.wrap_deg * k_pi / 180.0;
    p.edge_length = 0.03;
    TriangleSurface surface = generate_crown_cutter(p);
    std::mt19937 generator(7);
    std::normal_distribution<double> noise(0.0, moved.noise * p.ring_radius);
    for (Vec3& point : surface.points) point += Vec3(noise(generator), noise(generator), noise(generator));
    Eigen::Affine3d transform(Eigen::Translation3d(moved.shift));
    transform.rotate(Eigen::AngleAxisd(moved.turn, moved.turn_about.normalized()));
    return transformed(surface, transform);
}

class MovedHeads : public ::testing::TestWithParam<MovedHead> {};

TEST_P(MovedHeads, axis_blades_and_ring_are_found) {
    const MovedHead& moved = GetParam();
    const Head head = understand_head(head_surface(moved));
    const Vec3 direction = Eigen::AngleAxisd(moved.turn, moved.turn_about.normalized()) * Vec3::UnitZ();
    const double angle_deg = std::acos(std::min(1.0, head.axis.direction.dot(direction))) * 180.0 / k_pi;
    EXPECT_LT(angle_deg, 0.1);
    const Vec3 offset = head.axis.origin - moved.shift;
    EXPECT_LT((offset - direction * offset.dot(direction)).norm(), 0.001 * 0.4);
    EXPECT_LT(std::abs(offset.dot(direction)), 0.4 * (1e-4 + 5.0 * moved.noise));
    EXPECT_EQ(head.symmetry.blade_count, moved.blades);
    EXPECT_NEAR(head.ring_radius, 0.4, 0.4 * (1e-4 + 5.0 * moved.noise));
    EXPECT_NEAR(head.lowest_z, -0.485, 0.4 * (3e-4 + 8.0 * moved.noise));
    EXPECT_EQ(head.carrying.sense, moved.wrap_deg > 0.0 ? CarryingSense::positive : CarryingSense::negative);
    EXPECT_NEAR(bounds_of(head.surface).max.z(), 0.0, 1e-6);
    EXPECT_LT(head.steel_above_ring, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Heads, MovedHeads,
                         ::testing::Values(MovedHead{6, 60.0, Vec3(1, 0, 0), 0.0, Vec3::Zero(), 0.0},
                                           MovedHead{6, 60.0, Vec3(1, 2, 0.3), 0.7, Vec3(12.0, -3.0, 0.5), 0.0},
                                           MovedHead{6, -60.0, Vec3(1, 0, 0), k_pi, Vec3(0.1, 0.0, 0.0), 0.001},
                                           MovedHead{4, 40.0, Vec3(0, 1, 0), 1.5707963, Vec3(-1.0, 5.0, 2.0), 0.0005},
                                           MovedHead{5, 80.0, Vec3(3, -1, 2), 2.2, Vec3(0.0, 0.3, -0.7), 0.001},
                                           MovedHead{7, 50.0, Vec3(-1, 1, 1), 1.1, Vec3(2.0, 2.0, 2.0), 0.0},
                                           MovedHead{8, -30.0, Vec3(0, -1, 0.2), 0.4, Vec3(0.0, 0.0, 1.0), 0.0005}));

TEST(Head, one_that_stands_in_the_run_frame_keeps_its_coordinates) {
    const TriangleSurface cutter = generate_crown_cutter(model_crown());
    const Head head = understand_head(cutter);
    EXPECT_EQ(head.axis.direction, Vec3::UnitZ());
    for (std::size_t i = 0; i < cutter.points.size(); ++i) EXPECT_LT((head.surface.points[i] - cutter.points[i]).norm(), 1e-12);
}

TEST(Head, the_transform_brings_the_file_into_the_run_frame) {
    const MovedHead moved{6, 60.0, Vec3(1, 2, 0.3), 0.7, Vec3(12.0, -3.0, 0.5), 0.0};
    const TriangleSurface file = head_surface(moved);
    const Head head = understand_head(file);
    EXPECT_NEAR((head.to_run_frame * head.axis.origin).norm(), 0.0, 1e-9);
    EXPECT_NEAR((head.to_run_frame.linear() * head.axis.direction - Vec3::UnitZ()).norm(), 0.0, 1e-9);
    EXPECT_NEAR(bounds_of(head.surface).max.z(), 0.0, 1e-9);
    EXPECT_NEAR((head.to_run_frame * file.points[17] - head.surface.points[17]).norm(), 0.0, 1e-9);
}

TEST(Head, a_shaft_above_the_ring_does_not_move_the_ring_plane) {
    const TriangleSurface shaft = solid_of_revolution({{0.0, -0.29}, {0.06, -0.29}, {0.06, 0.51}, {0.0, 0.51}}, 24, 0.05);
    const TriangleSurface head_and_shaft = joined({generate_crown_cutter(model_crown()), shaft});
    const Head head = understand_head(head_and_shaft);
    EXPECT_NEAR(head.axis.origin.z(), 0.0, 1e-9);
    EXPECT_NEAR(head.steel_above_ring, 0.51, 1e-9);
    EXPECT_NEAR(head.ring_radius, 0.4, 1e-6);
}

TEST(Head, one_with_equal_moments_of_inertia_is_found_too) {
    // Deep hub and light ring: the moments about axis and diameter agree, every direction is principal.
    CrownParameters p = model_crown();
    p.edge_length = 0.03;
    const TriangleSurface crown = generate_crown_cutter(p);
    const auto stretched = [&crown](double factor) { return transformed(crown, Eigen::Affine3d(Eigen::Scaling(1.0, 1.0, factor))); };
    double low = 0.5;
    double high = 3.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        const Eigen::Matrix3d inertia = mass_properties(stretched(middle)).inertia;
        (inertia(2, 2) > inertia(0, 0) ? low : high) = middle;
    }
    Eigen::Affine3d turn(Eigen::AngleAxisd(0.8, Vec3(1.0, 1.0, 0.2).normalized()));
    const Head head = understand_head(transformed(stretched(low), turn));
    EXPECT_GT(head.axis.direction.dot(turn.linear() * Vec3::UnitZ()), std::cos(0.1 * k_pi / 180.0));
    EXPECT_EQ(head.symmetry.blade_count, 6);
}

TEST(Head, a_body_without_rotational_symmetry_is_refused) {
    try {
        understand_head(joined({testing::box(Vec3(0, 0, 0), Vec3(1.0, 0.3, 0.2)), testing::box(Vec3(0.0, 0.5, 0.0), Vec3(0.2, 1.3, 0.9))}));
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("no axis of rotational symmetry"), std::string::npos) << error.what();
    }
}

TriangleSurface moved(const TriangleSurface& surface, double azimuth, const Vec3& way) {
    return transformed(surface, Eigen::AngleAxisd(azimuth, Vec3::UnitZ()) * Eigen::Translation3d(way));
}

TEST(Head, a_separate_body_that_no_turn_repeats_is_named_with_its_place) {
    const TriangleSurface crown = generate_crown_cutter(model_crown()), crumb = testing::box(-0.01 * Vec3::Ones(), 0.01 * Vec3::Ones());
    const Vec3 above_ring(0.45, 0.05, 0.2);
    std::vector<TriangleSurface> parts{crown, moved(crumb, 0.0, above_ring)};
    try {
        understand_head(joined(parts));
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("a separate body of 8e-06 m3 at (0.45, 0.05, 0.2) m is not repeated by a turn of 60"),
                  std::string::npos)
            << error.what();
    }
    // One per blade, as picks that stand free.
    parts = {crown};
    for (int i = 0; i < 6; ++i) parts.push_back(moved(crumb, i * k_pi / 3.0, Vec3(0.45, 0.0, -0.1)));
    EXPECT_NEAR(understand_head(joined(parts)).axis.direction.z(), 1.0, 1e-9);
}

TEST(Head, a_body_with_equal_ends_is_refused) {
    EXPECT_THROW(understand_head(testing::box(Vec3(-0.2, -0.2, -0.5), Vec3(0.2, 0.2, 0.5))), UserError);
}

// Contours of solids whose profile is known. Inscribed polygons touch their circle at the corners: the largest radius is exact.
TEST(RevolutionContour, of_a_cylinder_is_its_radius) {
    const RadiusProfile profile(solid_of_revolution({{0.0, -0.5}, {0.3, -0.5}, {0.3, 0.0}, {0.0, 0.0}}, 48, 0.02));
    const RevolutionContour contour = fit_contour(profile, -0.5, 0.0, 1e-5);
    for (const double r : contour.radius) EXPECT_NEAR(r, 0.3, 1e-12);
    EXPECT_LT(contour.error, 1e-12);
    EXPECT_DOUBLE_EQ(contour.z.front(), -0.5);
    EXPECT_DOUBLE_EQ(contour.z.back(), 0.0);
}

TEST(RevolutionContour, of_a_cone_is_a_straight_line) {
    const RadiusProfile profile(solid_of_revolution({{0.0, -0.5}, {0.3, 0.0}, {0.0, 0.0}}, 64, 0.02));
    const RevolutionContour contour = fit_contour(profile, -0.5, 0.0, 1e-5);
    for (std::size_t i = 0; i < contour.z.size(); ++i) EXPECT_NEAR(contour.radius[i], 0.6 * (contour.z[i] + 0.5), 1e-9);
    EXPECT_LT(contour.error, 1e-5);
}

TEST(RevolutionContour, of_a_ball_stays_within_its_stated_error) {
    std::vector<MeridianPoint> half_circle;
    for (int k = 0; k <= 200; ++k) half_circle.push_back({0.4 * std::sin(k_pi * k / 200.0), -0.4 * std::cos(k_pi * k / 200.0)});
    half_circle.front().r = half_circle.back().r = 0.0;
    const RadiusProfile profile(solid_of_revolution(half_circle, 96, 0.02));
    const RevolutionContour contour = fit_contour(profile, -0.4, 0.0, 2e-4);
    const Contour line(contour.z, contour.radius, 0.4, 0.0);
    EXPECT_LE(contour.error, 2e-4);
    for (double z = -0.3999; z < 0.0; z += 0.0007) {
        const double exact = std::sqrt(0.16 - z * z);
        EXPECT_LT(std::abs(line.signed_distance(exact, z)), contour.error + 5e-5) << z;
    }
}

TEST(RevolutionContour, resolves_a_step) {
    const RadiusProfile profile(
        solid_of_revolution({{0.0, -0.5}, {0.2, -0.5}, {0.2, -0.1}, {0.4, -0.1}, {0.4, 0.0}, {0.0, 0.0}}, 32, 0.05));
    const RevolutionContour contour = fit_contour(profile, -0.5, 0.0, 1e-4);
    const Contour line(contour.z, contour.radius, 0.4, 0.0);
    EXPECT_NEAR(line.radius_at(-0.1 - 0.5 / 2048.0), 0.2, 1e-3);
    EXPECT_NEAR(line.radius_at(-0.1 + 0.5 / 2048.0), 0.4, 1e-3);
    EXPECT_LE(contour.error, 0.5 / 2048.0);
}

TEST(GeometryReport, holds_what_was_found_with_units_in_the_keys) {
    ImportedSurface imported{generate_crown_cutter(model_crown()), decide_unit(0.4, std::nullopt)};
    const nlohmann::json report = to_json(inspect_cutter(imported, "crown.stl"));
    EXPECT_TRUE(report.at("sound").get<bool>());
    EXPECT_EQ(report.at("head").at("blades").get<int>(), 6);
    EXPECT_NEAR(report.at("head").at("ring_radius_m").get<double>(), 0.4, 1e-5);
    EXPECT_NEAR(report.at("head").at("thickness_m").get<double>(), 0.024, 0.001);
    // Straight blades would leave the chord of a pitch at their inner edge below the ring, less their thickness; wrapped ones less.
    const double chord = 2.0 * 0.335 * std::sin(k_pi / 6.0) - 0.024;
    EXPECT_LT(report.at("head").at("passage_m").get<double>(), chord);
    EXPECT_GT(report.at("head").at("passage_m").get<double>(), 0.5 * chord);
    EXPECT_EQ(report.at("head").at("carrying").at("sense").get<std::string>(), "positive");
    EXPECT_NEAR(report.at("surface").at("volume_m3").get<double>(), volume_of(imported.surface), 1e-12);
    EXPECT_EQ(report.at("unit").at("name").get<std::string>(), "m");

    imported.surface.triangles.pop_back();
    const nlohmann::json open = to_json(inspect_cutter(imported, "open.stl"));
    EXPECT_FALSE(open.at("sound").get<bool>());
    EXPECT_FALSE(open.contains("head"));
    EXPECT_EQ(open.at("defects").at("border_edges").at("count").get<int>(), 3);
}

TEST(Head, of_a_body_whose_axis_fit_may_run_away_is_refused_or_stays_at_the_body) {
    TriangleSurface pyramid{{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}, {10.5, 0.5, 1}},
                            {{0, 1, 2}, {0, 2, 3}, {4, 0, 3}, {3, 2, 4}, {2, 1, 4}, {1, 0, 4}}};
    for (Vec3& point : pyramid.points) point *= 0.0254;
    try {
        EXPECT_LT(find_rotational_symmetry(pyramid).axis.origin.norm(), 0.3);
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("no axis of rotational symmetry was found"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace cutterflow::geometry
