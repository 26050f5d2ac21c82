#include "postproc/analysis/best_speed.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "postproc/analysis/choices.hpp"

namespace cutterflow::postproc {
namespace {

double speed_of(const Comparison& comparison, std::size_t setting) {
    return quantity_of(comparison, quantity::k_speed, setting).value.value_or(0.0);
}

double swing_of(const Comparison& comparison, std::size_t setting) {
    return quantity_of(comparison, quantity::k_swing, setting).value.value_or(0.0);
}

const Estimate& production_of(const Comparison& comparison, std::size_t setting) {
    return quantity_of(comparison, quantity::k_production, setting);
}

const Estimate& delivered_of(const Comparison& comparison, std::size_t setting) {
    return quantity_of(comparison, quantity::k_delivered, setting);
}

/// Spillage has a value only where the hold-up is steady.
bool is_known(const Comparison& comparison, std::size_t setting) {
    const Estimate& production = production_of(comparison, setting);
    return production.value && production.half_width && quantity_of(comparison, quantity::k_spillage, setting).value;
}

/// Whether the interval of a lies above that of b.
bool is_above(const Estimate& a, const Estimate& b) {
    return *a.value - *a.half_width > *b.value + *b.half_width;
}

/// Place in the series of the highest production. \pre all are known
std::size_t highest(const Comparison& comparison, const SpeedSeries& series) {
    const auto less = [&](std::size_t a, std::size_t b) {
        return *production_of(comparison, a).value < *production_of(comparison, b).value;
    };
    return static_cast<std::size_t>(std::max_element(series.settings.begin(), series.settings.end(), less) - series.settings.begin());
}

/// \pre all deliver a known amount
std::size_t most_delivered(const Comparison& comparison, const std::vector<std::size_t>& settings) {
    const auto less = [&](std::size_t a, std::size_t b) { return *delivered_of(comparison, a).value < *delivered_of(comparison, b).value; };
    return *std::max_element(settings.begin(), settings.end(), less);
}

/// Whether no setting turns, or none swings, slower or faster.
bool is_at_edge(const Comparison& comparison, const std::vector<std::size_t>& settings, std::size_t setting) {
    const auto is_end = [&](auto value) {
        const auto [low, high] = std::minmax_element(
            settings.begin(), settings.end(), [&](std::size_t a, std::size_t b) { return value(comparison, a) < value(comparison, b); });
        const double own = value(comparison, setting);
        return own == value(comparison, *low) || own == value(comparison, *high);
    };
    return is_end(speed_of) || is_end(swing_of);
}

bool all_known(const Comparison& comparison, const SpeedSeries& series) {
    return std::all_of(series.settings.begin(), series.settings.end(), [&](std::size_t setting) { return is_known(comparison, setting); });
}

std::string sentence(const Comparison& comparison, const SpeedSeries& series) {
    const std::string of = series.what.empty() ? "" : fmt::format(" ({})", series.what);
    const auto rpm = [&](std::size_t place) { return fmt::format("{:g} rpm", speed_of(comparison, series.settings[place])); };
    if (const auto best = best_speed(comparison, series))
        return fmt::format("Of these speeds {:g} rpm delivers most of what is fed{}: its interval is apart from its neighbours'.",
                           speed_of(comparison, *best), of);
    const std::string none = fmt::format("No optimum found within the error{}: ", of);
    if (series.same_speed)
        return none + fmt::format("more than one setting turns at {:g} rpm; compare one of each speed.", *series.same_speed);
    if (!all_known(comparison, series)) return none + "production is not steady, or has no interval, at every speed.";
    const std::size_t top = highest(comparison, series);
    if (top == 0 || top + 1 == series.settings.size())
        return none + fmt::format("production is highest at the end of the range, {}.", rpm(top));
    return none + fmt::format("production is highest at {}, but its interval is not apart from its neighbours'.", rpm(top));
}

}  // namespace

std::vector<SpeedSeries> speed_series(const Comparison& comparison) {
    const std::vector<std::string> rest = told_apart(comparison, {k_rotor_speed_key});
    std::map<std::string, SpeedSeries> by_rest;
    for (std::size_t setting = 0; setting < rest.size(); ++setting) by_rest[rest[setting]].settings.push_back(setting);
    std::vector<SpeedSeries> all;
    for (auto& [what, series] : by_rest) {
        if (series.settings.size() < 2) continue;
        series.what = what;
        std::stable_sort(series.settings.begin(), series.settings.end(),
                         [&](std::size_t a, std::size_t b) { return speed_of(comparison, a) < speed_of(comparison, b); });
        const auto same = std::adjacent_find(series.settings.begin(), series.settings.end(), [&](std::size_t a, std::size_t b) {
            return speed_of(comparison, a) == speed_of(comparison, b);
        });
        if (same != series.settings.end()) series.same_speed = speed_of(comparison, *same);
        all.push_back(series);
    }
    return all;
}

std::optional<std::size_t> best_speed(const Comparison& comparison, const SpeedSeries& series) {
    if (series.settings.size() < 3 || series.same_speed || !all_known(comparison, series)) return std::nullopt;
    const std::size_t top = highest(comparison, series);
    if (top == 0 || top + 1 == series.settings.size()) return std::nullopt;
    const Estimate& best = production_of(comparison, series.settings[top]);
    for (const std::size_t neighbour : {top - 1, top + 1})
        if (!is_above(best, production_of(comparison, series.settings[neighbour]))) return std::nullopt;
    return series.settings[top];
}

std::optional<std::size_t> best_point(const Comparison& comparison, const std::vector<std::size_t>& settings) {
    if (settings.empty() || !std::all_of(settings.begin(), settings.end(), [&](std::size_t i) { return is_known(comparison, i); }))
        return std::nullopt;
    const std::size_t best = most_delivered(comparison, settings);
    for (const std::size_t other : settings)
        if (other != best && !is_above(delivered_of(comparison, best), delivered_of(comparison, other))) return std::nullopt;
    return best;
}

std::string best_point_text(const Comparison& comparison, const std::vector<std::size_t>& settings) {
    const auto words = [&](std::size_t i) {
        return fmt::format("{:g} rpm with a swing of {:g} m/min", speed_of(comparison, i), swing_of(comparison, i));
    };
    if (const auto best = best_point(comparison, settings))
        return fmt::format("Of these points {} delivers most: its 95 % interval is apart from all others{}.", words(*best),
                           is_at_edge(comparison, settings, *best) ? ", but it lies at the edge of what was run" : "");
    const std::string none = "No best point within the error: ";
    if (!std::all_of(settings.begin(), settings.end(), [&](std::size_t i) { return is_known(comparison, i); }))
        return none + "delivery is not steady, or has no interval, at every point.";
    const std::size_t top = most_delivered(comparison, settings);
    const auto overlapping = std::count_if(settings.begin(), settings.end(), [&](std::size_t other) {
        return other != top && !is_above(delivered_of(comparison, top), delivered_of(comparison, other));
    });
    return none + fmt::format("the 95 % interval{} of {} other point{} overlap{} that of the largest value.", overlapping == 1 ? "" : "s",
                              overlapping, overlapping == 1 ? "" : "s", overlapping == 1 ? "s" : "");
}

std::vector<std::string> best_speed_text(const Comparison& comparison) {
    if (!scope_of(comparison).fed_by_cutting || !find_quantity(comparison, quantity::k_production)) return {};
    std::vector<std::string> sentences;
    for (const SpeedSeries& series : speed_series(comparison))
        if (series.settings.size() >= 3) sentences.push_back(sentence(comparison, series));
    return sentences;
}

}  // namespace cutterflow::postproc
