#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/surface/simple_solids.hpp"
#include "geometry/surface/soundness.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_accepted = 0.005;

void expect_solid(const TriangleSurface& surface, double volume, const char* name) {
    const SoundnessReport report = inspect_surface(surface);
    EXPECT_TRUE(report.sound()) << name;
    EXPECT_EQ(report.components.size(), 1u) << name;
    EXPECT_NEAR(report.volume / volume, 1.0, k_accepted) << name;
}

double longest_side(const TriangleSurface& surface) {
    double longest = 0.0;
    for (const Triangle& t : surface.triangles)
        for (int k = 0; k < 3; ++k) longest = std::max(longest, (surface.points[t[k]] - surface.points[t[(k + 1) % 3]]).norm());
    return longest;
}

TEST(SimpleSolids, pipes_have_the_volume_of_their_wall) {
    // Edges much longer than the circles, and much shorter.
    for (const double edge : {1.0, 0.02}) {
        const PipeParameters pipe{0.1, 0.02, 0.5, edge};
        EXPECT_NEAR(pipe.volume(), k_pi * (0.12 * 0.12 - 0.1 * 0.1) * 0.5, 1e-15);
        expect_solid(generate_pipe(pipe), pipe.volume(), "pipe");
    }
    const PipeParameters rod{0.0, 0.1, 0.5, 0.05};
    EXPECT_NEAR(rod.volume(), k_pi * 0.1 * 0.1 * 0.5, 1e-15);
    expect_solid(generate_pipe(rod), rod.volume(), "rod");
}

TEST(SimpleSolids, funnels_have_the_volume_between_their_cones) {
    // Frusta of the outer and the inner radii, from the textbook formula.
    const auto frustum = [](double r, double q, double h) { return k_pi * h / 3.0 * (r * r + r * q + q * q); };
    const FunnelParameters funnel{0.3, 0.05, 0.4, 0.1, 0.02, 0.02};
    const double volume = frustum(0.32, 0.07, 0.4) - frustum(0.3, 0.05, 0.4) + k_pi * (0.07 * 0.07 - 0.05 * 0.05) * 0.1;
    EXPECT_NEAR(funnel.volume(), volume, 1e-12);
    expect_solid(generate_funnel(funnel), volume, "funnel");
    FunnelParameters without_spout = funnel;
    without_spout.spout_length = 0.0;
    expect_solid(generate_funnel(without_spout), frustum(0.32, 0.07, 0.4) - frustum(0.3, 0.05, 0.4), "funnel without spout");
    EXPECT_NO_THROW(generate_funnel({0.05, 0.05, 0.4, 0.1, 0.02, 0.02}));
    EXPECT_THROW(generate_funnel({0.04, 0.05, 0.4, 0.1, 0.02, 0.02}), UserError);
}

TEST(SimpleSolids, boxes_are_exact_and_divided) {
    const TriangleSurface box = generate_box({0.4, 0.3, 0.2}, 0.06);
    expect_solid(box, 0.024, "box");
    EXPECT_NEAR(volume_of(box), 0.024, 1e-15);
    EXPECT_LE(longest_side(box), 0.06 * std::sqrt(2.0));
    const Bounds bounds = bounds_of(box);
    EXPECT_TRUE(bounds.min.isApprox(Vec3(-0.2, -0.15, 0.0)) && bounds.max.isApprox(Vec3(0.2, 0.15, 0.2)));
}

TEST(SimpleSolids, bins_dishes_and_slotted_boxes_have_the_volume_of_their_parts) {
    const auto ring = [](double out, double in, double h) { return k_pi * (out * out - in * in) * h; };
    expect_solid(generate_bin({0.04, 0.1, 0.005, 0.014}), ring(0.045, 0.04, 0.1) + ring(0.045, 0.014, 0.005), "bin");
    expect_solid(generate_bin({0.04, 0.1, 0.005, 0.0}), ring(0.045, 0.04, 0.1) + ring(0.045, 0.0, 0.005), "bin without orifice");
    EXPECT_NEAR(BinParameters({0.04, 0.1, 0.005, 0.014}).volume(), ring(0.045, 0.04, 0.1) + ring(0.045, 0.014, 0.005), 1e-15);
    expect_solid(generate_dish({0.028, 0.012, 0.002, 0.001}), ring(0.029, 0.0, 0.012) + ring(0.029, 0.028, 0.002), "dish");
    expect_solid(generate_dish({0.028, 0.012, 0.0, 0.0}), ring(0.028, 0.0, 0.012), "plate");
    EXPECT_NEAR(DishParameters({0.028, 0.012, 0.002, 0.001}).volume(), ring(0.029, 0.0, 0.012) + ring(0.029, 0.028, 0.002), 1e-15);

    const SlottedBoxParameters box{{0.8, 0.15, 0.9}, 0.03, 0.15};
    const double volume = 0.15 * (2.0 * 0.93 * 0.03 + 0.03 * (0.8 - 0.15));  // two walls down to the floor's lower face, two plates between
    EXPECT_NEAR(box.volume(), volume, 1e-15);
    const TriangleSurface surface = generate_slotted_box(box);
    const SoundnessReport report = inspect_surface(surface);
    EXPECT_TRUE(report.sound());
    EXPECT_EQ(report.components.size(), 2u);
    EXPECT_NEAR(report.volume, volume, 1e-12);
    const Bounds bounds = bounds_of(surface);
    EXPECT_TRUE(bounds.min.isApprox(Vec3(-0.43, -0.075, -0.03)) && bounds.max.isApprox(Vec3(0.43, 0.075, 0.9)));

    const TriangleSurface block = generate_block({0.1, 0.2, 0.3}, {0.2, 0.4, 0.6});
    expect_solid(block, 0.1 * 0.2 * 0.3, "block");
    EXPECT_TRUE(bounds_of(block).min.isApprox(Vec3(0.1, 0.2, 0.3)) && bounds_of(block).max.isApprox(Vec3(0.2, 0.4, 0.6)));
    EXPECT_EQ(block.triangles.size(), 12u);
    EXPECT_THROW(generate_bin({0.04, 0.1, 0.005, 0.04}), UserError);
    EXPECT_THROW(generate_slotted_box({{0.8, 0.15, 0.9}, 0.03, 0.8}), UserError);
}

TEST(SimpleSolids, edges_that_make_too_many_triangles_are_refused) {
    EXPECT_THROW(generate_box({0.03, 0.02, 0.02}, 1e-7), UserError);
    EXPECT_THROW(generate_pipe({0.1, 0.01, 1.0, 1e-5}), UserError);
    EXPECT_NO_THROW(generate_box({0.03, 0.02, 0.02}, 1e-3));
}

TEST(SimpleSolids, every_size_without_meaning_is_named) {
    try {
        generate_funnel({0.3, -0.05, 0.0, 0.0, 0.02, 0.02});
        FAIL();
    } catch (const UserError& error) {
        ASSERT_EQ(error.mistakes().size(), 2u);
        EXPECT_EQ(error.mistakes()[0].text(), "outlet radius = -0.05 m. It must be above 0. Correct it.");
        EXPECT_EQ(error.mistakes()[1].text(), "cone height = 0 m. It must be above 0. Correct it.");
    }
}

}  // namespace
}  // namespace cutterflow::geometry
