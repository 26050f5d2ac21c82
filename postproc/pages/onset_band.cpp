#include "postproc/pages/onset_band.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace cutterflow::postproc {
void add_onset_band(Plot& plot, double low, double high) {
    low = std::min(low, 0.0);
    high = std::max(high, k_onset_high);
    const double margin = 0.06 * (high - low);
    plot.x.from = low - margin;
    plot.x.to = high + margin;
    plot.bands.push_back({k_onset_low, k_onset_high, "#f3e9cf", "onset in the reference"});
}

std::string onset_band_text() {
    return fmt::format(
        "Shaded: {:g} to {:g} m/s, where spillage through the bin below the ring began in the simulations of the reference (Nieuwboer, van "
        "Rhee and Keetels "
        "2023; model cutter at scale 1:4 of unpublished ring radius, rock of 20 mm). It is the reference’s band, not a result of this "
        "program.",
        k_onset_low, k_onset_high);
}

}  // namespace cutterflow::postproc
