#include "geometry/head/narrow_places.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/base/axis_frame.hpp"
#include "geometry/cgal/exact_solid.hpp"
#include "geometry/head/head.hpp"
#include "geometry/surface/revolve.hpp"
#include "geometry/tests/solids.hpp"

namespace cutterflow::geometry {
namespace {

/// Straight radial plates between a hub as wide as the head and a ring: a cage whose passages and plates are known.
struct Cage {
    int plates;
    double thickness, inner, outer;
    double low = -0.5, high = -0.05;
};

TriangleSurface solid_of(const Cage& cage) {
    ExactSolid solid(
        solid_of_revolution({{0.0, cage.low - 0.5}, {cage.outer, cage.low - 0.5}, {cage.outer, cage.low}, {0.0, cage.low}}, 96, 0.1));
    solid.unite(
        ExactSolid(solid_of_revolution({{cage.inner, cage.high}, {cage.outer, cage.high}, {cage.outer, 0.0}, {cage.inner, 0.0}}, 96, 0.1)));
    const TriangleSurface plate = testing::box(Vec3(cage.inner + 0.001, -0.5 * cage.thickness, cage.low - 0.05),
                                               Vec3(cage.outer - 0.002, 0.5 * cage.thickness, cage.high + 0.025));
    for (int i = 0; i < cage.plates; ++i)
        solid.unite(ExactSolid(transformed(plate, Eigen::Affine3d(Eigen::AngleAxisd(2.0 * k_pi * i / cage.plates + 0.1, Vec3::UnitZ())))));
    return solid.surface();
}

/// Distance of the inner edges of neighbouring plates that face each other.
double gap_of(const Cage& cage) {
    const double inner = cage.inner + 0.001;
    const double radius = std::hypot(inner, 0.5 * cage.thickness);
    const double angle = 2.0 * k_pi / cage.plates - 2.0 * std::atan2(0.5 * cage.thickness, inner);
    return 2.0 * radius * std::sin(0.5 * angle);
}

class Cages : public ::testing::TestWithParam<Cage> {};

TEST_P(Cages, have_the_passages_and_the_thickness_that_they_were_made_with) {
    const Cage cage = GetParam();
    const TriangleSurface solid = solid_of(cage);
    const RadiusProfile profile(solid);
    const RevolutionContour contour = fit_contour(profile, profile.z_min(), 0.0, 1e-4);
    EXPECT_NEAR(passage_between_blades(solid, contour, cage.plates) / gap_of(cage), 1.0, 0.02);
    EXPECT_NEAR(smallest_thickness(solid) / std::min(cage.thickness, 0.05), 1.0, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Plates, Cages, ::testing::Values(Cage{5, 0.03, 0.28, 0.4}, Cage{6, 0.02, 0.30, 0.4}, Cage{8, 0.04, 0.26, 0.38}));

TEST(SmallestThickness, is_that_of_a_plate_and_no_less_at_its_edges) {
    EXPECT_NEAR(smallest_thickness(testing::box(Vec3(0, 0, 0), Vec3(1.0, 0.7, 0.05))), 0.05, 1e-4);
}

TEST(SmallestThickness, follows_the_blades_of_a_crown) {
    CrownParameters p = testing::model_crown();
    p.edge_length = 0.03;
    EXPECT_NEAR(smallest_thickness(generate_crown_cutter(p)) / 0.024, 1.0, 0.05);
    p.blade_thickness_at_hub = 0.016;
    EXPECT_NEAR(smallest_thickness(generate_crown_cutter(p)) / 0.016, 1.0, 0.1);
}

TEST(Passage, shrinks_by_what_the_blades_gain_in_thickness_and_scales_with_the_head) {
    CrownParameters p = testing::model_crown();
    p.edge_length = 0.03;
    const double thin = *understand_head(generate_crown_cutter(p)).passage;
    p.blade_thickness = p.blade_thickness_at_hub = 0.034;
    const TriangleSurface thick_head = generate_crown_cutter(p);
    const Head thick = understand_head(thick_head);
    EXPECT_NEAR(thin - *thick.passage, 0.010, 0.0025);
    const Head large = understand_head(transformed(thick_head, Eigen::Affine3d(Eigen::Scaling(3.0))));
    EXPECT_NEAR(*large.passage / *thick.passage, 3.0, 0.01);
}

}  // namespace
}  // namespace cutterflow::geometry
