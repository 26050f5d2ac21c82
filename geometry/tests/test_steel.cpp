#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/cgal/exact_solid.hpp"
#include "geometry/cgal/planar_region.hpp"
#include "geometry/cgal/remesh.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/head/head.hpp"
#include "geometry/head/stationary_steel.hpp"
#include "geometry/surface/soundness.hpp"
#include "geometry/tests/solids.hpp"

namespace cutterflow::geometry {
namespace {

using testing::box;
using testing::model_crown;
using testing::unit_cube;

const TriangleSurface& model_cutter() {
    static const TriangleSurface cutter = generate_crown_cutter(model_crown());
    return cutter;
}

double smallest_angle_deg(const TriangleSurface& surface) {
    double smallest = 180.0;
    for (const Triangle& t : surface.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 a = surface.points[t[(k + 1) % 3]] - surface.points[t[k]];
            const Vec3 b = surface.points[t[(k + 2) % 3]] - surface.points[t[k]];
            smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / k_pi);
        }
    return smallest;
}

TEST(ExactSolid, unions_of_boxes_have_exact_volumes) {
    ExactSolid solid(unit_cube());
    solid.unite(ExactSolid(box(Vec3(0.5, 0.25, 0.25), Vec3(2.0, 0.75, 0.75))));
    EXPECT_NEAR(volume_of(solid.surface()), 1.0 + 0.25, 1e-14);
    solid.unite(ExactSolid(box(Vec3(1.5, -1.0, 0.5), Vec3(1.7, 0.5, 1.5))));
    EXPECT_NEAR(volume_of(solid.surface()), 1.25 + 0.2 * (1.5 * 1.0 - 0.25 * 0.25), 1e-14);
    EXPECT_TRUE(inspect_surface(solid.surface()).sound());
}

TEST(ExactSolid, an_open_surface_is_refused) {
    TriangleSurface open = unit_cube();
    open.triangles.pop_back();
    EXPECT_THROW(ExactSolid{open}, CheckFailure);
}

TEST(PlanarRegion, a_square_with_a_square_hole_has_the_area_between_them) {
    const PlanarLoop outer{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
    const PlanarLoop hole{{1, 1}, {1, 2}, {3, 2}, {3, 1}};
    TriangleSurface flat;
    for (const PlanarLoop& loop : {outer, hole})
        for (const Eigen::Vector2d& p : loop) flat.points.emplace_back(p.x(), p.y(), 0.0);
    flat.triangles = triangulate_region({outer, hole});
    double upward = 0.0;
    for (const Triangle& t : flat.triangles) upward += area_vector(flat, t).z();
    EXPECT_NEAR(upward, 16.0 - 2.0, 1e-14);
    EXPECT_NEAR(area_of(flat), 16.0 - 2.0, 1e-14);
}

TEST(Remeshing, keeps_volume_and_edges_of_a_box) {
    const TriangleSurface fine = remeshed(box(Vec3::Zero(), Vec3(1.0, 0.5, 0.25)), 0.1, 35.0);
    EXPECT_GT(fine.triangles.size(), 200u);
    EXPECT_NEAR(volume_of(fine), 0.125, 1e-12);
    EXPECT_GT(smallest_angle_deg(fine), 15.0);
}

TEST(SolidSearch, tells_inside_from_outside_and_finds_the_nearest_face) {
    const SolidSearch search(unit_cube());
    EXPECT_TRUE(search.contains(Vec3(0.5, 0.5, 0.5)));
    EXPECT_FALSE(search.contains(Vec3(0.5, 0.5, 1.5)));
    const NearestPoint nearest = search.nearest(Vec3(0.3, 0.6, 1.5));
    EXPECT_NEAR(nearest.distance, 0.5, 1e-15);
    EXPECT_NEAR((nearest.point - Vec3(0.3, 0.6, 1.0)).norm(), 0.0, 1e-15);
    EXPECT_TRUE(nearest.triangle == 10u || nearest.triangle == 11u);  // the lid
}

TEST(CrownCutter, the_shipped_model_is_one_watertight_solid) {
    const SoundnessReport report = inspect_surface(model_cutter());
    EXPECT_TRUE(report.sound()) << defects_of(report, "model").front().text();
    EXPECT_EQ(report.components.size(), 1u);
    EXPECT_GE(report.triangles, 2000u);
    EXPECT_LE(report.triangles, 8000u);
    EXPECT_GT(smallest_angle_deg(model_cutter()), 5.0);
}

TEST(CrownCutter, the_shipped_model_has_the_sizes_of_its_file) {
    const Bounds bounds = bounds_of(model_cutter());
    EXPECT_NEAR(bounds.max.z(), 0.0, 1e-9);
    EXPECT_NEAR(bounds.min.z(), -0.485, 1e-4);
    double radius = 0.0;
    for (const Vec3& p : model_cutter().points) radius = std::max(radius, std::hypot(p.x(), p.y()));
    EXPECT_NEAR(radius, 0.40, 1e-6);
}

/// Integral [m3] of the thickness over the blade's sheet, from a blade of a hundredth of its thickness: thickness counts in proportion as
/// far as it is small beside the sheet's curvature.
double sheet_volume(CrownParameters p) {
    p.blade_thickness /= 100.0;
    p.blade_thickness_at_hub /= 100.0;
    return 100.0 * volume_of(crown_blade(p));
}

TEST(CrownCutter, a_blade_has_the_volume_of_its_sheet_times_its_thickness) {
    const CrownParameters p = model_crown();
    const TriangleSurface blade = crown_blade(p);
    EXPECT_TRUE(inspect_surface(blade).sound());
    EXPECT_NEAR(volume_of(blade) / sheet_volume(p), 1.0, 0.005);
    // The two faces of a strip of even thickness, with next to no rim.
    CrownParameters thin = p;
    thin.blade_thickness = thin.blade_thickness_at_hub = 1e-5;
    const TriangleSurface strip = crown_blade(thin);
    EXPECT_NEAR(volume_of(strip) / (0.5 * area_of(strip) * 1e-5), 1.0, 0.005);
}

TEST(CrownCutter, its_volume_lies_between_its_parts_alone_and_their_sum) {
    const CrownParameters p = model_crown();
    const double ring = k_pi * (p.ring_radius * p.ring_radius - p.ring_inner_radius * p.ring_inner_radius) * p.ring_height;
    const double cap = k_pi * p.hub_cap_height / 6.0 * (3.0 * p.hub_radius * p.hub_radius + p.hub_cap_height * p.hub_cap_height);
    const double hub = k_pi * p.hub_radius * p.hub_radius * p.hub_height + cap;
    const double blades = p.blade_count * volume_of(crown_blade(p));
    const double volume = volume_of(model_cutter());
    // A fifth of a blade at most is buried in ring and hub at each end.
    EXPECT_LT(volume, ring + hub + blades);
    EXPECT_GT(volume, ring + hub + 0.6 * blades);
}

TEST(CrownCutter, passages_between_the_blades_are_open) {
    // At mid height, on the blades' outer edge, a sphere of a fifth of the ring radius passes in each of the six passages.
    const CrownParameters p = model_crown();
    const SolidSearch steel(model_cutter());
    int open = 0;
    bool was_open = steel.nearest(Vec3(0.30, 0.0, -0.2)).distance > 0.04;
    for (int i = 1; i <= 720; ++i) {
        const double a = 2.0 * k_pi * i / 720.0;
        const Vec3 at(0.30 * std::cos(a), 0.30 * std::sin(a), -0.2);
        const bool is_open = !steel.contains(at) && steel.nearest(at).distance > 0.04;
        if (is_open && !was_open) ++open;
        was_open = is_open;
    }
    EXPECT_EQ(open, p.blade_count);
}

TEST(CrownCutter, positive_wrap_carries_rock_to_the_suction_side_for_positive_rotation_and_a_mirrored_head_for_negative) {
    const Carrying carrying = carrying_sense(model_cutter());
    EXPECT_EQ(carrying.sense, CarryingSense::positive);
    EXPECT_GT(carrying.measure, 0.1);
    const Carrying mirrored = carrying_sense(transformed(model_cutter(), Eigen::Affine3d(Eigen::Scaling(1.0, -1.0, 1.0))));
    EXPECT_EQ(mirrored.sense, CarryingSense::negative);
    EXPECT_NEAR(mirrored.measure, -carrying.measure, 1e-12);
    CrownParameters left = model_crown();
    left.blade_wrap = -left.blade_wrap;
    EXPECT_EQ(carrying_sense(generate_crown_cutter(left)).sense, CarryingSense::negative);
    CrownParameters straight = model_crown();
    straight.blade_wrap = 0.0;
    straight.blade_rake = 0.0;
    EXPECT_EQ(carrying_sense(generate_crown_cutter(straight)).sense, CarryingSense::none);
}

TEST(CrownCutter, nine_tenths_of_what_the_blades_sweep_is_swept_by_faces_that_look_to_the_suction_side) {
    // The definition by itself: at 1 rad/s a face of area A and outward normal n sweeps A (v . n); it pushes along n.
    const TriangleSurface& cutter = model_cutter();
    double lifted = 0.0;
    double swept = 0.0;
    for (const Triangle& t : cutter.triangles) {
        const Vec3 area = area_vector(cutter, t);
        const double sweep = Vec3::UnitZ().cross(centroid_of(cutter, t)).dot(area);
        if (sweep <= 0.0) continue;
        swept += sweep;
        if (area.z() > 0.0) lifted += sweep;
    }
    EXPECT_GT(lifted / swept, 0.9);
}

CrownParameters crown_with_picks() {
    CrownParameters p = model_crown();
    p.edge_length = 0.03;
    p.blade_count = 5;
    p.blade_thickness_at_hub = 0.03;
    p.picks_per_blade = 5;
    p.pick_length = 0.035;
    p.pick_width = 0.03;
    p.pick_lean = 0.4;
    return p;
}

TEST(CrownCutter, with_picks_and_a_thickness_profile_has_the_volume_of_its_parts_united_exactly) {
    const CrownParameters p = crown_with_picks();
    const TriangleSurface cutter = generate_crown_cutter(p);
    EXPECT_NEAR(volume_of(cutter) / volume_of(united_crown_parts(p)), 1.0, 0.005);
    const SoundnessReport report = inspect_surface(cutter);
    EXPECT_TRUE(report.sound());
    EXPECT_EQ(report.components.size(), 1u);
    const TriangleSurface blade = crown_blade(p);
    EXPECT_NEAR(volume_of(blade) / sheet_volume(p), 1.0, 0.005);
}

TEST(CrownCutter, picks_are_frusta_that_lean_as_far_as_asked) {
    const CrownParameters p = crown_with_picks();
    const std::vector<TriangleSurface> picks = crown_picks(p);
    ASSERT_EQ(picks.size(), 5u);
    const double height = p.pick_length + 0.8 * p.pick_width;
    for (const TriangleSurface& pick : picks) {
        EXPECT_NEAR(volume_of(pick), height / 3.0 * p.pick_width * p.pick_width * (1.0 + 0.5 + 0.25), 1e-12);
        const Vec3 root = 0.25 * (pick.points[0] + pick.points[1] + pick.points[2] + pick.points[3]);
        const Vec3 tip = 0.25 * (pick.points[4] + pick.points[5] + pick.points[6] + pick.points[7]);
        const Vec3 axis = (tip - root).normalized();
        const Vec3 foot = tip - p.pick_length * axis;
        const Vec3 ahead = Vec3::UnitZ().cross(foot).normalized();  // positive rotation: the head carries for it
        EXPECT_NEAR(std::asin(axis.dot(ahead)), p.pick_lean, 1e-9);
        EXPECT_GT(std::hypot(tip.x(), tip.y()) - tip.z(), std::hypot(root.x(), root.y()) - root.z()) << "outwards and down";
    }
    CrownParameters mirrored = p;
    mirrored.blade_wrap = -p.blade_wrap;
    const auto centre = [](const TriangleSurface& pick) { return mass_properties(pick).centroid; };
    for (std::size_t k = 0; k < picks.size(); ++k)
        EXPECT_NEAR((centre(crown_picks(mirrored)[k]) - centre(picks[k]).cwiseProduct(Vec3(1.0, -1.0, 1.0))).norm(), 0.0, 1e-12);
}

TEST(CrownCutter, the_manual_page_is_that_of_the_table) {
    EXPECT_EQ(read_file(std::filesystem::path(CUTTERFLOW_SOURCE_DIR) / "docs/user/crown_file.md"), crown_manual_page())
        << "build the target update_manual";
}

TEST(CrownCutter, picks_that_find_no_room_are_refused) {
    CrownParameters p = crown_with_picks();
    p.picks_per_blade = 30;
    try {
        generate_crown_cutter(p);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("picks.per_blade = 30"), std::string::npos) << error.what();
    }
}

TEST(CrownCutter, contradicting_sizes_are_all_named) {
    CrownParameters p = model_crown();
    p.ring_inner_radius = 0.5;
    p.hub_height = 0.6;
    try {
        generate_crown_cutter(p);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_GE(error.mistakes().size(), 2u);
        EXPECT_NE(std::string(error.what()).find("ring.inner_radius_m = 0.5"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("hub.height_m = 0.6"), std::string::npos) << error.what();
    }
}

TEST(CrownCutter, the_same_parameters_give_the_same_surface) {
    const TriangleSurface again = generate_crown_cutter(model_crown());
    EXPECT_EQ(again.triangles, model_cutter().triangles);
    EXPECT_EQ(again.points, model_cutter().points);
}

class CrownFamily : public ::testing::TestWithParam<int> {};

TEST_P(CrownFamily, other_blade_counts_and_sizes_are_sound_too) {
    CrownParameters p = model_crown();
    p.edge_length = 0.03;
    const double scale = GetParam() % 2 == 0 ? 0.3 : 4.0;
    for (double* length :
         {&p.ring_radius, &p.ring_inner_radius, &p.ring_height, &p.hub_radius, &p.hub_depth, &p.hub_height, &p.hub_cap_height,
          &p.blade_thickness, &p.blade_thickness_at_hub, &p.blade_depth_at_ring, &p.blade_depth_at_hub, &p.edge_length})
        *length *= scale;
    p.blade_count = GetParam();
    p.blade_wrap = (GetParam() - 6) * 0.5;
    p.contour_exponent = 1.4 + 0.2 * GetParam();
    const SoundnessReport report = inspect_surface(generate_crown_cutter(p));
    EXPECT_TRUE(report.sound());
    EXPECT_EQ(report.components.size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(Blades, CrownFamily, ::testing::Values(4, 5, 7, 8));

TEST(CrownCutter, a_blade_that_crosses_itself_is_refused) {
    CrownParameters p = model_crown();
    p.blade_depth_at_hub = 0.45;
    p.blade_wrap = 2.0;
    p.blade_rake = 0.7;
    EXPECT_THROW(generate_crown_cutter(p), UserError);
}

StationarySteelParameters model_steel() {
    StationarySteelParameters p;
    p.plate_radius = 0.4;
    p.gap = 0.03;
    p.plate_thickness = 0.03;
    p.mouth = {0.10, 0.22, 0.5};
    p.pipe_wall = 0.02;
    p.pipe_top = 0.535;
    p.edge_length = 0.022;
    return p;
}

const StationarySteel& generated_steel() {
    static const StationarySteel steel = generate_stationary_steel(model_steel());
    return steel;
}

TEST(StationarySteel, backplate_and_pipe_make_one_watertight_solid_of_known_volume) {
    const StationarySteel& steel = generated_steel();
    const SoundnessReport report = inspect_surface(steel.solid());
    EXPECT_TRUE(report.sound());
    EXPECT_EQ(report.components.size(), 1u);
    const double plate = k_pi * (0.4 * 0.4 - 0.1 * 0.1) * 0.03;
    const double pipe = k_pi * (0.12 * 0.12 - 0.1 * 0.1) * (0.535 - 0.06);
    EXPECT_NEAR(report.volume / (plate + pipe), 1.0, 0.005);
    EXPECT_GT(smallest_angle_deg(steel.solid()), 5.0);
}

TEST(StationarySteel, its_parts_meet_in_the_mouths_lip_and_where_the_pipe_leaves_the_plate) {
    const StationarySteel& steel = generated_steel();
    const Vec3 centre(0.22 * std::cos(0.5), 0.22 * std::sin(0.5), 0.0);
    for (const TriangleSurface* part : {&steel.backplate, &steel.suction_pipe}) {
        const SoundnessReport report = inspect_surface(*part);
        EXPECT_EQ(report.components.size(), 1u);
        EXPECT_GT(report.border_edges.count, 40u);
        for (const Vec3& place : report.border_edges.places) {
            const double r = (place - centre).head<2>().norm();
            const bool lip = std::abs(place.z() - 0.03) < 1e-9 && std::abs(r - 0.10) < 1e-3;
            const bool root = std::abs(place.z() - 0.06) < 1e-9 && std::abs(r - 0.12) < 1e-3;
            EXPECT_TRUE(lip || root) << place.transpose();
        }
    }
}

TEST(StationarySteel, the_pipe_opens_through_the_mouth_only) {
    const SolidSearch steel(generated_steel().solid());
    const Vec3 centre(0.22 * std::cos(0.5), 0.22 * std::sin(0.5), 0.0);
    for (double z = 0.0; z < 0.5; z += 0.01) EXPECT_FALSE(steel.contains(centre + z * Vec3::UnitZ())) << z;
    // Around the bore there is steel at every height and azimuth.
    for (double z = 0.031; z < 0.53; z += 0.02)
        for (int k = 0; k < 36; ++k) {
            const double a = k_pi / 18.0 * k;
            EXPECT_TRUE(steel.contains(centre + Vec3(0.11 * std::cos(a), 0.11 * std::sin(a), z))) << z << ' ' << a;
        }
    EXPECT_TRUE(steel.contains(Vec3(-0.3, 0.1, 0.045)));
    EXPECT_FALSE(steel.contains(Vec3(-0.3, 0.1, 0.029)));
}

TEST(StationarySteel, its_cylinders_hold_the_points_that_its_surface_holds) {
    const SolidSearch steel(generated_steel().solid());
    std::mt19937 random(7);
    std::uniform_real_distribution<double> across(-0.5, 0.5), along(-0.05, 0.6);
    int inside = 0, outside = 0;
    for (int k = 0; k < 6000; ++k) {
        const Vec3 point(across(random), across(random), along(random));
        if (steel.nearest(point).distance < 2e-3) continue;  // the surface's circles are polygons
        const bool in_steel = steel.contains(point);
        EXPECT_EQ(is_in_stationary_steel(model_steel(), point), in_steel) << point.transpose();
        ++(in_steel ? inside : outside);
    }
    EXPECT_GT(inside, 100);
    EXPECT_GT(outside, 1000);
}

TEST(StationarySteel, a_mouth_outside_the_backplate_is_refused) {
    StationarySteelParameters p = model_steel();
    p.mouth.offset = 0.35;
    EXPECT_THROW(generate_stationary_steel(p), UserError);
}

}  // namespace
}  // namespace cutterflow::geometry
