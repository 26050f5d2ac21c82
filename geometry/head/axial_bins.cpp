#include "geometry/head/axial_bins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "geometry/base/error.hpp"

namespace cutterflow::geometry {

std::vector<AxialBin> axial_bins(const Contour& contour, double width) {
    if (!(width > 0.0)) throw std::invalid_argument("the width of axial bins must be positive");
    std::vector<AxialBin> bins{{"gap", contour.z_ring(), contour.z_backplate()}};
    const double depth = contour.z_ring() - contour.z_hub();
    if (!(depth / width <= k_most_axial_bins))
        throw UserError(fmt::format("axial bins {:g} m wide cut a head of {:g} m into {:.3g}", width, depth, std::ceil(depth / width)),
                        fmt::format("There are at most {:.0f}", k_most_axial_bins), "Choose a larger report.bin_width_m");
    // Two digits of the width, so that the bins of a small head have distinct names.
    const int decimals = std::max(0, static_cast<int>(std::ceil(1.0 - std::log10(1e3 * width))));
    // A remainder of less than a thousandth of a bin is rounding, not a bin.
    for (int i = 0; i * width < depth - 1e-3 * width; ++i) {
        const double upper = i * width;
        const double lower = std::min((i + 1) * width, depth);
        bins.push_back({fmt::format("{:.{}f}-{:.{}f}mm", 1e3 * upper, decimals, 1e3 * lower, decimals), contour.z_ring() - lower,
                        contour.z_ring() - upper});
    }
    bins.push_back({"below_hub", -std::numeric_limits<double>::infinity(), contour.z_hub()});
    return bins;
}

std::size_t bin_of(const std::vector<AxialBin>& bins, double z) {
    const auto found = std::find_if(bins.begin(), bins.end(), [z](const AxialBin& bin) { return z >= bin.z_min; });
    return static_cast<std::size_t>(found - bins.begin());
}

}  // namespace cutterflow::geometry
