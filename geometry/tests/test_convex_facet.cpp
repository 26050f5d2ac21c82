/// Plane polygons cut by upright planes and made into triangles.
#include "geometry/soil/convex_facet.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/surface/contact_surface.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_degree = k_pi / 180.0;

double area(const Facet& facet) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 2; k < facet.size(); ++k) sum += 0.5 * (facet[k - 1] - facet[0]).cross(facet[k] - facet[0]);
    return sum.norm();
}

/// Leaning by 45 degrees: 1 m along x, height and y from 0 to 1 m.
const Facet k_leaning{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 1}};

TEST(ConvexFacet, is_clipped_by_an_upright_plane) {
    const Facet part = clipped(k_leaning, {0.0, 0.25}, {0.0, -1.0});
    EXPECT_NEAR(area(part), 0.25 * std::sqrt(2.0), 1e-15);
    EXPECT_TRUE(clipped(k_leaning, {0.0, -0.1}, {0.0, -1.0}).empty());
}

TEST(ConvexFacet, less_a_prism_is_the_rest) {
    const PlanarLoop prism{{0.25, 0.5}, {0.75, 0.5}, {0.75, 2.0}, {0.25, 2.0}};
    double left = 0.0;
    for (const Facet& part : outside(k_leaning, prism, 1e-6)) left += area(part);
    EXPECT_NEAR(left, 0.75 * std::sqrt(2.0), 1e-14);
    // A prism that only touches takes nothing.
    const auto whole = outside(k_leaning, moved(prism, {0.0, 0.5}), 1e-6);
    ASSERT_EQ(whole.size(), 1u);
    EXPECT_EQ(whole.front().size(), 4u);
}

TEST(ConvexFacet, has_the_width_of_its_narrowest_strip) {
    EXPECT_NEAR(width_of(k_leaning), 1.0, 1e-15);
    EXPECT_NEAR(width_of({{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}), 12.0 / 5.0, 1e-15);
    EXPECT_EQ(width_of({{0, 0, 0}, {3, 0, 0}}), 0.0);
}

TEST(ConvexFacet, becomes_triangles_within_bounds_however_thin_it_is) {
    const std::vector<Facet> facets{{{0, 0, 0}, {2.4, 0, 0}, {2.4, 0.002, 0}, {0, 0.001, 0}},                    // a strip
                                    {{0, 0, 0}, {1, 0, 0}, {1, 0.004, 0}},                                       // a needle
                                    {{0, 0, 0}, {0.3, 0, 0}, {0.3, 0.2, 0}, {0.0005, 0.2, 0}, {0, 0.1996, 0}}};  // a cut corner
    for (const Facet& facet : facets) {
        TriangleSurface tiles;
        const TileBounds bounds{2e-4, 0.1, 5.0 * k_degree};
        add_tiles(facet, bounds, tiles);
        EXPECT_GE(smallest_angle_of(tiles), bounds.smallest_angle);
        Vec3 sum = Vec3::Zero();
        for (const Triangle& triangle : tiles.triangles) {
            sum += area_vector(tiles, triangle);
            EXPECT_GT(area_vector(tiles, triangle).z(), 0.0);
            EXPECT_LE((tiles.points[triangle[0]] - tiles.points[triangle[1]]).norm(), 0.1 + 1e-12);
        }
        EXPECT_NEAR(sum.z() / area(facet), 1.0, 0.02);
    }
    TriangleSurface none;
    add_tiles({{0, 0, 0}, {1, 0, 0}, {1, 1e-4, 0}}, {2e-4, 0.1, 5.0 * k_degree}, none);
    EXPECT_TRUE(none.triangles.empty());
}

}  // namespace
}  // namespace cutterflow::geometry
