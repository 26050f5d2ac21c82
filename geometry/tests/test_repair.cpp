#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "geometry/cgal/arrangement.hpp"
#include "geometry/cgal/exact_solid.hpp"
#include "geometry/cgal/self_intersections.hpp"
#include "geometry/repair/holes.hpp"
#include "geometry/repair/orientation.hpp"
#include "geometry/repair/outer_boundary.hpp"
#include "geometry/repair/repair.hpp"
#include "geometry/repair/seams.hpp"
#include "geometry/repair/winding.hpp"
#include "geometry/tests/solids.hpp"

namespace cutterflow::geometry::repair {
namespace {

using cutterflow::geometry::testing::box;
using cutterflow::geometry::testing::unit_cube;

TracedSurface traced(const TriangleSurface& surface) {
    TracedSurface result{surface, {}};
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) result.source.push_back(static_cast<std::int64_t>(t));
    return result;
}

void flip(Triangle& t) {
    std::swap(t[1], t[2]);
}

RepairOutcome repaired(const TriangleSurface& surface) {
    return repair_surface(surface, default_limits(surface), "head.stl");
}

const RepairStep& step(const RepairOutcome& outcome, const std::string& name) {
    const auto found = std::find_if(outcome.steps.begin(), outcome.steps.end(), [&](const RepairStep& s) { return s.name == name; });
    if (found == outcome.steps.end()) throw std::runtime_error("no step " + name);
    return *found;
}

void expect_repaired(const RepairOutcome& outcome, double volume, double tolerance = 1e-6) {
    ASSERT_TRUE(outcome.repaired()) << outcome.refusals.front().text();
    EXPECT_TRUE(outcome.after.sound());
    EXPECT_NEAR(outcome.after.volume, volume, tolerance * volume);
}

void expect_refused(const RepairOutcome& outcome, const std::string& words) {
    ASSERT_FALSE(outcome.repaired());
    std::string text;
    for (const Mistake& mistake : outcome.refusals) text += mistake.text() + "\n";
    EXPECT_NE(text.find(words), std::string::npos) << text;
    EXPECT_FALSE(outcome.bad_faces.faces.surface.triangles.empty());
    EXPECT_EQ(outcome.bad_faces.faces.source.size(), outcome.bad_faces.faces.surface.triangles.size());
}

TEST(Welding, joins_points_within_the_distance_and_no_others) {
    TriangleSurface torn;
    for (const Triangle& t : unit_cube().triangles) {
        const auto first = static_cast<std::uint32_t>(torn.points.size());
        for (const std::uint32_t corner : t)
            torn.points.push_back(unit_cube().points[corner] + Vec3(1e-6, 0, 0) * static_cast<double>(first % 2));
        torn.triangles.push_back({first, first + 1, first + 2});
    }
    const Stepped welded_surface = weld_points(traced(torn), 1e-5);
    EXPECT_EQ(welded_surface.count, 36u - 8u);
    EXPECT_EQ(welded_surface.traced.surface.points.size(), 8u);
    EXPECT_GT(weld_points(traced(torn), 1e-7).traced.surface.points.size(), 8u);
    // A chain of points, each within the distance of the next, does not collapse.
    TriangleSurface chain{{Vec3(0, 0, 0), Vec3(0.8, 0, 0), Vec3(1.6, 0, 0), Vec3(0, 9, 0)}, {{0, 1, 3}, {1, 2, 3}}};
    EXPECT_EQ(weld_points(traced(chain), 1.0).traced.surface.points.size(), 3u);
}

TEST(Welding, of_twins_one_stays_but_a_wall_between_two_solids_goes_altogether) {
    TriangleSurface twice = unit_cube();
    twice.triangles.push_back(twice.triangles[4]);
    flip(twice.triangles.emplace_back(twice.triangles[7]));
    EXPECT_EQ(drop_duplicates(traced(twice)).count, 2u);
    EXPECT_EQ(drop_duplicates(traced(twice)).traced.surface.triangles.size(), 12u);
    const TriangleSurface beside = welded(joined({unit_cube(), box(Vec3(1, 0, 0), Vec3(2, 1, 1))}));
    const Stepped hollow = drop_duplicates(traced(beside));
    EXPECT_EQ(hollow.count, 4u);
    const SoundnessReport report = inspect_surface(hollow.traced.surface);
    EXPECT_TRUE(report.sound());
    EXPECT_NEAR(report.volume, 2.0, 1e-12);
    TriangleSurface all_twice = joined({unit_cube(), unit_cube()});
    for (std::size_t t = 12; t < 24; ++t) flip(all_twice.triangles[t]);
    const Stepped one = drop_duplicates(traced(welded(all_twice)));
    EXPECT_EQ(one.count, 12u);
    EXPECT_TRUE(inspect_surface(one.traced.surface).closed());
}

TEST(Seams, a_t_junction_is_closed_by_dividing_the_long_side) {
    TriangleSurface surface = unit_cube();
    surface.points.emplace_back(0.5, 0.0, 0.0);
    // Triangle {0, 1, 5} has the side from point 0 to point 1; its neighbour {0, 3, 1} keeps it whole.
    surface.triangles[4] = {0, 8, 5};
    surface.triangles.push_back({8, 1, 5});
    EXPECT_EQ(inspect_surface(surface).border_edges.count, 3u);
    const Stepped joined_seams = join_seams(traced(surface), 1e-6);
    EXPECT_EQ(joined_seams.count, 1u);
    EXPECT_TRUE(inspect_surface(joined_seams.traced.surface).sound());
    EXPECT_EQ(joined_seams.traced.source.back(), 9) << "the divided triangle's pieces know their source";
}

TEST(HangingSheets, a_fin_goes_and_its_solid_stays) {
    TriangleSurface finned = unit_cube();
    finned.points.emplace_back(-1.0, -1.0, 0.5);
    finned.triangles.push_back({0, 4, 8});
    const Stepped bare = drop_hanging_sheets(traced(finned));
    EXPECT_EQ(bare.count, 1u);
    EXPECT_TRUE(inspect_surface(bare.traced.surface).sound());
}

TEST(Orientation, the_larger_part_wins_and_closed_shells_turn_outwards) {
    TriangleSurface some = unit_cube();
    for (const std::size_t t : {1u, 5u, 6u}) flip(some.triangles[t]);
    const Stepped oriented = orient_consistently(traced(some));
    EXPECT_EQ(oriented.count, 3u);
    EXPECT_TRUE(inspect_surface(oriented.traced.surface).sound());
    TriangleSurface all = unit_cube();
    for (Triangle& t : all.triangles) flip(t);
    EXPECT_EQ(orient_consistently(traced(all)).count, 0u);
    EXPECT_EQ(orient_outwards(traced(all)).count, 12u);
    // A cavity stays as it is.
    TriangleSurface inner = box(Vec3::Constant(0.4), Vec3::Constant(0.6));
    for (Triangle& t : inner.triangles) flip(t);
    EXPECT_EQ(orient_outwards(traced(joined({unit_cube(), inner}))).count, 0u);
}

TEST(Holes, have_their_size_and_place_and_are_patched) {
    TriangleSurface open = unit_cube();
    open.triangles.resize(10);  // without the lid z = 1
    const std::vector<Hole> holes = find_holes(open);
    ASSERT_EQ(holes.size(), 1u);
    EXPECT_EQ(holes[0].points.size(), 4u);
    EXPECT_DOUBLE_EQ(holes[0].size, 1.0);
    EXPECT_NEAR((holes[0].middle - Vec3(0.5, 0.5, 1.0)).norm(), 0.0, 1e-14);
    EXPECT_NEAR(enclosed_volume(open), 1.0, 1e-14) << "the hole is plane: the cone on its middle closes it exactly";
    const Filled filled = fill_holes(traced(open), holes);
    EXPECT_NEAR(filled.area, 1.0, 1e-14);
    EXPECT_NEAR(filled.uncertain_volume, 1.0 / 6.0, 1e-14);
    EXPECT_TRUE(inspect_surface(filled.traced.surface).sound());
    EXPECT_EQ(filled.traced.source.back(), k_added);
}

TEST(Winding, solid_angles_of_a_closed_surface_sum_to_one_inside_and_none_outside) {
    EXPECT_NEAR(winding_number(unit_cube(), Vec3(0.3, 0.6, 0.2)), 1.0, 1e-14);
    EXPECT_NEAR(winding_number(unit_cube(), Vec3(1.3, 0.6, 0.2)), 0.0, 1e-14);
    // An octant of the sphere of directions.
    EXPECT_NEAR(solid_angle_share(Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), Vec3::Zero()), 0.125, 1e-15);
    TriangleSurface open = unit_cube();
    open.triangles.resize(10);
    EXPECT_NEAR(winding_number(open, Vec3::Constant(0.5)), 5.0 / 6.0, 1e-14) << "each face of a cube is a sixth";
}

