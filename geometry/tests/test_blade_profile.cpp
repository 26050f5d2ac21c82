/// Blade angle and coverage of helicoids, whose slope and width are known, and of the shipped heads.
#include "geometry/head/blade_profile.hpp"

#include <unistd.h>

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/head/head.hpp"
#include "geometry/surface/revolve.hpp"
#include "geometry/tests/solids.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_outer = 0.4, k_depth = 0.4;
const RevolutionContour k_drum{{-k_depth, 0.0}, {k_outer, k_outer}, 0.0};

/// Part of a face: a grid of corners over [0, 1] x [0, 1]; outward is from u to v by the right hand.
template <class Place>
void add_patch(TriangleSurface& surface, std::uint32_t rows, std::uint32_t columns, const Place& place) {
    const auto first = static_cast<std::uint32_t>(surface.points.size());
    for (std::uint32_t i = 0; i <= rows; ++i)
        for (std::uint32_t j = 0; j <= columns; ++j)
            surface.points.push_back(place(static_cast<double>(i) / rows, static_cast<double>(j) / columns));
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return first + i * (columns + 1) + j; };
    for (std::uint32_t i = 0; i < rows; ++i)
        for (std::uint32_t j = 0; j < columns; ++j) {
            surface.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            surface.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
}

/// Blades between two radii whose azimuth grows by `turn` [rad/m] along the axis, each `width` [rad] wide. Fine in all directions: a facet
/// from one radius to the other would have the slope of neither, one across an edge would push around the axis.
TriangleSurface helicoids(int count, double inner, double turn, double width) {
    constexpr std::uint32_t along = 160, out = 24, across = 12;
    TriangleSurface blades;
    for (int blade = 0; blade < count; ++blade) {
        const auto place = [&](double z_share, double r_share, double side) {
            const double z = -k_depth + k_depth * z_share, radius = inner + (k_outer - inner) * r_share;
            const double azimuth = 2.0 * k_pi * blade / count + turn * z + (side - 0.5) * width;
            return Vec3(radius * std::cos(azimuth), radius * std::sin(azimuth), z);
        };
        add_patch(blades, along, out, [&](double z, double r) { return place(z, r, 1.0); });
        add_patch(blades, out, along, [&](double r, double z) { return place(z, r, 0.0); });
        add_patch(blades, across, along, [&](double side, double z) { return place(z, 1.0, side); });
        add_patch(blades, along, across, [&](double z, double side) { return place(z, 0.0, side); });
        add_patch(blades, out, across, [&](double r, double side) { return place(1.0, r, side); });
        add_patch(blades, across, out, [&](double side, double r) { return place(0.0, r, side); });
    }
    return blades;
}

/// Mean slope of a helicoid between two radii, weighted as blade_profile does it: faces of area sqrt(1 + (c r)^2) dr dz with the thrust
/// 1 / (1 + (c r)^2).
double mean_slope(double inner, double turn) {
    double slope = 0.0, weight = 0.0;
    for (int k = 0; k < 1000; ++k) {
        const double radius = inner + (k_outer - inner) * (k + 0.5) / 1000;
        const double thrust = 1.0 / std::sqrt(1.0 + turn * turn * radius * radius);
        slope += thrust * turn * radius;
        weight += thrust;
    }
    return slope / weight;
}

TEST(BladeProfile, finds_angle_and_coverage_of_helicoids) {
    for (const double turn : {1.0, 2.5, 5.0})
        for (const double inner : {0.25, 0.38})
            for (const double width : {0.1, 0.5}) {
                // The ring end trails the hub end: positive rotation carries towards the ring.
                const TriangleSurface surface = helicoids(5, inner, -turn, width);
                // Facets cut corners of a curved solid by less than 1 %.
                const double volume = 2.5 * width * (k_outer * k_outer - inner * inner) * k_depth;
                ASSERT_NEAR(volume_of(surface), volume, 0.01 * volume);
                for (const BladeSlice& slice : blade_profile(surface, k_drum, 1.0, 8)) {
                    EXPECT_NEAR(slice.angle, std::atan(mean_slope(inner, turn)), 0.01) << turn << " " << inner;
                    EXPECT_NEAR(slice.coverage, 5.0 * width / (2.0 * k_pi), 5.0 / 720.0) << width;
                    EXPECT_NEAR(slice.depth, k_outer - inner, 1e-3) << inner;
                }
            }
}

