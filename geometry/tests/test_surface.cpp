#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/surface/revolve.hpp"
#include "geometry/tests/solids.hpp"

namespace cutterflow::geometry {
namespace {

using testing::box;
using testing::tetrahedron;

TEST(Surface, measures_a_box) {
    const TriangleSurface surface = box(Vec3(1.0, 2.0, 3.0), Vec3(3.0, 5.0, 7.0));
    EXPECT_NEAR(volume_of(surface), 24.0, 1e-12);
    EXPECT_NEAR(area_of(surface), 2.0 * (6.0 + 8.0 + 12.0), 1e-12);
    EXPECT_EQ(bounds_of(surface).min, Vec3(1.0, 2.0, 3.0));
    EXPECT_EQ(bounds_of(surface).max, Vec3(3.0, 5.0, 7.0));
}

TEST(Surface, a_box_shows_its_faces_by_their_cosines) {
    const TriangleSurface surface = box(Vec3(1.0, 2.0, 3.0), Vec3(3.0, 5.0, 7.0));
    EXPECT_NEAR(area_seen_along(surface, Vec3(0.0, 0.0, -1.0)), 6.0, 1e-12);
    EXPECT_NEAR(area_seen_along(surface, Vec3(0.6, 0.0, 0.8)), 0.6 * 12.0 + 0.8 * 6.0, 1e-12);
}

TEST(Surface, mass_properties_of_a_box_are_those_of_mechanics) {
    const MassProperties mass = mass_properties(box(Vec3(1.0, 2.0, 3.0), Vec3(3.0, 5.0, 7.0)));
    EXPECT_NEAR(mass.volume, 24.0, 1e-12);
    EXPECT_NEAR((mass.centroid - Vec3(2.0, 3.5, 5.0)).norm(), 0.0, 1e-12);
    Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
    expected.diagonal() << 24.0 / 12.0 * (9.0 + 16.0), 24.0 / 12.0 * (4.0 + 16.0), 24.0 / 12.0 * (4.0 + 9.0);
    EXPECT_NEAR((mass.inertia - expected).norm(), 0.0, 1e-10);
}

TEST(Surface, volume_of_a_tetrahedron_does_not_depend_on_where_it_lies) {
    const Eigen::Affine3d far(Eigen::Translation3d(1e4, -2e4, 3e4));
    EXPECT_NEAR(volume_of(tetrahedron()), 1.0 / 6.0, 1e-14);
    EXPECT_NEAR(volume_of(transformed(tetrahedron(), far)), 1.0 / 6.0, 1e-9);
}

TEST(Surface, a_reflected_surface_still_faces_outwards) {
    const TriangleSurface mirrored = transformed(tetrahedron(), Eigen::Affine3d(Eigen::Scaling(-1.0, 1.0, 1.0)));
    EXPECT_NEAR(volume_of(mirrored), 1.0 / 6.0, 1e-14);
}

TEST(Surface, welding_joins_equal_points_and_drops_unused_ones) {
    TriangleSurface soup;
    const TriangleSurface cube = testing::unit_cube();
    for (const Triangle& t : cube.triangles) {
        const auto first = static_cast<std::uint32_t>(soup.points.size());
        for (const std::uint32_t corner : t) soup.points.push_back(cube.points[corner]);
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    soup.points.emplace_back(9.0, 9.0, 9.0);
    const TriangleSurface joined_cube = welded(soup);
    EXPECT_EQ(joined_cube.points.size(), 8u);
    EXPECT_EQ(joined_cube.triangles.size(), 12u);
    EXPECT_NEAR(volume_of(joined_cube), 1.0, 1e-14);
}

TEST(Revolve, solids_have_the_volume_of_their_inscribed_polygon) {
    constexpr std::size_t n = 40;
    const double polygon = 0.5 * n * std::sin(2.0 * k_pi / n);  // area of the regular n-gon of radius 1
    const TriangleSurface cylinder = solid_of_revolution({{0.0, 0.0}, {2.0, 0.0}, {2.0, 3.0}, {0.0, 3.0}}, n, 0.5);
    EXPECT_NEAR(volume_of(cylinder), polygon * 4.0 * 3.0, 1e-10);
    const TriangleSurface cone = solid_of_revolution({{0.0, 0.0}, {2.0, 3.0}, {0.0, 3.0}}, n, 0.5);
    EXPECT_NEAR(volume_of(cone), polygon * 4.0 * 3.0 / 3.0, 1e-10);
    const TriangleSurface annulus = solid_of_revolution({{1.0, 0.0}, {2.0, 0.0}, {2.0, 3.0}, {1.0, 3.0}}, n, 0.5);
    EXPECT_NEAR(volume_of(annulus), polygon * 3.0 * 3.0, 1e-10);
}

TEST(Revolve, a_section_in_the_other_sense_gives_the_same_solid) {
    const TriangleSurface up = solid_of_revolution({{0.0, 0.0}, {2.0, 3.0}, {0.0, 3.0}}, 16, 0.5);
    const TriangleSurface down = solid_of_revolution({{0.0, 3.0}, {2.0, 3.0}, {0.0, 0.0}}, 16, 0.5);
    EXPECT_GT(volume_of(up), 0.0);
    EXPECT_NEAR(volume_of(up), volume_of(down), 1e-12);
}

}  // namespace
}  // namespace cutterflow::geometry