TEST(Arrangement, facets_cover_the_triangles_in_their_sense) {
    const TriangleSurface two = joined({unit_cube(), box(Vec3(0.6, 0.3, 0.2), Vec3(1.7, 0.8, 0.9))});
    const Arrangement arrangement = arrange(two, find_self_intersections(two));
    TriangleSurface facets{arrangement.points, {}};
    for (const Facet& facet : arrangement.facets) {
        EXPECT_EQ(std::abs(facet.multiplicity), 1);
        facets.triangles.push_back(facet.corners);
        if (facet.multiplicity < 0) flip(facets.triangles.back());
    }
    EXPECT_GT(facets.triangles.size(), two.triangles.size());
    EXPECT_NEAR(area_of(facets), area_of(two), 1e-12);
    EXPECT_NEAR(volume_of(facets), volume_of(two), 1e-12);
}

TEST(Arrangement, what_overlaps_in_a_plane_becomes_one_facet_with_its_multiplicity) {
    // Twice the face z = 0 of a unit cube, cut along either diagonal, and once in the opposite sense.
    const TriangleSurface flat{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}};
    const Arrangement arrangement = arrange(flat, find_self_intersections(flat));
    double area = 0.0;
    TriangleSurface facets{arrangement.points, {}};
    for (const Facet& facet : arrangement.facets) {
        EXPECT_EQ(facet.multiplicity, 2);
        area += area_vector(facets, facet.corners).norm();
    }
    EXPECT_EQ(arrangement.facets.size(), 4u);
    EXPECT_NEAR(area, 1.0, 1e-15);
}

