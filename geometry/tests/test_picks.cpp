// Rows of picks on heads whose file has none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/base/axis_frame.hpp"
#include "geometry/head/blade_faces.hpp"
#include "geometry/head/revolution_contour.hpp"
#include "geometry/tests/solids.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_length = 0.04;

double radius_of(const Vec3& point) {
    return std::hypot(point.x(), point.y());
}

/// A bar along x through the axis, 60 mm wide and 0.4 m long, in a cylinder about it.
TEST(PickRows, of_a_bar_stand_straight_out_of_its_leading_edges) {
    const TriangleSurface bar = testing::box(Vec3(-0.40, -0.03, -0.4), Vec3(0.40, 0.03, 0.0));
    const Contour contour({-0.4, 0.0}, {0.40, 0.40}, 0.40, 0.03);
    for (const double sense : {1.0, -1.0}) {
        const TriangleSurface rows = pick_rows(SolidSearch(bar), contour, k_length, sense, 20);
        EXPECT_EQ(rows.triangles.size(), 2u * 2u * 19u) << "two ends, 19 strips between 20 heights";
        double area = 0.0;
        for (const Triangle& triangle : rows.triangles) area += area_vector(rows, triangle).norm();
        const double width = k_length + 0.03 * 0.40, height = 0.38;
        EXPECT_NEAR(area, 2.0 * width * height, 1e-9);
        const double edge = std::asin(0.03 / 0.36);  // where steel is looked for, at 0.9 of the radius
        for (const Vec3& point : rows.points) {
            const double azimuth = std::atan2(point.y(), point.x());
            const double off = std::min(std::abs(std::remainder(azimuth - sense * edge, 2.0 * k_pi)),
                                        std::abs(std::remainder(azimuth - sense * edge - k_pi, 2.0 * k_pi)));
            EXPECT_LT(off, 1e-5);
        }
    }
}

TEST(PickRows, follow_the_blades_of_a_crown_and_end_where_its_steel_closes) {
    const TriangleSurface crown = generate_crown_cutter(testing::model_crown());
    const RevolutionContour fitted = fit_contour(RadiusProfile(crown), -0.485, 0.0, 1e-3);
    const Contour contour{fitted.z, fitted.radius, 0.40, 0.03};
    const SolidSearch cutter(crown);
    const TriangleSurface rows = pick_rows(cutter, contour, k_length, 1.0, 40);
    ASSERT_FALSE(rows.triangles.empty());
    EXPECT_EQ(rows.triangles.size() % 2u, 0u);
    double highest = -1.0, lowest = 0.0;
    for (std::size_t i = 0; i < rows.points.size(); ++i) {
        const Vec3& point = rows.points[i];
        const bool is_tip = i % 4 == 1 || i % 4 == 2;
        const double out = contour.signed_distance(radius_of(point), point.z());
        if (is_tip) {
            EXPECT_LT(out, 1.001 * k_length) << "at z = " << point.z();
            EXPECT_GT(out, 0.9 * k_length) << "a corner of the contour may be nearer than its foot";
        } else {
            EXPECT_LT(cutter.contains(point) ? 0.0 : cutter.nearest(point).distance, 0.012) << "a foot stands in its blade or beside it";
        }
        highest = std::max(highest, point.z());
        lowest = std::min(lowest, point.z());
    }
    EXPECT_LT(highest, -0.03) << "the ring is closed";
    EXPECT_GT(lowest, -0.45) << "the hub is closed, picks lean out of it";
}

TEST(PickRows, are_none_on_a_closed_body) {
    const TriangleSurface drum = testing::box(Vec3(-0.40, -0.40, -0.4), Vec3(0.40, 0.40, 0.0));
    const Contour contour({-0.4, 0.0}, {0.40, 0.40}, 0.40, 0.03);
    EXPECT_TRUE(pick_rows(SolidSearch(drum), contour, k_length, 1.0, 10).triangles.empty());
}

}  // namespace
}  // namespace cutterflow::geometry