TEST(BladeProfile, of_the_mirrored_head_is_the_same_for_the_other_rotation) {
    const auto one = blade_profile(helicoids(4, 0.3, -2.0, 0.2), k_drum, 1.0, 4);
    const TriangleSurface mirrored = transformed(helicoids(4, 0.3, -2.0, 0.2), Eigen::Affine3d(Eigen::Scaling(1.0, -1.0, 1.0)));
    const auto other = blade_profile(mirrored, k_drum, -1.0, 4);
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i].angle, other[i].angle, 1e-9);
    EXPECT_LT(blade_profile(mirrored, k_drum, 1.0, 4).front().angle, 0.0);
}

TEST(BladeProfile, does_not_count_shaft_and_hub_and_shows_a_ring_as_closed) {
    const TriangleSurface blades = helicoids(4, 0.3, -2.0, 0.2);
    const TriangleSurface shaft = solid_of_revolution({{0.0, -k_depth}, {0.15, -k_depth}, {0.15, 0.0}, {0.0, 0.0}}, 48, 0.05);
    const TriangleSurface ring = solid_of_revolution({{0.35, -0.1}, {k_outer, -0.1}, {k_outer, 0.0}, {0.35, 0.0}}, 96, 0.05);
    const auto without = blade_profile(blades, k_drum, 1.0, 8);
    const auto with = blade_profile(joined({blades, shaft, ring}), k_drum, 1.0, 8);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_NEAR(with[i].angle, without[i].angle, 1e-12);
        EXPECT_EQ(with[i].coverage, without[i].coverage);
        EXPECT_EQ(with[i].depth, without[i].depth);
    }
    EXPECT_EQ(with[7].coverage, 1.0);
    EXPECT_EQ(share_flatter_than(with, 80.0 * k_pi / 180.0), 1.0);
    EXPECT_EQ(share_flatter_than(with, 10.0 * k_pi / 180.0), 0.0);
    EXPECT_FALSE(share_flatter_than({{-0.1, 0.5, 1.0}}, 0.1));
}

TEST(CrownParameters, of_a_shaft_without_a_radius_are_refused) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("cutterflow_shaft_" + std::to_string(::getpid()) + ".toml");
    write_file(file, "[shaft]\nradius_at_hub_m = 0.05\n");
    EXPECT_THROW(read_crown_parameters(file), UserError);
    std::filesystem::remove(file);
}

// Blades at least a quarter of the ring radius deep that lean, steeper than a ladder at 45 degrees.
TEST(BladeProfile, of_the_crown_with_deep_blades_is_deep_and_steep) {
    const std::string file = std::string(CUTTERFLOW_SOURCE_DIR) + "/cases/examples/crown_with_deep_blades/crown.toml";
    const CrownParameters deep = read_crown_parameters(file);
    EXPECT_GE(deep.blade_depth_at_ring, 0.25 * deep.ring_radius);
    EXPECT_GT(deep.blade_depth_at_ring, deep.ring_radius - deep.ring_inner_radius);
    const Head head = understand_head(generate_crown_cutter(deep));
    EXPECT_EQ(head.symmetry.blade_count, 6);
    EXPECT_EQ(head.carrying.sense, CarryingSense::positive);
    EXPECT_NEAR(head.steel_above_ring, 0.0, 1e-9);
    const Head shallow = understand_head(generate_crown_cutter(testing::model_crown()));
    EXPECT_LT(*share_flatter_than(head.blades, 45.0 * k_pi / 180.0), 0.5);
    EXPECT_EQ(*share_flatter_than(shallow.blades, 45.0 * k_pi / 180.0), 1.0);
    const auto coverage = [](const Head& of) {
        double sum = 0.0, count = 0.0;
        for (const BladeSlice& slice : of.blades)
            if (slice.coverage < 1.0) {
                sum += slice.coverage;
                count += 1.0;
            }
        return sum / count;
    };
    EXPECT_GT(coverage(head), 1.5 * coverage(shallow));
}

}  // namespace
}  // namespace cutterflow::geometry
