#include <gtest/gtest.h>

#include "geometry/surface/soundness.hpp"
#include "geometry/tests/solids.hpp"

namespace cutterflow::geometry {
namespace {

using testing::box;
using testing::tetrahedron;
using testing::unit_cube;

std::string message_of(const SoundnessReport& report) {
    try {
        require_sound(report, "head.stl");
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

TEST(Soundness, a_cube_and_a_tetrahedron_are_sound) {
    for (const TriangleSurface& surface : {unit_cube(), tetrahedron()}) {
        const SoundnessReport report = inspect_surface(surface);
        EXPECT_TRUE(report.sound()) << message_of(report);
        EXPECT_TRUE(report.closed());
        EXPECT_TRUE(report.outward());
        EXPECT_EQ(report.components.size(), 1u);
        EXPECT_EQ(report.self_intersections.count, 0u);
        EXPECT_NO_THROW(require_sound(report, "x"));
    }
}

TEST(Soundness, an_open_box_is_named_with_its_border) {
    TriangleSurface open = unit_cube();
    open.triangles.resize(10);  // without the lid z = 1
    const SoundnessReport report = inspect_surface(open);
    EXPECT_FALSE(report.closed());
    EXPECT_EQ(report.border_edges.count, 4u);
    for (const Vec3& place : report.border_edges.places) EXPECT_DOUBLE_EQ(place.z(), 1.0);
    const std::string message = message_of(report);
    EXPECT_NE(message.find("head.stl: 4 open edge(s), the first at ("), std::string::npos) << message;
    EXPECT_NE(message.find("must be closed"), std::string::npos) << message;
}

TEST(Soundness, a_slit_of_a_micron_is_open) {
    TriangleSurface slit = unit_cube();
    const auto moved = static_cast<std::uint32_t>(slit.points.size());
    slit.points.push_back(slit.points[7] + Vec3(1e-6, 0.0, 0.0));
    slit.triangles[11] = {4, moved, 6};
    const SoundnessReport report = inspect_surface(slit);
    EXPECT_FALSE(report.closed());
    EXPECT_EQ(report.border_edges.count, 4u);
}

TEST(Soundness, one_flipped_face_is_found) {
    TriangleSurface flipped = unit_cube();
    std::swap(flipped.triangles[5][0], flipped.triangles[5][1]);
    const SoundnessReport report = inspect_surface(flipped);
    EXPECT_TRUE(report.closed());
    EXPECT_FALSE(report.consistently_oriented());
    EXPECT_EQ(report.misoriented_edges.count, 3u);
    EXPECT_NE(message_of(report).find("opposite orientation"), std::string::npos);
}

TEST(Soundness, a_cube_inside_out_is_refused_with_its_volume) {
    TriangleSurface inside_out = unit_cube();
    for (Triangle& t : inside_out.triangles) std::swap(t[0], t[1]);
    const SoundnessReport report = inspect_surface(inside_out);
    EXPECT_TRUE(report.closed());
    EXPECT_TRUE(report.consistently_oriented());
    EXPECT_FALSE(report.outward());
    EXPECT_NE(message_of(report).find("is inside out: its volume is -1 m3"), std::string::npos) << message_of(report);
}

TEST(Soundness, two_cubes_apart_are_two_components) {
    const TriangleSurface two = joined({unit_cube(), box(Vec3(2.0, 0.0, 0.0), Vec3(4.0, 1.0, 1.0))});
    const SoundnessReport report = inspect_surface(two);
    EXPECT_TRUE(report.sound());
    ASSERT_EQ(report.components.size(), 2u);
    EXPECT_NEAR(report.components[0].volume, 2.0, 1e-14);
    EXPECT_NEAR(report.components[1].volume, 1.0, 1e-14);
}

TEST(Soundness, one_of_two_cubes_inside_out_is_found_although_the_total_volume_is_positive) {
    TriangleSurface small = unit_cube();
    for (Triangle& t : small.triangles) std::swap(t[0], t[1]);
    const SoundnessReport report = inspect_surface(joined({small, box(Vec3(2.0, 0.0, 0.0), Vec3(4.0, 1.0, 1.0))}));
    EXPECT_GT(report.volume, 0.0);
    EXPECT_FALSE(report.outward());
    EXPECT_NE(message_of(report).find("component 2 of 2 (12 triangles) is inside out"), std::string::npos) << message_of(report);
}

TEST(Soundness, overlapping_cubes_intersect_where_they_overlap) {
    const TriangleSurface two = joined({unit_cube(), box(Vec3(0.6, 0.3, 0.2), Vec3(1.7, 0.8, 0.9))});
    const SoundnessReport report = inspect_surface(two);
    EXPECT_TRUE(report.closed());
    EXPECT_GT(report.self_intersections.count, 0u);
    EXPECT_FALSE(report.sound());
    // The second cube's sides pass through the face x = 1: triangles 2 and 3 of the first.
    EXPECT_EQ(report.self_intersections.triangles.front(), 2u);
    EXPECT_NE(message_of(report).find("pair(s) of triangles intersect"), std::string::npos);
}

TEST(Soundness, a_spike_through_its_own_solid_is_a_self_intersection) {
    TriangleSurface spiked = unit_cube();
    spiked.points[7] = Vec3(-0.5, 0.4, 0.3);  // pulled through the face x = 0
    const SoundnessReport report = inspect_surface(spiked);
    EXPECT_TRUE(report.closed());
    EXPECT_GT(report.self_intersections.count, 0u);
}

TEST(Soundness, a_fold_onto_a_neighbour_is_a_self_intersection) {
    // Two coplanar triangles on the same side of their common edge.
    const TriangleSurface folded{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.2, 1, 0), Vec3(0.6, 0.5, 0)}, {{0, 1, 2}, {1, 0, 3}}};
    EXPECT_EQ(inspect_surface(folded).self_intersections.count, 1u);
    TriangleSurface flat = folded;
    flat.points[3] = Vec3(0.6, -0.5, 0.0);
    EXPECT_EQ(inspect_surface(flat).self_intersections.count, 0u);
}

TEST(Soundness, cubes_that_share_an_edge_or_a_point_are_no_manifold) {
    const SoundnessReport edge = inspect_surface(welded(joined({unit_cube(), box(Vec3(1.0, 1.0, 0.0), Vec3(2.0, 2.0, 1.0))})));
    EXPECT_EQ(edge.non_manifold_edges.count, 1u);
    EXPECT_FALSE(edge.sound());
    const SoundnessReport point = inspect_surface(welded(joined({unit_cube(), box(Vec3(1.0, 1.0, 1.0), Vec3(2.0, 2.0, 2.0))})));
    EXPECT_EQ(point.non_manifold_edges.count, 0u);
    EXPECT_EQ(point.non_manifold_points.count, 1u);
    EXPECT_EQ(point.non_manifold_points.places.front(), Vec3(1.0, 1.0, 1.0));
}

TEST(Soundness, duplicates_and_triangles_without_area_are_counted) {
    TriangleSurface bad = unit_cube();
    bad.triangles.push_back(bad.triangles[3]);
    bad.triangles.push_back({0, 1, 1});
    bad.points.push_back(Vec3(0.5, 0.0, 0.0));
    bad.triangles.push_back({0, 8, 1});
    const SoundnessReport report = inspect_surface(bad);
    EXPECT_EQ(report.duplicate_triangles.count, 1u);
    EXPECT_EQ(report.degenerate_triangles.count, 2u);
}

TEST(Soundness, every_defect_of_a_surface_is_named_at_once) {
    TriangleSurface bad = unit_cube();
    bad.triangles.resize(10);
    std::swap(bad.triangles[0][0], bad.triangles[0][1]);
    try {
        require_sound(inspect_surface(bad), "head.stl");
        FAIL();
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().size(), 2u) << error.what();
    }
}

}  // namespace
}  // namespace cutterflow::geometry
