/// The soil that a swinging head leaves: closed forms for simple bodies, exact booleans for the shipped head.
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/cgal/exact_solid.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/head/head.hpp"
#include "geometry/soil/bank.hpp"
#include "geometry/surface/contact_surface.hpp"
#include "geometry/surface/soundness.hpp"
#include "geometry/tests/solids.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_degree = k_pi / 180.0;
constexpr double k_radius = 0.4, k_depth = 0.3;

/// A drum of radius 0.4 m, 0.3 m deep.
Contour drum() {
    return {{-k_depth, 0.0}, {k_radius, k_radius}, k_radius, 0.03};
}

/// Half a ball of radius 0.4 m below the ring plane, by chords.
Contour half_ball(int chords) {
    std::vector<double> z, r;
    for (int k = 0; k <= chords; ++k) {
        const double angle = 0.5 * k_pi * k / chords;
        z.push_back(-k_radius * std::cos(angle));
        r.push_back(k_radius * std::sin(angle));
    }
    z.back() = 0.0;
    return {z, r, k_radius, 0.03};
}

/// The model cutter's head, understood once.
const Contour& model_head() {
    static const Contour contour = [] {
        const Head head = understand_head(generate_crown_cutter(testing::model_crown()));
        return Contour(head.contour.z, head.contour.radius, head.ring_radius, 0.03);
    }();
    return contour;
}

BankParameters model_bank(double inclination_deg, double swing_sign) {
    BankParameters bank;
    bank.inclination = inclination_deg * k_degree;
    bank.swing_sign = swing_sign;
    bank.cut_height = 0.32;
    bank.step = 0.16;
    bank.pick_length = 0.04;
    bank.clearance = 0.008;
    bank.segments = 48;
    return bank;
}

double flux_of(const CutFace& face) {
    double flux = 0.0;
    for (const CutFacePatch& patch : face.patches) flux += patch.flux_area_m2;
    return flux;
}

/// The box from `low` to `high` along ahead, up and y of the run's frame.
TriangleSurface level_box(double inclination, const Vec3& low, const Vec3& high) {
    const double c = std::cos(inclination), s = std::sin(inclination);
    Eigen::Matrix3d directions;
    directions << -s, -c, 0.0, 0.0, 0.0, 1.0, -c, s, 0.0;  // columns: ahead, up, y
    return transformed(testing::box(low, high), Eigen::Affine3d(directions));
}

TEST(Bank, of_a_lying_drum_is_cut_over_step_times_height) {
    BankParameters bank;
    bank.cut_height = 0.5;
    bank.step = 0.11;
    EXPECT_NEAR(Bank(drum(), bank).cut_section(), 0.5 * 0.11, 1e-14);
    // The axis lies: the head is as high as the drum is thick, its circle a polygon about it.
    EXPECT_NEAR(Bank(drum(), bank).head_height(), 2.0 * k_radius / std::cos(k_pi / bank.segments), 1e-14);
    EXPECT_NEAR(Bank(drum(), bank).head_length(), k_depth, 1e-14);
}

TEST(Bank, of_a_tilted_drum_has_the_section_of_its_corner) {
    for (const double inclination : {30.0, 45.0, 60.0}) {
        BankParameters bank;
        bank.inclination = inclination * k_degree;
        bank.cut_height = 0.14;
        bank.step = 0.1;
        // Above a right-angled corner with sides at l and 90 deg - l from the level the width grows as h (tan l + cot l).
        const double growth = std::tan(bank.inclination) + 1.0 / std::tan(bank.inclination);
        const double full = bank.step / growth;  // height from which on the width is more than a step
        ASSERT_LT(full, bank.cut_height);
        const double expected = 0.5 * full * bank.step + (bank.cut_height - full) * bank.step;
        EXPECT_NEAR(Bank(drum(), bank).cut_section(), expected, 1e-12) << inclination;
    }
}

TEST(Bank, of_half_a_ball_approaches_the_crescent_with_the_square_of_its_edges) {
    const double step = 0.1;
    const double lens =
        2.0 * k_radius * k_radius * std::acos(0.5 * step / k_radius) - 0.5 * step * std::sqrt(4.0 * k_radius * k_radius - step * step);
    const double crescent = 0.5 * (k_pi * k_radius * k_radius - lens);
    std::vector<double> errors;
    for (const int segments : {24, 48, 96}) {
        BankParameters bank;
        bank.inclination = 90.0 * k_degree;
        bank.cut_height = k_radius;
        bank.step = step;
        bank.segments = segments;
        errors.push_back(Bank(half_ball(segments), bank).cut_section() / crescent - 1.0);
    }
    EXPECT_LT(std::abs(errors[2]), 0.001);
    EXPECT_NEAR(errors[0] / errors[1], 4.0, 0.4);
    EXPECT_NEAR(errors[1] / errors[2], 4.0, 0.4);
}

