#include "postproc/pages/delivered_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "postproc/analysis/best_speed.hpp"
#include "postproc/analysis/choices.hpp"
#include "postproc/analysis/text.hpp"
#include "postproc/draw/html.hpp"

namespace cutterflow::postproc {
namespace {

constexpr double k_px_of_label = 44.0, k_px_of_frame = 90.0;  // of a number, and of what stands beside the cells

double value_of(const Comparison& comparison, const char* key, std::size_t setting) {
    return *quantity_of(comparison, key, setting).value;
}

/// Settings that differ in nothing but the two speeds.
struct MapGroup {
    std::string what;  ///< that they have in common
    std::vector<std::size_t> settings;
};

std::vector<MapGroup> groups_of(const Comparison& comparison) {
    const std::vector<std::string> rest = told_apart(comparison, {k_rotor_speed_key, k_swing_speed_key});
    std::map<std::string, MapGroup> by_rest;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        if (!quantity_of(comparison, quantity::k_delivered, i).value || !quantity_of(comparison, quantity::k_swing, i).value) continue;
        by_rest[rest[i]].what = rest[i];
        by_rest[rest[i]].settings.push_back(i);
    }
    std::vector<MapGroup> groups;
    for (const auto& item : by_rest) groups.push_back(item.second);
    return groups;
}

std::set<double> distinct_values(const Comparison& comparison, const MapGroup& group, const char* key) {
    std::set<double> values;
    for (const std::size_t i : group.settings) values.insert(value_of(comparison, key, i));
    return values;
}

/// Whether there are settings enough at two or more values of each speed.
bool make_a_map(const Comparison& comparison, const MapGroup& group) {
    return group.settings.size() >= k_fewest_of_map && distinct_values(comparison, group, quantity::k_speed).size() > 1 &&
           distinct_values(comparison, group, quantity::k_swing).size() > 1;
}

/// Distinct values along an axis, each with the ends of its cells: half-way to its neighbours. \pre two or more
std::map<double, std::pair<double, double>> cells_along(const Comparison& comparison, const MapGroup& group, const char* key) {
    const std::set<double> distinct = distinct_values(comparison, group, key);
    const std::vector<double> values(distinct.begin(), distinct.end());
    std::map<double, std::pair<double, double>> cells;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const bool is_first = i == 0, is_last = i + 1 == values.size();
        const double below = 0.5 * (is_first ? values[1] - values[0] : values[i] - values[i - 1]),
                     above = 0.5 * (is_last ? values[i] - values[i - 1] : values[i + 1] - values[i]);
        cells[values[i]] = {values[i] - below, values[i] + above};
    }
    return cells;
}

/// Whether no two settings stand at one place: such differ in what a map does not show.
bool have_places_of_their_own(const Comparison& comparison, const MapGroup& group) {
    std::set<std::pair<double, double>> places;
    for (const std::size_t i : group.settings)
        places.emplace(value_of(comparison, quantity::k_speed, i), value_of(comparison, quantity::k_swing, i));
    return places.size() == group.settings.size();
}

/// Colour of a share of the largest value, between those of the palette.
std::string colour_of(double share) {
    constexpr std::size_t steps = std::size(palette::field) - 1;
    const double at = std::clamp(share, 0.0, 1.0) * steps;
    const std::size_t step = std::min(static_cast<std::size_t>(at), steps - 1);
    std::string colour = "#";
    for (std::size_t i = 1; i < 7; i += 2) {
        const auto part = [&](std::size_t k) { return std::stoi(std::string(palette::field[k]).substr(i, 2), nullptr, 16); };
        const double mixed = part(step) + (at - static_cast<double>(step)) * (part(step + 1) - part(step));
        colour += fmt::format("{:02x}", std::lround(mixed));
    }
    return colour;
}

std::string tip_of(const Comparison& comparison, std::size_t i) {
    const Estimate& delivered = quantity_of(comparison, quantity::k_delivered, i);
    std::string tip = fmt::format("{:g} rpm, {:g} m/min: {:.3g}", value_of(comparison, quantity::k_speed, i),
                                  value_of(comparison, quantity::k_swing, i), *delivered.value);
    tip += delivered.half_width ? fmt::format(" ± {:.2g} m³/h", *delivered.half_width) : " m³/h, its error is not known";
    return quantity_of(comparison, quantity::k_spillage, i).value ? tip : tip + ", the hold-up still changes";
}

void set_axis(Axis& axis, const char* title, const std::map<double, std::pair<double, double>>& cells) {
    axis.title = title;
    axis.grid = false;
    axis.from = cells.begin()->second.first;
    axis.to = cells.rbegin()->second.second;
    for (const auto& cell : cells) axis.ticks.push_back({cell.first, fmt::format("{:g}", cell.first)});
}

Plot map_of(const Comparison& comparison, const MapGroup& group) {
    const auto speeds = cells_along(comparison, group, quantity::k_speed), swings = cells_along(comparison, group, quantity::k_swing);
    double largest = 0.0;
    for (const std::size_t i : group.settings) largest = std::max(largest, value_of(comparison, quantity::k_delivered, i));
    Plot plot;
    plot.tips = Tips::at_point;
    plot.legend = Legend::none;
    set_axis(plot.x, "rotor speed, rpm", speeds);
    set_axis(plot.y, "swing speed, m/min", swings);
    const double px_per_rpm = (plot.width - k_px_of_frame) / (*plot.x.to - *plot.x.from);
    for (const std::size_t i : group.settings) {
        const auto [from, to] = speeds.at(value_of(comparison, quantity::k_speed, i));
        const auto [low, high] = swings.at(value_of(comparison, quantity::k_swing, i));
        const double value = value_of(comparison, quantity::k_delivered, i), share = largest > 0.0 ? value / largest : 0.0;
        const bool has_room = (to - from) * px_per_rpm >= k_px_of_label;
        plot.bars.push_back({from, to, 0.5 * (low + high), high - low, colour_of(share), tip_of(comparison, i),
                             has_room ? fmt::format("{:.3g}", value) : "", share > 0.6 ? "white" : palette::ink});
    }
    return plot;
}

}  // namespace

std::vector<Figure> delivered_maps(const Comparison& comparison) {
    std::vector<Figure> figures;
    if (!find_quantity(comparison, quantity::k_delivered)) return figures;
    for (const MapGroup& group : groups_of(comparison)) {
        if (!make_a_map(comparison, group) || !have_places_of_their_own(comparison, group)) continue;
        Plot plot = map_of(comparison, group);
        plot.name = fmt::format("delivered_map_{}", figures.size() + 1);
        figures.push_back(
            {plot,
             fmt::format("Soil delivered, m³/h in its volume in the bank and in the model’s scale, over rotor speed and swing "
                         "speed{}: the darker, the more. A cell reaches half-way to the next speeds that were run; where none "
                         "was run the map is empty. {}",
                         group.what.empty() ? "" : " (" + html::escape(group.what) + ")",
                         html::escape(best_point_text(comparison, group.settings))),
             ""});
    }
    return figures;
}

}  // namespace cutterflow::postproc
