/// Cavities, void areas, packing and velocities of grains whose places are known.
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/sphere.hpp"
#include "postproc/analysis/measures/cavity.hpp"
#include "postproc/analysis/measures/grain_maps.hpp"
#include "postproc/tests/measures/packed_grains.hpp"

namespace cutterflow::postproc {
namespace {

constexpr double k_side = 0.5, k_wide = 0.172, k_deep = 0.042, k_cell = 0.005;
const Eigen::Vector2d k_lower(-0.5 * k_side, -0.5 * k_side), k_upper(0.5 * k_side, 0.5 * k_side);

/// A bed 0.1 m deep, larger than the map.
Grains bed(double d, unsigned seed, const std::function<bool(const Vec3&)>& keep) {
    const double half = 0.5 * k_side + 2.0 * d;
    return testing::packed_grains({-half, -half, 0.0}, {half, half, 0.1}, d, seed, keep);
}

TEST(Cavity, of_a_cap_cut_from_a_bed_has_its_depth_and_diameter) {
    const double radius = (0.25 * k_wide * k_wide + k_deep * k_deep) / (2.0 * k_deep);
    const Vec3 centre(0.0, 0.0, 0.1 + radius - k_deep);
    for (const double d : {0.0253, 0.0125}) {
        for (const unsigned seed : {1U, 2U}) {
            const double undisturbed = surface_level(bed(d, seed, [](const Vec3&) { return true; }), k_lower, k_upper, k_cell);
            const Grains cut = bed(d, seed, [&](const Vec3& place) { return (place - centre).norm() > radius; });
            const auto cavity = cavity_of(cut, k_lower, k_upper, undisturbed, k_cell);
            ASSERT_TRUE(cavity) << d;
            EXPECT_NEAR(cavity->depth, k_deep, 0.5 * d) << d << " seed " << seed;
            EXPECT_NEAR(cavity->diameter, k_wide, d) << d << " seed " << seed;
            const double above_centre = radius - k_deep + 0.5 * d;  // the diameter is taken half a diameter below the surface
            const double wide_there = 2.0 * std::sqrt(radius * radius - above_centre * above_centre);
            EXPECT_NEAR(cavity->diameter, wide_there, 0.5 * d) << d << " seed " << seed;
            EXPECT_NEAR(cavity->chord_mean, wide_there, d) << d << " seed " << seed;
            EXPECT_NEAR(cavity->centre.norm(), 0.0, 0.5 * d);
            EXPECT_FALSE(cavity->at_border);
            EXPECT_EQ(cavity->chords.size(), 8U);
            RecordProperty(fmt::format("cap_{}_{}_mm", d, seed),
                           fmt::format("depth {:.1f} diameter {:.1f} chords {:.1f} +- {:.1f} undisturbed {:.1f}", 1e3 * cavity->depth,
                                       1e3 * cavity->diameter, 1e3 * cavity->chord_mean, 1e3 * cavity->chord_spread, 1e3 * undisturbed));
        }
    }
}

TEST(Cavity, is_not_found_in_an_undisturbed_bed) {
    const Grains whole = bed(0.0125, 3, [](const Vec3&) { return true; });
    const auto cavity = cavity_of(whole, k_lower, k_upper, surface_level(whole, k_lower, k_upper, k_cell), k_cell);
    EXPECT_LT(cavity ? cavity->diameter : 0.0, 4.0 * 0.0125) << "the roughness of a bed is taken for a cavity";
}

/// Void fraction of cells of which the part inside a disc is empty and the rest has `outside`.
std::vector<double> disc_field(const PlaneGrid& grid, double radius, double outside) {
    std::vector<double> field;
    constexpr int parts = 20;
    for (int j = 0; j < grid.rows(); ++j) {
        for (int i = 0; i < grid.columns(); ++i) {
            int inside = 0;
            for (int a = 0; a < parts; ++a)
                for (int b = 0; b < parts; ++b)
                    inside += std::hypot(grid.x(i) + grid.width() * ((a + 0.5) / parts - 0.5),
                                         grid.z(j) + grid.height() * ((b + 0.5) / parts - 0.5)) < radius;
            const double share = static_cast<double>(inside) / (parts * parts);
            field.push_back(share + (1.0 - share) * outside);
        }
    }
    return field;
}

/// Threshold 0.7 lies in the middle between 1 inside and 0.4 outside, where the outline of a sharp edge is; others move it by up to a part
/// of a cell.
TEST(VoidArea, of_a_disc_in_a_field_is_its_area) {
    const std::pair<double, double> cell_and_threshold[] = {{0.002, 0.7}, {0.001, 0.75}};
    for (const auto& [cell, threshold] : cell_and_threshold) {
        const PlaneGrid grid{{{-0.1, 0.0, -0.1}, {0.1, 0.02, 0.1}}, 1, cell};
        const std::vector<double> field = disc_field(grid, 0.040, 0.4);
        const VoidArea found = void_area(field, grid, 0.01, 0.0, threshold);
        EXPECT_NEAR(found.area / (k_pi * 0.040 * 0.040), 1.0, 0.01);
        EXPECT_NEAR(found.equivalent_diameter, 0.080, 0.0004);
        EXPECT_NEAR(found.width, 0.080, 0.001);
        EXPECT_NEAR(found.height, 0.080, 0.001);
        EXPECT_EQ(void_area(field, grid, 0.09, 0.09, threshold).area, 0.0) << "the seed lies in the bed";
        RecordProperty(fmt::format("field_area_ratio_{}", threshold), fmt::format("{:.4f}", found.area / (k_pi * 0.040 * 0.040)));
    }
}

TEST(VoidArea, holds_only_what_is_connected_to_the_seed) {
    const PlaneGrid grid{{{-0.1, 0.0, -0.1}, {0.1, 0.02, 0.1}}, 1, 0.002};
    std::vector<double> field = disc_field(grid, 0.040, 0.4);
    for (int j = 0; j < 10; ++j)
        for (int i = 0; i < 10; ++i) field[static_cast<std::size_t>(j) * grid.columns() + i] = 1.0;
    EXPECT_NEAR(void_area(field, grid, 0.0, 0.0, 0.7).area / (k_pi * 0.040 * 0.040), 1.0, 0.01);
}

TEST(VoidArea, of_a_round_hole_through_packed_grains_is_its_area) {
    for (const unsigned seed : {1U, 2U}) {
        const Grains grains = testing::packed_grains({-0.09, 0.0, -0.09}, {0.09, 0.048, 0.09}, 0.004, seed,
                                                     [](const Vec3& place) { return std::hypot(place.x(), place.z()) > 0.040; });
        const PlaneGrid grid{{{-0.08, 0.004, -0.08}, {0.08, 0.044, 0.08}}, 1, 0.004};
        const VoidArea found = void_area(void_fraction(solid_map(grains, grid), grid), grid, 0.0, 0.0, 0.75);
        EXPECT_NEAR(found.area / (k_pi * 0.040 * 0.040), 1.0, 0.03) << "seed " << seed;
        RecordProperty(fmt::format("packed_area_ratio_{}", seed), fmt::format("{:.4f}", found.area / (k_pi * 0.040 * 0.040)));
    }
}

TEST(Packing, is_the_share_of_the_grains_that_were_packed) {
    const double d = 0.01, side = 14.0 * d;  // two cubes of the packing
    const Grains grains = testing::packed_grains(Vec3::Constant(-side), Vec3::Constant(side), d, 1, [](const Vec3&) { return true; });
    EXPECT_NEAR(solid_share(grains, BoxRegion{Vec3::Constant(-0.5 * side), Vec3::Constant(0.5 * side)}), testing::k_packed_share, 0.002);
    EXPECT_NEAR(solid_share(grains, CylinderRegion{{0.0, 0.0, -0.5 * side}, {0.0, 0.0, 0.5 * side}, 0.45 * side}), testing::k_packed_share,
                0.01);
}

TEST(Packing, of_a_sphere_that_a_plane_halves_is_half) {
    Grains grains;
    grains.add(Vec3::Zero(), Vec3::Zero(), 1.0, 1.0);
    const double box = 4.0;
    EXPECT_NEAR(solid_share(grains, BoxRegion{{-1.0, -1.0, 0.0}, {1.0, 1.0, 1.0}}), 0.5 * sphere_volume(1.0) / box, 1e-12);
    EXPECT_NEAR(solid_share(grains, SphereRegion{Vec3::Zero(), 1.0}), 1.0 / 8.0, 1e-12);
}

TEST(BedVelocity, is_weighted_by_solid_volume) {
    Grains grains;
    grains.add({0.25, 0.5, 0.25}, {1.0, 0.0, 0.0}, 0.2, 1.0);
    grains.add({0.25, 0.5, 0.25}, {0.0, 0.0, 3.0}, 0.1, 1.0);
    grains.add({0.75, 0.5, 0.75}, {0.0, 0.0, -2.0}, 0.1, 1.0);
    const PlaneGrid grid{{Vec3::Zero(), Vec3::Ones()}, 1, 0.5};
    const SolidMap map = solid_map(grains, grid, 1.5);
    const double large = sphere_volume(0.2), small = sphere_volume(0.1);
    ASSERT_EQ(map.volume.size(), 4U);
    EXPECT_NEAR(map.volume[0], large + small, 1e-12);
    EXPECT_NEAR(map.volume_by_velocity[0].x() / map.volume[0], large / (large + small), 1e-12);
    EXPECT_NEAR(map.volume_by_velocity[3].z() / map.volume[3], -2.0, 1e-12);
    EXPECT_NEAR(map.speed_sum, large + 3.0 * small + 2.0 * small, 1e-12);
    EXPECT_NEAR(map.faster_volume, 2.0 * small, 1e-12);
}

}  // namespace
}  // namespace cutterflow::postproc