TEST(Bank, loses_its_cut_section_per_metre_of_the_swing) {
    for (const double inclination : {30.0, 45.0, 60.0})
        for (const double swing : {1.0, -1.0}) {
            const Bank bank(model_head(), model_bank(inclination, swing));
            // What the swing takes below the bank's top beyond what the two swings before it took.
            const auto taken = [&](double length) {
                ExactSolid solid(bank.sweep(length));
                for (const int steps : {1, 2}) solid.subtract(ExactSolid(bank.earlier_sweep(steps, 4.0)));
                solid.subtract(ExactSolid(level_box(inclination * k_degree, {-3.0, bank.top(), -5.0}, {3.0, 3.0, 5.0})));
                return volume_of(solid.surface());
            };
            const double per_metre = (taken(2.0) - taken(1.0)) / 1.0;
            EXPECT_NEAR(per_metre / bank.cut_section(), 1.0, 1e-9) << inclination << " " << swing;
        }
}

TEST(CutFace, adds_up_to_the_cut_section) {
    for (const double inclination : {0.0, 30.0, 45.0, 60.0, 90.0})
        for (const double swing : {1.0, -1.0})
            for (const double length : {0.1, 0.01}) {
                BankParameters parameters = model_bank(inclination, swing);
                parameters.cut_height = 0.2;
                const Bank bank(model_head(), parameters);
                const CutFace face = bank.cut_face(length);
                EXPECT_NEAR(flux_of(face) / bank.cut_section(), 1.0, 1e-9) << inclination << " " << swing << " " << length;
            }
}

TEST(SpillLayer, adds_up_to_its_section_and_goes_with_a_small_thickness) {
    for (const double inclination : {0.0, 30.0, 45.0})
        for (const double swing : {1.0, -1.0}) {
            const Bank bank(model_head(), model_bank(inclination, swing));
            for (const double thickness : {0.01, 0.05})
                EXPECT_NEAR(flux_of(bank.layer_face(thickness, 0.01)) / bank.layer_section(thickness), 1.0, 1e-9) << inclination;
            EXPECT_NEAR(bank.layer_section(0.0), 0.0, 1e-15);  // sections of 0.1 m2, to rounding
            EXPECT_NEAR(bank.layer_section(0.002) / bank.layer_section(0.001), 2.0, 0.01);
        }
}

// A drum that lies along the advance has a level bottom, of its length less the step: there the last swing left its layer.
TEST(SpillLayer, of_a_lying_drum_covers_what_both_swings_passed) {
    BankParameters parameters;
    parameters.cut_height = k_radius;
    parameters.step = 0.1;
    parameters.segments = 192;
    const Bank bank(drum(), parameters);
    const double thickness = 0.01, length = bank.head_length() - parameters.step;
    EXPECT_NEAR(bank.layer_section(thickness), thickness * length, 1e-3 * thickness * length);
    for (const CutFacePatch& patch : bank.layer_face(thickness, 0.02).patches) {
        EXPECT_LT(patch.depth_m, k_depth - parameters.step + 0.02) << "not ahead of the last cut";
        EXPECT_LT(k_radius * (1.0 - std::cos(patch.azimuth_rad)), 1.05 * thickness) << "at the bottom";
    }
}

TEST(CutFace, lies_on_the_side_of_the_bank_and_outside_the_head) {
    for (const double swing : {1.0, -1.0}) {
        const CutFace face = Bank(model_head(), model_bank(45.0, swing)).cut_face(0.02);
        ASSERT_GT(face.patches.size(), 200u);
        for (const CutFacePatch& patch : face.patches) {
            EXPECT_GT(swing * std::sin(patch.azimuth_rad), 0.0);
            EXPECT_GE(patch.depth_m, 0.0);
            EXPECT_LE(patch.depth_m, -model_head().z_hub());
            EXPECT_GT(patch.flux_area_m2, 0.0);
        }
    }
}

