#include "geometry/base/region.hpp"

#include <gtest/gtest.h>

namespace cutterflow {
namespace {

TEST(Regions, hold_their_boundary_and_nothing_outside) {
    const Vec3 zero = Vec3::Zero();
    EXPECT_TRUE(is_within(BoxRegion{zero, Vec3(1, 2, 3)}, Vec3(1, 0, 3)));
    EXPECT_FALSE(is_within(BoxRegion{zero, Vec3(1, 2, 3)}, Vec3(0.5, 1, 3.01)));
    EXPECT_TRUE(is_within(SphereRegion{Vec3(1, 1, 1), 0.5}, Vec3(1, 1.5, 1)));
    EXPECT_FALSE(is_within(SphereRegion{Vec3(1, 1, 1), 0.5}, Vec3(1.4, 1.4, 1)));
    const CylinderRegion lying{zero, Vec3(2, 0, 0), 0.1};
    EXPECT_TRUE(is_within(lying, Vec3(2, 0, 0.1)));
    EXPECT_FALSE(is_within(lying, Vec3(2.01, 0, 0)));
    EXPECT_FALSE(is_within(lying, Vec3(1, 0.08, 0.08)));
    EXPECT_TRUE(is_within(HalfSpaceRegion{Vec3(0, 0, 1), Vec3(0, 0, 3)}, Vec3(9, 9, 1)));
    EXPECT_FALSE(is_within(HalfSpaceRegion{Vec3(0, 0, 1), Vec3(0, 0, 3)}, Vec3(9, 9, 0.9)));
    EXPECT_TRUE(is_within(EverywhereRegion{}, Vec3(1e9, 0, 0)));
}

}  // namespace
}  // namespace cutterflow
