#include <set>

#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
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

TEST(AxialBins, that_would_fill_the_memory_are_refused) {
    const Contour contour({-1.0, 0.0}, {1.0, 1.0}, 1.0, 0.1);
    EXPECT_EQ(axial_bins(contour, 1e-3).size(), 1002u);
    for (const double width : {0.9e-3, 1e-300, 5e-324}) EXPECT_THROW(axial_bins(contour, width), UserError) << width;
}

}  // namespace
}  // namespace cutterflow::geometry