// n . e of a drum is the sine of the azimuth, and all of it below the bank's top and ahead of the last cut is cut face.
TEST(CutFace, of_a_lying_drum_follows_the_sine_of_the_azimuth) {
    BankParameters parameters;
    parameters.cut_height = k_radius;  // about to the axis: azimuths 0 to 90 degrees
    parameters.step = 0.1;
    parameters.segments = 192;
    const CutFace face = Bank(drum(), parameters).cut_face(0.02);
    double below_60 = 0.0;
    for (const CutFacePatch& patch : face.patches) {
        if (patch.azimuth_rad < 60.0 * k_degree) below_60 += patch.flux_area_m2;
        EXPECT_NEAR(patch.radius_m, k_radius, 1e-3 * k_radius);
        // Ahead of the last cut: the end of the drum, one step long.
        EXPECT_GT(patch.depth_m, k_depth - parameters.step);
    }
    EXPECT_NEAR(below_60 / flux_of(face), 1.0 - std::cos(60.0 * k_degree), 1e-3);
}

TEST(Soil, is_a_sound_solid_that_keeps_its_distance_from_the_head) {
    for (const double inclination : {30.0, 45.0, 60.0}) {
        const BankParameters parameters = model_bank(inclination, 1.0);
        const Bank bank(model_head(), parameters);
        const TriangleSurface soil = bank.soil(1.2);
        EXPECT_TRUE(inspect_surface(soil).sound()) << inclination;
        const SolidSearch search(soil);
        double nearest = 1.0;
        for (std::size_t i = 0; i < model_head().z().size(); ++i)
            for (int k = 0; k < 72; ++k) {
                const double azimuth = 5.0 * k_degree * k, r = model_head().radius()[i];
                const Vec3 on_contour(r * std::cos(azimuth), r * std::sin(azimuth), model_head().z()[i]);
                EXPECT_FALSE(search.contains(on_contour));
                nearest = std::min(nearest, search.nearest(on_contour).distance);
            }
        const double reach = parameters.pick_length + parameters.clearance;
        EXPECT_GE(nearest, reach - 1e-9) << inclination;
        EXPECT_LE(nearest, 1.05 * reach) << inclination;
    }
}

TEST(Soil, is_what_no_sweep_has_taken) {
    const BankParameters parameters = model_bank(45.0, -1.0);
    const Bank bank(model_head(), parameters);
    const SolidSearch soil(bank.soil(1.2));
    const SolidSearch now(bank.sweep(4.0));
    std::vector<SolidSearch> before;
    for (int j = 1; j <= 14; ++j) before.emplace_back(bank.earlier_sweep(j, 4.0));
    std::mt19937_64 generator(1);
    std::uniform_real_distribution<double> within(-1.1, 1.1);
    int in_soil = 0;
    for (int i = 0; i < 2000; ++i) {
        const double ahead = within(generator), up = within(generator), y = within(generator);
        const double c = std::cos(parameters.inclination), s = std::sin(parameters.inclination);
        const Vec3 point(-s * ahead - c * up, y, -c * ahead + s * up);
        bool stands = up < bank.top() && !now.contains(point);
        for (const SolidSearch& sweep : before) stands = stands && !sweep.contains(point);
        EXPECT_EQ(soil.contains(point), stands) << point.transpose();
        in_soil += stands ? 1 : 0;
    }
    EXPECT_GT(in_soil, 200);
    EXPECT_LT(in_soil, 1800);
}

TEST(Soil, of_the_other_swing_is_the_mirrored_one) {
    const Bank over(model_head(), model_bank(45.0, -1.0)), under(model_head(), model_bank(45.0, 1.0));
    EXPECT_NEAR(over.cut_section() / under.cut_section(), 1.0, 1e-12);
    const TriangleSurface a = over.soil(1.0);
    const TriangleSurface b = transformed(under.soil(1.0), Eigen::Affine3d(Eigen::Scaling(1.0, -1.0, 1.0)));
    EXPECT_NEAR(volume_of(a) / volume_of(b), 1.0, 1e-9);
    EXPECT_NEAR(area_of(a) / area_of(b), 1.0, 1e-9);
    const SolidSearch in_a(a), in_b(b);
    for (const Vec3& point : a.points) EXPECT_LT(in_b.nearest(point).distance, 1e-9);
    for (const Vec3& point : b.points) EXPECT_LT(in_a.nearest(point).distance, 1e-9);
    // And they are two: beside the hub, where the one bank stands, the other swing has passed.
    const Vec3 beside(0.0, -0.9, -0.45);
    EXPECT_TRUE(in_a.contains(beside));
    EXPECT_FALSE(SolidSearch(under.soil(1.0)).contains(beside));
}

