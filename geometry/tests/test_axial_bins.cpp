#include <set>

#include <gtest/gtest.h>

#include "geometry/head/axial_bins.hpp"

namespace cutterflow::geometry {
namespace {

/// Bins of a cylinder of this height, 17 bins deep.
std::vector<AxialBin> bins_of(double height) {
    return axial_bins({{-height, 0.0}, {height, height}, height, 0.1 * height}, height / 17.0);
}

TEST(AxialBins, of_heads_of_any_size_have_names_of_their_own) {
    for (const double height : {0.0051, 0.051, 0.51, 5.1}) {
        std::set<std::string> names;
        for (const AxialBin& bin : bins_of(height)) names.insert(bin.name);
        EXPECT_EQ(names.size(), 19u) << height;
    }
    EXPECT_EQ(bins_of(0.51).at(2).name, "30-60mm");
    EXPECT_EQ(bins_of(0.051).at(2).name, "3.0-6.0mm");
}

TEST(AxialBins, hold_every_height_once) {
    const std::vector<AxialBin> bins = bins_of(0.51);
    EXPECT_EQ(bins.at(bin_of(bins, 0.01)).name, "gap");
    EXPECT_EQ(bins.at(bin_of(bins, -0.031)).name, "30-60mm");
    EXPECT_EQ(bins.at(bin_of(bins, -0.6)).name, "below_hub");
}

}  // namespace
}  // namespace cutterflow::geometry
