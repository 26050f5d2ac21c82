/// Clumps made from surfaces, and shadows of surfaces, against closed forms.
#include <cmath>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/clump_fit/fit_clump.hpp"
#include "geometry/clump_fit/solid_shadow.hpp"
#include "geometry/surface/simple_solids.hpp"
#include "geometry/tests/solids.hpp"

namespace cutterflow::geometry {
namespace {

/// A box's surface, its points moved onto an ellipsoid of these half axes.
TriangleSurface ellipsoid(const Vec3& half) {
    TriangleSurface surface = generate_box(Vec3(2.0, 2.0, 2.0), 0.12);
    for (Vec3& point : surface.points) point = half.cwiseProduct(Vec3(point - Vec3::UnitZ()).normalized());
    return surface;
}

TEST(SolidShadow, of_a_box_is_the_sum_of_its_faces_projections) {
    const TriangleSurface box = generate_box(Vec3(0.3, 0.2, 0.1), 0.05);
    const Vec3 direction = Vec3(0.3, -0.5, 0.8).normalized();
    const double exact = std::abs(direction.x()) * 0.02 + std::abs(direction.y()) * 0.03 + std::abs(direction.z()) * 0.06;
    EXPECT_NEAR(shadow_area(box, direction, 400) / exact, 1.0, 1e-4);
    const ExtremeShadows extreme = extreme_shadows(box);
    EXPECT_NEAR(extreme.areas.smallest / 0.02, 1.0, 5e-3);
    EXPECT_NEAR(extreme.areas.largest / std::sqrt(0.02 * 0.02 + 0.03 * 0.03 + 0.06 * 0.06), 1.0, 1e-3);
    EXPECT_NEAR(std::abs(extreme.smallest_along.x()), 1.0, 1e-4);
}

// Two boxes one behind the other: the shadow counts once what both hide.
TEST(SolidShadow, counts_what_is_hidden_twice_once) {
    const TriangleSurface box = generate_box(Vec3(0.3, 0.2, 0.1), 0.05);
    const TriangleSurface two = joined({box, transformed(box, Eigen::Affine3d(Eigen::Translation3d(0.1, 0.0, 0.2)))});
    EXPECT_NEAR(shadow_area(two, Vec3::UnitZ(), 400) / (0.4 * 0.2), 1.0, 1e-3);
    EXPECT_NEAR(shadow_area(two, Vec3::UnitX(), 400) / (2.0 * 0.1 * 0.2), 1.0, 1e-2);
}

TEST(ClumpFit, has_volume_inertia_and_shadows_of_an_ellipsoid) {
    const Vec3 half(0.02, 0.015, 0.01);
    const ClumpFit fit = fit_clump(ellipsoid(half), 12);
    const double volume = 4.0 / 3.0 * k_pi * half.prod();
    EXPECT_NEAR(fit.of_rock.volume / volume, 1.0, 0.02) << "the surface is inscribed";
    EXPECT_EQ(fit.clump.balls.size(), 12u);
    EXPECT_NEAR(fit.of_clump.volume / fit.of_rock.volume, 1.0, 0.02);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(fit.of_clump.principal_moments[k] / fit.of_rock.principal_moments[k], 1.0, 0.02) << k;
    EXPECT_NEAR(fit.of_rock.shadow.smallest / (k_pi * half.y() * half.z()), 1.0, 0.015);
    EXPECT_NEAR(fit.of_rock.shadow.largest / (k_pi * half.x() * half.y()), 1.0, 0.015);
    EXPECT_NEAR(fit.of_clump.shadow.smallest / fit.of_rock.shadow.smallest, 1.0, 0.02);
    EXPECT_NEAR(fit.of_clump.shadow.largest / fit.of_rock.shadow.largest, 1.0, 0.02);
    EXPECT_LT((fit.of_clump.centroid - fit.of_rock.centroid).norm(), 0.01 * half.x());
    EXPECT_LT(fit.inscribed_volume, 0.9 * fit.of_rock.volume) << "what lies within alone is too small";
    EXPECT_NEAR(*fit.clump.sphericity, 0.937, 0.01);
    EXPECT_TRUE(clump_mistakes(fit.clump).empty());
}

TEST(ClumpFit, refuses_a_number_of_spheres_that_makes_no_clump) {
    const TriangleSurface rock = ellipsoid(Vec3(0.02, 0.015, 0.01));
    EXPECT_THROW(fit_clump(rock, 0), UserError);
    EXPECT_THROW(fit_clump(rock, k_most_balls + 1), UserError);
}

TEST(ClumpFit, refuses_a_plate_that_is_too_thin_for_a_sphere_with_its_thickness) {
    for (const auto& [thickness, words] : {std::pair(2e-4, "about 0.0002 m thick and 0.04 m long"), {1e-5, "about 1e-05 m thick"}})
        for (const int balls : {1, 3, 12}) try {
                fit_clump(testing::box(Vec3::Zero(), Vec3(0.04, 0.04, thickness)), balls);
                ADD_FAILURE() << thickness;
            } catch (const UserError& error) {
                const std::string message = error.what();
                EXPECT_NE(message.find(words), std::string::npos) << message;
                EXPECT_NE(message.find("Give a thicker surface"), std::string::npos) << message;
            }
}

}  // namespace
}  // namespace cutterflow::geometry
