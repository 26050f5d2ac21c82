#include "geometry/surface/contact_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/base/axis_frame.hpp"
#include "geometry/cgal/coarsen.hpp"
#include "geometry/head/stationary_steel.hpp"
#include "geometry/surface/revolve.hpp"
#include "geometry/surface/soundness.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_degree = k_pi / 180.0;

/// A drum of radius 0.2 m as CAD tessellates it: a strip for every degree or so, as long as the drum.
TriangleSurface drum_of_strips(std::size_t strips) {
    return solid_of_revolution({{0.0, -0.2}, {0.2, -0.2}, {0.2, 0.2}, {0.0, 0.2}}, strips, 1.0);
}

TEST(ContactSurface, has_few_good_triangles_where_cad_had_long_thin_ones) {
    const TriangleSurface drum = drum_of_strips(240);
    ASSERT_LT(smallest_angle_of(drum), 1.01 * k_degree);
    const ContactSurfaceBounds bounds{4e-4, 0.06};
    const ContactSurface made = contact_surface(drum, bounds);
    EXPECT_EQ(made.kept_because, "");
    EXPECT_LE(made.deviation, bounds.deviation);
    EXPECT_GT(made.smallest_angle, 8.0 * k_degree);
    EXPECT_TRUE(inspect_surface(made.surface).sound());
    // Thrice as many as rectangles of the longest edge and of a chord of that sagitta would need.
    const double chord = std::sqrt(8.0 * 0.2 * 0.6 * bounds.deviation);
    EXPECT_LT(static_cast<double>(made.surface.triangles.size()), 3.0 * 2.0 * area_of(drum) / (chord * bounds.edge_length));
    // Within the allowed shell on both sides.
    EXPECT_NEAR(volume_of(made.surface), volume_of(drum), area_of(drum) * bounds.deviation);
    // The rims stay sharp.
    const Bounds box = bounds_of(made.surface);
    EXPECT_NEAR(box.max.z(), 0.2, 1e-9);
    EXPECT_NEAR(box.min.z(), -0.2, 1e-9);
    EXPECT_NEAR(box.max.x(), 0.2, bounds.deviation);
}

TEST(ContactSurface, is_coarser_where_rock_is_larger) {
    const TriangleSurface drum = drum_of_strips(240);
    const std::size_t fine = contact_surface(drum, {2e-4, 0.1}).surface.triangles.size();
    const std::size_t coarse = contact_surface(drum, {8e-4, 0.1}).surface.triangles.size();
    EXPECT_LT(static_cast<double>(coarse), 0.7 * static_cast<double>(fine));
}

// Their points are those of one solid: rock is inside of it or not by both surfaces together.
TEST(ContactSurface, leaves_seams_between_walls_alone) {
    StationarySteelParameters p;
    p.plate_radius = 0.4;
    p.gap = 0.03;
    p.plate_thickness = 0.02;
    p.mouth = {0.1, 0.22, 0.3};
    p.pipe_wall = 0.01;
    p.pipe_top = 0.5;
    p.edge_length = 0.02;
    StationarySteel steel = generate_stationary_steel(p);
    const std::size_t triangles = steel.solid().triangles.size();
    for (TriangleSurface* part : {&steel.backplate, &steel.suction_pipe}) {
        const ContactSurface made = contact_surface(*part, {2e-4, 0.04});
        EXPECT_EQ(made.kept_because, "");
        EXPECT_LE(made.deviation, 2e-4);
        *part = made.surface;
    }
    EXPECT_TRUE(inspect_surface(steel.solid()).closed());
    EXPECT_LT(steel.solid().triangles.size(), 0.6 * triangles);
}

TEST(ContactSurface, keeps_triangles_that_it_cannot_mend_and_says_why) {
    // Two triangles of an angle of half a degree: all edges are border.
    const TriangleSurface sliver{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 0.008, 0), Vec3(0, 0.008, 0)}, {{0, 1, 2}, {0, 2, 3}}};
    const ContactSurface kept = contact_surface(sliver, {1e-4, 2.0});
    EXPECT_EQ(kept.surface.triangles.size(), 2u);
    EXPECT_NE(kept.kept_because.find("the remeshed surface had an angle of"), std::string::npos) << kept.kept_because;

    const TriangleSurface fan{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)},
                              {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
    EXPECT_NE(contact_surface(fan, {1e-4, 2.0}).kept_because.find("2-manifold"), std::string::npos);
}

TEST(SurfaceDistance, is_that_of_shifted_and_of_coarser_drums) {
    const TriangleSurface drum = drum_of_strips(60);
    const Eigen::Affine3d shift(Eigen::Translation3d(0.0, 0.0, 0.003));
    EXPECT_NEAR(surface_distance(drum, transformed(drum, shift), 0.02), 0.003, 1e-9);
    // The sagitta of a chord of 18 degrees.
    EXPECT_NEAR(surface_distance(drum_of_strips(240), drum_of_strips(20), 0.02), 0.2 * (1.0 - std::cos(9.0 * k_degree)), 2e-5);
}

}  // namespace
}  // namespace cutterflow::geometry
