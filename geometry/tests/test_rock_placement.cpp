#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <string>

#include "geometry/base/error.hpp"
#include "geometry/head/head.hpp"
#include "geometry/head/stationary_steel.hpp"
#include "geometry/packing/rock_placement.hpp"
#include "geometry/tests/solids.hpp"

namespace cutterflow::geometry {
namespace {

/// The model head, its stationary steel and water, once for all tests.
struct Model {
    Head head = understand_head(generate_crown_cutter(testing::model_crown()));
    Contour contour{head.contour.z, head.contour.radius, head.ring_radius, 0.03};
    SolidSearch cutter{head.surface};
    SolidSearch stationary{generate_stationary_steel({0.4, 0.03, 0.03, {0.10, 0.22, 0.0}, 0.02, 0.535, 0.022}).solid()};
    AxialCylinder water{2.5, -0.875, 0.435};
};

const Model& model() {
    static const Model instance;
    return instance;
}

RockBatch batch_of_the_paper() {
    RockBatch batch;
    batch.count = 368;
    batch.diameter = 0.020;
    batch.lattice_spacing = 0.030;
    batch.clearance = 0.001;
    batch.region = {0.5 * k_pi, k_pi / 1.5, -0.40, 0.0, 0.05, 0.40};
    return batch;
}

TEST(RockPlacement, the_batch_of_the_paper_fits_into_the_model_head) {
    const RockPlacement placement =
        place_rocks(batch_of_the_paper(), model().contour, model().water, {&model().cutter, &model().stationary});
    EXPECT_EQ(placement.requested, 368u);
    EXPECT_EQ(placement.placed(), 368u);
    EXPECT_EQ(placement.rejected(), 0u);
    EXPECT_GT(placement.moved, 0u);
    EXPECT_EQ(placement.rejection_reason(), "");
}

TEST(RockPlacement, refuses_a_lattice_too_fine_to_be_searched_at_once) {
    RockBatch batch = batch_of_the_paper();
    batch.diameter = 1e-6;
    batch.lattice_spacing = 1.5e-6;
    batch.clearance = 0.0;
    const std::clock_t begin = std::clock();
    try {
        place_rocks(batch, model().contour, model().water, {&model().cutter});
        FAIL() << "searched";
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("places 1.5e-06 m apart"), std::string::npos) << error.what();
    }
    EXPECT_LT(std::clock() - begin, CLOCKS_PER_SEC);
}

class Repeats : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(Repeats, rocks_meet_neither_steel_nor_each_other_and_lie_inside_the_head) {
    RockBatch batch = batch_of_the_paper();
    batch.seed = GetParam();
    // The cutter as it stands at another angle.
    const double angle = 0.4 * static_cast<double>(GetParam());
    const SolidSearch turned(transformed(model().head.surface, Eigen::Affine3d(Eigen::AngleAxisd(angle, Vec3::UnitZ()))));
    const RockPlacement placement = place_rocks(batch, model().contour, model().water, {&turned, &model().stationary});
    ASSERT_EQ(placement.placed(), 368u);
    for (std::size_t i = 0; i < placement.placed(); ++i) {
        const Vec3& at = placement.positions[i];
        const double r = std::hypot(at.x(), at.y());
        EXPECT_GE(turned.nearest(at).distance, 0.011);
        EXPECT_FALSE(turned.contains(at));
        EXPECT_GE(model().stationary.nearest(at).distance, 0.011);
        EXPECT_LE(model().contour.signed_distance(r, at.z()), -0.010);
        EXPECT_LE(std::abs(std::remainder(std::atan2(at.y(), at.x()) - 0.5 * k_pi, 2.0 * k_pi)), k_pi / 3.0 + 1e-12);
        EXPECT_TRUE(at.z() >= -0.40 && at.z() <= 0.0);
        for (std::size_t j = 0; j < i; ++j) EXPECT_GE((at - placement.positions[j]).norm(), 0.030 - 1e-9);
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Repeats, ::testing::Values(1u, 2u, 3u));

TEST(RockPlacement, the_same_seed_repeats_and_another_one_moves_the_lattice) {
    RockBatch batch = batch_of_the_paper();
    const auto place = [&] { return place_rocks(batch, model().contour, model().water, {&model().cutter}).positions; };
    const std::vector<Vec3> first = place();
    EXPECT_EQ(first, place());
    batch.seed = 1;
    EXPECT_NE(first, place());
}

TEST(RockPlacement, what_does_not_fit_is_rejected_with_the_count_and_the_reason) {
    RockBatch batch = batch_of_the_paper();
    batch.count = 5000;
    const RockPlacement placement = place_rocks(batch, model().contour, model().water, {&model().cutter});
    EXPECT_EQ(placement.placed() + placement.rejected(), 5000u);
    EXPECT_GT(placement.rejected(), 3000u);
    std::size_t blocked = 0;
    for (const auto& [reason, count] : placement.blocked) blocked += count;
    EXPECT_EQ(blocked + placement.placed(), placement.places);
    EXPECT_GT(placement.blocked.at(Blocked::inside_steel), 0u);
    EXPECT_GT(placement.blocked.at(Blocked::too_close_to_steel), 0u);
    EXPECT_NE(placement.rejection_reason().find("inside steel"), std::string::npos) << placement.rejection_reason();
}

TEST(RockPlacement, a_free_region_takes_the_compact_batch_without_moving_a_rock) {
    const Contour drum({-1.0, 0.0}, {1.0, 1.0}, 1.0, 0.0);
    RockBatch batch = batch_of_the_paper();
    batch.count = 200;
    batch.region = {0.0, k_pi / 2.0, -0.7, -0.3, 0.2, 0.9};
    const RockPlacement placement = place_rocks(batch, drum, {2.5, -2.0, 1.0}, {});
    EXPECT_EQ(placement.placed(), 200u);
    EXPECT_EQ(placement.moved, 0u);
    // 200 places of 30 mm are a ball of radius 0.109 m.
    Vec3 middle = Vec3::Zero();
    for (const Vec3& at : placement.positions) middle += at / 200.0;
    double reach = 0.0;
    for (const Vec3& at : placement.positions) reach = std::max(reach, (at - middle).norm());
    EXPECT_NEAR(reach, std::cbrt(200.0 * 27e-6 * 3.0 / (4.0 * k_pi)), 0.01);
}

TEST(RockPlacement, a_region_outside_the_water_or_inside_steel_is_refused) {
    RockBatch batch = batch_of_the_paper();
    const auto refusal = [&](const AxialCylinder& water) {
        try {
            place_rocks(batch, model().contour, water, {&model().cutter});
        } catch (const UserError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(refusal({2.5, -3.0, -0.5}).find("outside the water"), std::string::npos);
    batch.region = {0.0, 2.0 * k_pi, -0.42, -0.32, 0.0, 0.10};  // the hub
    EXPECT_NE(refusal(model().water).find("inside steel"), std::string::npos);
    batch.region = {0.0, 0.1, -0.2, -0.19, 0.0, 0.001};
    EXPECT_NE(refusal(model().water).find("no place of the lattice"), std::string::npos);
}

TEST(RockPlacement, contradictions_are_all_named) {
    RockBatch batch = batch_of_the_paper();
    batch.lattice_spacing = 0.01;
    batch.region.z_min = 0.1;
    try {
        place_rocks(batch, model().contour, model().water, {});
        FAIL();
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().size(), 2u);
    }
}

}  // namespace
}  // namespace cutterflow::geometry