constexpr double k_reach = 1.2, k_tolerance = 2e-4;

TriangleSurface without(const TriangleSurface& surface, const Vec3& centre, double radius) {
    TriangleSurface left{surface.points, {}};
    for (const Triangle& triangle : surface.triangles)
        if ((centroid_of(surface, triangle) - centre).norm() > radius) left.triangles.push_back(triangle);
    return left;
}

// For a DEM: no thin triangle, on the exact soil within two tolerances, facing the water, away from the head.
TEST(Wall, is_the_soils_surface_with_good_triangles) {
    for (const auto& [inclination, swing] : {std::pair(20.0, -1.0), std::pair(45.0, 1.0)}) {
        const BankParameters parameters = model_bank(inclination, swing);
        const Bank bank(model_head(), parameters);
        const TriangleSurface wall = bank.wall({k_reach, k_tolerance, 0.1});
        const TriangleSurface soil = bank.soil(k_reach);
        EXPECT_GE(smallest_angle_of(wall), 5.0 * k_degree);
        EXPECT_LT(wall.triangles.size(), 30000u);
        EXPECT_LT(bank.wall_error(wall, soil, k_reach, 0.005), 2.0 * k_tolerance) << inclination << " " << swing;
        const SolidSearch search(soil);
        for (const Triangle& triangle : wall.triangles) {
            const Vec3 ahead = 1e-3 * area_vector(wall, triangle).normalized(), centre = centroid_of(wall, triangle);
            EXPECT_FALSE(search.contains(centre + ahead));
            EXPECT_TRUE(search.contains(centre - ahead));
        }
        const SolidSearch from_head(wall);
        double nearest = 1.0;
        for (std::size_t i = 0; i < model_head().z().size(); ++i)
            for (int k = 0; k < 72; ++k) {
                const double azimuth = 5.0 * k_degree * k, r = model_head().radius()[i];
                nearest =
                    std::min(nearest, from_head.nearest({r * std::cos(azimuth), r * std::sin(azimuth), model_head().z()[i]}).distance);
            }
        EXPECT_GT(nearest, parameters.pick_length + parameters.clearance - k_tolerance);
    }
}

TEST(Wall, with_a_hole_is_no_surface_of_its_soil) {
    const Bank bank(model_head(), model_bank(45.0, 1.0));
    const TriangleSurface wall = bank.wall({k_reach, k_tolerance, 0.1}), soil = bank.soil(k_reach);
    // In the cut face, as large as a rock of 20 mm.
    const TriangleSurface broken = without(wall, wall.points[wall.triangles.front()[0]], 0.02);
    ASSERT_LT(broken.triangles.size(), wall.triangles.size());
    EXPECT_GT(bank.wall_error(broken, soil, k_reach, 0.01), 10.0 * k_tolerance);
}

TEST(Bank, knows_where_it_would_overhang) {
    BankParameters bank;
    bank.inclination = 45.0 * k_degree;
    bank.step = 0.1;
    bank.cut_height = 0.2;
    // 0.2 m above the right-angled corner of a tilted drum.
    EXPECT_NEAR(Bank(drum(), bank).width_at_top(), 0.4, 1e-12);
    bank.cut_height = 5.0;
    EXPECT_EQ(Bank(drum(), bank).width_at_top(), 0.0);
}

TEST(Bank, refuses_impossible_parameters) {
    BankParameters bank = model_bank(45.0, 1.0);
    bank.swing_sign = 0.5;
    EXPECT_THROW(Bank(drum(), bank), std::invalid_argument);
    bank = model_bank(45.0, 1.0);
    bank.step = 0.0;
    EXPECT_THROW(Bank(drum(), bank), std::invalid_argument);
    bank = model_bank(45.0, 1.0);
    bank.clearance = -0.001;
    EXPECT_THROW(Bank(drum(), bank), std::invalid_argument);
    bank = model_bank(45.0, 1.0);
    bank.segments = 50;
    EXPECT_THROW(Bank(drum(), bank), std::invalid_argument);
}

}  // namespace
}  // namespace cutterflow::geometry