TEST(OuterBoundary, of_overlapping_boxes_is_their_union) {
    const TriangleSurface a = unit_cube(), b = box(Vec3(0.6, 0.3, 0.2), Vec3(1.7, 0.8, 0.9));
    const Stepped boundary = outer_boundary(traced(joined({a, b})));
    EXPECT_NEAR(volume_of(boundary.traced.surface), 1.0 + 1.1 * 0.5 * 0.7 - 0.4 * 0.5 * 0.7, 1e-12);
    EXPECT_TRUE(inspect_surface(welded(boundary.traced.surface)).sound());
    // Independent: corefinement in exact arithmetic.
    ExactSolid solid(a);
    solid.unite(ExactSolid(b));
    EXPECT_NEAR(area_of(boundary.traced.surface), area_of(solid.surface()), 1e-12);
}

TEST(OuterBoundary, flush_boxes_nested_boxes_and_inner_walls_leave_one_solid) {
    const Stepped flush = outer_boundary(traced(welded(joined({unit_cube(), box(Vec3(0.5, 0, 0), Vec3(2, 1, 1))}))));
    EXPECT_NEAR(volume_of(flush.traced.surface), 2.0, 1e-12);
    EXPECT_TRUE(inspect_surface(flush.traced.surface).sound());
    const Stepped nested = outer_boundary(traced(joined({unit_cube(), box(Vec3::Constant(0.3), Vec3::Constant(0.6))})));
    EXPECT_EQ(nested.traced.surface.triangles.size(), 12u);
    TriangleSurface walled = unit_cube();
    walled.triangles.push_back({0, 3, 7});  // from edge to edge, along the diagonals of bottom and top
    walled.triangles.push_back({0, 7, 4});
    const Stepped bare = outer_boundary(traced(walled));
    EXPECT_EQ(bare.traced.surface.triangles.size(), 12u);
    EXPECT_NEAR(volume_of(bare.traced.surface), 1.0, 1e-12);
}

TEST(Repair, a_sound_surface_is_left_alone) {
    const RepairOutcome outcome = repaired(unit_cube());
    expect_repaired(outcome, 1.0, 1e-14);
    EXPECT_EQ(outcome.after.triangles, 12u);
    for (const RepairStep& s : outcome.steps) {
        EXPECT_EQ(s.count, s.name == "unite shells" ? 1u : 0u) << s.name;
        EXPECT_EQ(s.volume_change, 0.0) << s.name;
        EXPECT_EQ(s.area_change, 0.0) << s.name;
    }
}

TEST(Repair, is_idempotent) {
    TriangleSurface damaged = joined({unit_cube(), transformed(box(Vec3(0.6, 0.3, 0.2), Vec3(1.7, 0.8, 0.9)),
                                                               Eigen::Affine3d(Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized())))});
    flip(damaged.triangles[2]);
    const RepairOutcome once = repaired(damaged);
    ASSERT_TRUE(once.repaired()) << once.refusals.front().text();
    const RepairOutcome twice = repaired(once.result.surface);
    ASSERT_TRUE(twice.repaired());
    EXPECT_EQ(twice.after.triangles, once.after.triangles);
    EXPECT_EQ(twice.after.volume, once.after.volume);
}

