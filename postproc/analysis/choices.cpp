#include "postproc/analysis/choices.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include <fmt/format.h>

namespace cutterflow::postproc {
namespace {

constexpr const char* k_cutter_key = "cutter, SHA-256";

const RunData& first_run(const Comparison& comparison, std::size_t setting) {
    return comparison.runs[comparison.settings[setting].runs.front()].run;
}

/// Rank of a key in a setting's words.
std::size_t rank_of(const std::string& key) {
    constexpr const char* first[] = {k_cutter_key, k_rotor_speed_key, k_discharge_key, k_swing_speed_key};
    return static_cast<std::size_t>(std::find(std::begin(first), std::end(first), key) - std::begin(first));
}

/// A value of a key in words.
std::string words(const Comparison& comparison, std::size_t setting, const std::string& key, const std::string& value) {
    if (key == k_cutter_key) {
        const std::string file = first_run(comparison, setting).geometry.value("file", std::string());
        return file.empty() ? "cutter " + value : std::filesystem::path(file).filename().string();
    }
    if (value.empty()) return "without " + key;
    if (key == k_rotor_speed_key) return value + " rpm";
    if (key == k_discharge_key) return value + " m³/s";
    if (key == k_swing_speed_key) return fmt::format("swing {} m/min", value);
    if (key == "mesh.preset") return value + " mesh";
    return fmt::format("{} = {}", key, value);
}

/// The name before what a sweep adds to it; empty where there is none.
std::string sweep_of(const RunData& run) {
    const std::string& name = run.operating_point.study_name;
    const std::size_t colon = name.find(": ");
    return colon == std::string::npos ? "" : name.substr(0, colon);
}

}  // namespace

std::map<std::string, std::vector<std::string>> chosen_keys(const Comparison& comparison) {
    std::map<std::string, std::vector<std::string>> keys = differing_keys(comparison);
    for (auto item = keys.begin(); item != keys.end();) {
        const std::string& key = item->first;
        const bool follows = key.rfind("run.", 0) == 0 || key.rfind("report.", 0) == 0 || key == "rock.youngs_modulus_pa";
        item = follows ? keys.erase(item) : std::next(item);
    }
    return keys;
}

std::vector<std::string> told_apart(const Comparison& comparison, const std::set<std::string>& along) {
    std::vector<std::pair<std::string, std::vector<std::string>>> keys;
    for (const auto& [key, values] : chosen_keys(comparison))
        if (along.count(key) == 0) keys.emplace_back(key, values);
    std::stable_sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return rank_of(a.first) < rank_of(b.first); });
    std::vector<std::string> texts(comparison.settings.size());
    for (const auto& [key, values] : keys) {
        std::vector<std::string> longer = texts;
        for (std::size_t i = 0; i < texts.size(); ++i) longer[i] += (texts[i].empty() ? "" : ", ") + words(comparison, i, key, values[i]);
        const auto groups = [](const std::vector<std::string>& of) { return std::set<std::string>(of.begin(), of.end()).size(); };
        if (groups(longer) > groups(texts)) texts = longer;
    }
    return texts;
}

void call_by_choice(Comparison& comparison) {
    const std::vector<std::string> choices = told_apart(comparison);
    if (std::set<std::string>(choices.begin(), choices.end()).size() < comparison.settings.size()) return;
    const std::string sweep = sweep_of(first_run(comparison, 0));
    const bool all_replays = scope_of(comparison).replays == Replays::all;
    for (std::size_t i = 0; i < comparison.settings.size(); ++i)
        if (sweep.empty() || sweep_of(first_run(comparison, i)) != sweep) return;
    for (std::size_t i = 0; i < comparison.settings.size(); ++i)
        comparison.settings[i].label = choices[i] + (!all_replays && first_run(comparison, i).flow ? k_replayed : "");
}

}  // namespace cutterflow::postproc
