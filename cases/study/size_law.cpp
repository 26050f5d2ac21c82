#include "cases/study/size_law.hpp"

#include <algorithm>
#include <cmath>

namespace cutterflow::cases {

double SizeDistribution::mass_below(double diameter) const {
    if (law == SizeLaw::rosin_rammler) return -std::expm1(-std::pow(diameter / scale, spread));
    return 0.5 * std::erfc(-std::log(diameter / scale) / (spread * std::sqrt(2.0)));
}

double SizeDistribution::truncated_mass_below(double diameter) const {
    const double low = mass_below(smallest), high = mass_below(largest);
    return std::clamp((mass_below(diameter) - low) / (high - low), 0.0, 1.0);
}

std::vector<double> equal_mass_diameters(const SizeDistribution& sizes, int classes) {
    std::vector<double> diameters;
    for (int i = 0; i < classes; ++i) {
        const double share = (i + 0.5) / classes;
        double low = sizes.smallest, high = sizes.largest;
        while (high - low > 1e-12 * high) {
            const double middle = 0.5 * (low + high);
            (sizes.truncated_mass_below(middle) < share ? low : high) = middle;
        }
        diameters.push_back(0.5 * (low + high));
    }
    return diameters;
}

}  // namespace cutterflow::cases
