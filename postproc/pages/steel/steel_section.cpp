#include "postproc/pages/steel/steel_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "geometry/head/head_names.hpp"
#include "postproc/analysis/steel/steel_work.hpp"
#include "postproc/analysis/text.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/pages/head_picture.hpp"

namespace cutterflow::postproc {
namespace {

using text::number;

/// Of energy, none to most.
constexpr std::array<const char*, 5> k_heat{"#c2c9d0", "#f0d58a", "#ec9a4c", "#cc4a32", "#6d1330"};
constexpr int k_shades = 24;

/// Between the colours of k_heat. \param share  0 to 1
Colour heat(double share) {
    const double at = std::round(share * k_shades) / k_shades * (k_heat.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(at), k_heat.size() - 2);
    const Colour a = colour_of(k_heat[low]), b = colour_of(k_heat[low + 1]);
    const double rest = at - static_cast<double>(low);
    return {a.red + rest * (b.red - a.red), a.green + rest * (b.green - a.green), a.blue + rest * (b.blue - a.blue)};
}

std::optional<double> ratio(double part, double whole) {
    return whole > 0.0 ? std::optional<double>(part / whole) : std::nullopt;
}

/// One kind of energy on the cutter: its picture and its colours.
std::string map_of(const SteelWork& work, double SteelEnergy::*part, const char* what, const char* name, const RunData& run,
                   const Page& page) {
    const double top = (*work.highest).*part;
    std::vector<Colour> colours;
    for (const SteelEnergy& energy : work.cutter->per_area)
        colours.push_back(heat(top > 0.0 ? std::clamp(energy.*part / top, 0.0, 1.0) : 0.0));
    std::vector<std::pair<std::string, std::string>> scale;
    for (std::size_t step = 0; step < k_heat.size(); ++step) {
        const double value = top / work.map_duration() * static_cast<double>(step) / (k_heat.size() - 1);
        scale.emplace_back(k_heat[step], number(value, "W/m²") + (step + 1 == k_heat.size() ? " and more" : ""));
    }
    return html::figure(draw_painted_head(run, work.cutter->triangles, colours, page, name),
                        html::legend(scale) + fmt::format("{} per area of steel, mean over {:.4g} to {:.4g} s. The darkest colour stands "
                                                          "for what 1 % of the steel exceeds.",
                                                          what, work.map_from, work.map_to),
                        "head wide");
}

std::string wall_table(const SteelWork& work) {
    std::vector<std::vector<std::string>> rows;
    const auto add = [&](const std::string& name, const SteelEnergy& energy) {
        rows.push_back({name, number(ratio(energy.impact, work.duration())), number(ratio(energy.sliding, work.duration())),
                        number(ratio(energy.impact, work.fed)), number(ratio(energy.sliding, work.fed)),
                        number(ratio(energy.impact, work.delivered)), number(ratio(energy.sliding, work.delivered))});
    };
    for (const EnergyOfWall& wall : work.walls) {
        std::string name = wall.wall;
        std::replace(name.begin(), name.end(), '_', ' ');
        add(html::escape(name), wall.energy);
    }
    add("all", work.total());
    return html::table({"steel", "impact, W", "sliding, W", "impact, J per kg fed", "sliding, J per kg fed", "impact, J per kg delivered",
                        "sliding, J per kg delivered"},
                       rows, true);
}

std::string bin_table(const SteelWork& work) {
    SteelEnergy all;
    for (const EnergyOfBin& bin : work.bins) {
        all.impact += bin.energy.impact;
        all.sliding += bin.energy.sliding;
    }
    std::vector<std::vector<std::string>> rows;
    for (const EnergyOfBin& bin : work.bins) {
        if (bin.area == 0.0) continue;
        const double area_time = bin.area * work.map_duration();
        const auto share = [](double part, double whole) { return whole > 0.0 ? text::percent(part / whole) : std::string(text::k_dash); };
        rows.push_back({bin.bin.name == "gap" ? "above the ring’s top face" : text::bin_text(bin.bin.name), number(bin.area),
                        share(bin.energy.impact, all.impact), share(bin.energy.sliding, all.sliding),
                        number(ratio(bin.energy.impact, area_time)), number(ratio(bin.energy.sliding, area_time))});
    }
    return html::table({"cutter, below the ring", "steel, m²", "share of impact", "share of sliding", "impact, W/m²", "sliding, W/m²"},
                       rows, true);
}

/// By Froude's law: energy grows with length^4, time with length^0.5.
std::string prototype_text(double length_ratio) {
    if (length_ratio == 1.0) return "";
    const auto factor = [&](double power) { return text::digits_of(std::pow(length_ratio, power), 3); };
    return fmt::format(
        " In the prototype, {:g} times as long, by Froude’s law: energy times {} (length⁴), per area times {} (length²), W times {} "
        "(length<sup>3.5</sup>), W/m² times {} (length<sup>1.5</sup>), J per kg times {}.",
        length_ratio, factor(4.0), factor(2.0), factor(3.5), factor(1.5), factor(1.0));
}

std::string words(const SteelWork& work, double length_ratio) {
    std::string told = fmt::format(
        "<p>Impact: work of rock that comes closer to the steel, against the normal force; of one rock ½ m u<sub>n</sub>² with its added "
        "mass "
        "and its speed relative to the steel. Sliding: work of friction. Rates and shares per kg are of {:.4g} to {:.4g} s, {} kg fed and "
        "{} kg delivered.{}</p>\n",
        work.from, work.to, number(work.fed), number(work.delivered), prototype_text(length_ratio));
    if (work.since > 0.0)
        told += fmt::format("<p class=\"notice\">Counted from t = {:.4g} s on: an earlier program computed the run up to there.</p>\n",
                            work.since);
    return told +
           "<p>This tells which steel rock works on, not how much of it is lost: wear also takes the hardness of steel and rock. It holds "
           "no "
           "load on a pick and nothing of the cutting itself, which is not computed.</p>\n";
}

}  // namespace

std::string steel_section(const Results& results, const RunData& run, const Page& page) {
    const std::optional<SteelWork>& work = results.steel;
    if (!work) return "";
    std::string content = words(*work, run.operating_point.length_ratio);
    if (work->cutter)
        content += "<div class=\"figures\">" + map_of(*work, &SteelEnergy::impact, "Impact", "steel_impact", run, page) +
                   map_of(*work, &SteelEnergy::sliding, "Sliding", "steel_sliding", run, page) + "</div>";
    content += html::scrolling(wall_table(*work));
    if (work->cutter) content += html::scrolling(bin_table(*work));
    return html::section("What rock does to the steel", content);
}

}  // namespace cutterflow::postproc
