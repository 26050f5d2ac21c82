/// What solids leave of boxes and cylinders, against volumes by hand.
#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/packing/free_space.hpp"
#include "geometry/surface/simple_solids.hpp"

namespace cutterflow::geometry {
namespace {

std::vector<SolidSearch> searches(const std::vector<TriangleSurface>& surfaces) {
    std::vector<SolidSearch> found;
    for (const TriangleSurface& surface : surfaces) found.emplace_back(surface);
    return found;
}

TEST(FreeSpace, is_the_region_where_no_solid_stands) {
    const Region box = BoxRegion{{-1, -1, 0.5}, {1, 2, 2.5}}, cylinder = CylinderRegion{{0, 0, 1}, {0, 0, 3}, 0.5};
    const FreeSpace in_box(box, {}), in_cylinder(cylinder, searches({generate_block({5, 5, 5}, {6, 6, 6})}));
    EXPECT_DOUBLE_EQ(in_box.volume(), 12.0);
    EXPECT_DOUBLE_EQ(in_box.volume_below(1.0), 3.0);
    EXPECT_EQ(in_box.volume_below(0.0), 0.0);
    EXPECT_DOUBLE_EQ(in_box.level_of(3.0), 1.0);
    EXPECT_EQ(in_box.level_of(13.0), 2.5);
    EXPECT_DOUBLE_EQ(in_cylinder.volume(), 0.5 * k_pi);
}

TEST(FreeSpace, lacks_what_solids_take) {
    // A block over 7 tenths of the floor, up to half of the height.
    const FreeSpace beside(BoxRegion{{0, 0, 0}, {1, 1, 1}}, searches({generate_block({-0.1, -0.1, -0.1}, {0.7, 1.1, 0.5})}));
    EXPECT_NEAR(beside.volume(), 0.65, 0.01);
    EXPECT_NEAR(beside.volume_below(0.5), 0.15, 0.005);
    EXPECT_NEAR(beside.level_of(0.06), 0.2, 0.01);
    EXPECT_NEAR(beside.level_of(0.4), 0.75, 0.01);
    // A plate that lies over the lower end.
    const FreeSpace above(CylinderRegion{{0, 0, 0}, {0, 0, 1}, 0.4}, searches({generate_block({-1, -1, -1}, {1, 1, 0.2})}));
    EXPECT_NEAR(above.volume(), 0.8 * 0.16 * k_pi, 0.01);
    EXPECT_EQ(above.volume_below(0.2), 0.0);
    EXPECT_NEAR(above.level_of(0.0), 0.2, 1e-12);
}

TEST(FreeSpace, of_a_round_region_in_a_tube_of_its_radius_is_all_of_it) {
    const FreeSpace within(CylinderRegion{{0, 0, 0}, {0, 0, 0.1}, 0.02}, searches({generate_pipe({0.02, 0.002, 0.1, 0.005})}));
    EXPECT_DOUBLE_EQ(within.volume(), 4e-5 * k_pi);
}

TEST(FreeSpace, is_nothing_within_a_solid) {
    const FreeSpace none(BoxRegion{{0, 0, 0}, {1, 1, 1}}, searches({generate_block({-1, -1, -1}, {2, 2, 2})}));
    EXPECT_EQ(none.volume(), 0.0);
    EXPECT_EQ(none.level_of(0.0), 1.0);
}

}  // namespace
}  // namespace cutterflow::geometry
