#include "postproc/pages/onset_band.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "postproc/draw/palette.hpp"

namespace cutterflow::postproc {
namespace {

using nlohmann::json;

constexpr const char* k_colour = "#f3e9cf";
constexpr const char* k_label = "onset in the reference";

}  // namespace

void add_onset_band(Plot& plot, double low, double high) {
    low = std::min(low, 0.0);
    high = std::max(high, k_onset_high);
    const double margin = 0.06 * (high - low), middle = 0.5 * (k_onset_low + k_onset_high);
    plot.script.commands =
        fmt::format(
            "set xrange [{}:{}]\nset object rectangle from {},graph 0 to {},graph 1 behind fc rgb \"{}\" fs solid noborder\n"
            "set label \"{}\" at {},graph 0.97 right rotate by 90 font \",11\" textcolor rgb \"{}\"\n",
            plot_number(low - margin), plot_number(high + margin), k_onset_low, k_onset_high, k_colour, k_label, middle, palette::ink) +
        plot.script.commands;
    plot.layout["xaxis"]["range"] = {low - margin, high + margin};
    plot.layout["shapes"] = json::array({{{"type", "rect"},
                                          {"layer", "below"},
                                          {"yref", "paper"},
                                          {"x0", k_onset_low},
                                          {"x1", k_onset_high},
                                          {"y0", 0},
                                          {"y1", 1},
                                          {"line", {{"width", 0}}},
                                          {"fillcolor", k_colour}}});
    plot.layout["annotations"] = json::array({{{"text", k_label},
                                               {"x", middle},
                                               {"y", 0.97},
                                               {"yref", "paper"},
                                               {"yanchor", "top"},
                                               {"textangle", -90},
                                               {"showarrow", false},
                                               {"font", {{"size", 11}, {"color", palette::ink}}}}});
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