TEST(Repair, counts_what_it_does) {
    TriangleSurface damaged = unit_cube();
    flip(damaged.triangles[3]);
    damaged.triangles.push_back(damaged.triangles[8]);
    damaged.triangles.push_back({0, 1, 1});
    const RepairOutcome outcome = repaired(damaged);
    expect_repaired(outcome, 1.0);
    EXPECT_EQ(step(outcome, "drop flat triangles").count, 1u);
    EXPECT_EQ(step(outcome, "drop duplicates").count, 1u);
    EXPECT_NEAR(step(outcome, "drop duplicates").area_change, -0.5, 1e-12);
    EXPECT_EQ(step(outcome, "orient faces").count, 1u);
    EXPECT_NEAR(step(outcome, "orient faces").area_change, 0.0, 1e-12);
}

TEST(Repair, a_hole_above_the_limit_is_refused_with_its_size_place_and_faces) {
    TriangleSurface open = unit_cube();
    open.triangles.resize(10);
    const RepairOutcome outcome = repaired(open);
    expect_refused(outcome, "head.stl: a hole of 1 m with 4 edges about (0.5, 0.5, 1) m, at face");
    EXPECT_EQ(outcome.bad_faces.faces.surface.triangles.size(), 4u);
    for (const std::int64_t has : outcome.bad_faces.defects.at("hole")) EXPECT_EQ(has, 1);
    RepairLimits wide = default_limits(open);
    wide.hole_size = 1.0;
    expect_refused(repair_surface(open, wide, "head.stl"), "the patches of all holes make up 20 % of the area");
    wide.area_change = 0.3;
    expect_refused(repair_surface(open, wide, "head.stl"), "the patches of all holes leave 16.7 % of the volume uncertain");
    wide.volume_change = 0.2;
    expect_repaired(repair_surface(open, wide, "head.stl"), 1.0);
}

TEST(Repair, a_spike_through_the_far_side_is_refused_for_the_volume_it_changes) {
    TriangleSurface spiked = unit_cube();
    spiked.points[7] = Vec3(-0.5, 0.4, 0.3);
    expect_refused(repaired(spiked), "resolving the self-intersections changes the volume by");
}

TEST(Repair, solids_that_touch_along_an_edge_are_refused_and_those_that_touch_at_a_point_are_parted) {
    expect_refused(repaired(welded(joined({unit_cube(), box(Vec3(1, 1, 0), Vec3(2, 2, 1))}))), "edge(s) with more than two triangles");
    const RepairOutcome parted = repaired(welded(joined({unit_cube(), box(Vec3(1, 1, 1), Vec3(2, 2, 2))})));
    expect_repaired(parted, 2.0, 1e-4);
    EXPECT_EQ(parted.after.components.size(), 2u);
    EXPECT_EQ(parted.after.points, 16u);
}

TEST(Repair, cavities_are_filled_up_to_the_limit) {
    TriangleSurface inner = box(Vec3::Constant(0.4), Vec3::Constant(0.5));
    for (Triangle& t : inner.triangles) flip(t);
    const RepairOutcome small = repaired(joined({unit_cube(), inner}));
    expect_repaired(small, 1.0);
    EXPECT_EQ(step(small, "fill cavities").count, 1u);
    EXPECT_NEAR(step(small, "fill cavities").volume_change, 1e-3, 1e-9);
    TriangleSurface large = box(Vec3::Constant(0.2), Vec3::Constant(0.8));
    for (Triangle& t : large.triangles) flip(t);
    expect_refused(repaired(joined({unit_cube(), large})), "closed cavities have 27.6 % of the volume");
}

TEST(Repair, tilted_boxes_unite_to_the_volume_of_exact_corefinement_in_single_precision) {
    const TriangleSurface a = unit_cube();
    const TriangleSurface b =
        transformed(box(Vec3(0.2, 0.3, 0.2), Vec3(1.7, 0.8, 0.9)), Eigen::Affine3d(Eigen::AngleAxisd(0.3, Vec3(1, 0, 2).normalized())));
    ExactSolid solid(a);
    solid.unite(ExactSolid(b));
    const RepairOutcome outcome = repaired(joined({a, b}));
    expect_repaired(outcome, volume_of(solid.surface()), 1e-6);
    for (const Vec3& p : outcome.result.surface.points) EXPECT_EQ(p, Vec3(p.cast<float>().cast<double>()));
}

}  // namespace
}  // namespace cutterflow::geometry::repair
