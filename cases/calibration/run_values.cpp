#include "cases/calibration/run_values.hpp"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/json_document.hpp"
#include "geometry/base/run_files.hpp"

namespace cutterflow::cases {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* k_measure_results = "report/measures.json";

[[noreturn]] void refuse(const fs::path& file, const std::string& measure, const std::vector<std::string>& known, const char* rule) {
    const std::string nearest = nearest_word(measure, known);
    throw UserError({{file.string(), fmt::format("there is no measure {}", measure),
                      known.empty() ? std::string(rule) : fmt::format("{}: {}", rule, fmt::join(known, ", ")),
                      nearest.empty() ? "Correct target.measure" : fmt::format("Did you mean {}?", nearest)}});
}

std::vector<std::string> keys_of_object(const json& object) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.push_back(key);
    return keys;
}

/// Linear between the points of a profile, which are the middles of its columns. In the outer halves of the end columns it is their
/// height, beyond them 0.
double height_at(double place, const std::vector<double>& places, const std::vector<double>& heights) {
    if (places.size() < 2) return !places.empty() && place == places.front() ? heights.front() : 0.0;
    const std::size_t last = places.size() - 1;
    const double before = places[0] - 0.5 * (places[1] - places[0]), behind = places[last] + 0.5 * (places[last] - places[last - 1]);
    const double rounding = 1e-9 * (behind - before);
    if (place < before - rounding || place > behind + rounding) return 0.0;
    if (place >= places[last]) return heights[last];
    const auto after = std::upper_bound(places.begin(), places.end(), place) - places.begin();
    const auto i = static_cast<std::size_t>(after);
    if (i == 0) return heights.front();
    const double share = (place - places[i - 1]) / (places[i] - places[i - 1]);
    return (1.0 - share) * heights[i - 1] + share * heights[i];
}

std::vector<double> profile_of(const json& result, const Measured& measured, const fs::path& file) {
    const json& series = result.value("series", json());
    if (!series.is_object() || !series.contains("place_m") || !series.contains("height_m"))
        throw UserError({{file.string(), fmt::format("the measure {} has no profile", measured.measure),
                          "A target with a profile needs a measure with place_m and height_m", "Name a measure of what = \"profile\""}});
    const std::vector<double> places = series.at("place_m"), heights = series.at("height_m");
    std::vector<double> values;
    for (const double place : measured.places) values.push_back(height_at(place, places, heights));
    return values;
}

std::vector<double> measure_values(const fs::path& file, const Measured& measured) {
    const json document = read_json_document(file, {}, "Run it again");
    if (!document.contains(measured.measure)) refuse(file, measured.measure, keys_of_object(document), "Its measures are");
    const json& result = document.at(measured.measure);
    if (!result.contains("value") || !result.at("value").is_number()) return {};
    if (!measured.places.empty()) return profile_of(result, measured, file);
    return {result.at("value").get<double>()};
}

/// A number of results.json by its keys: "production.share". What a run has none of is null, with all that would be in it.
std::vector<double> result_values(const fs::path& file, const Measured& measured) {
    const json document = read_json_document(file, {}, "Run it again");
    const json* node = &document;
    std::istringstream keys(measured.measure);
    for (std::string key; std::getline(keys, key, '.');) {
        if (node->is_null()) return {};
        if (!node->is_object() || !node->contains(key))
            refuse(file, measured.measure, node->is_object() ? keys_of_object(*node) : std::vector<std::string>{}, "There are");
        node = &node->at(key);
    }
    if (node->is_number()) return {node->get<double>()};
    if (node->is_null()) return {};
    refuse(file, measured.measure, {}, "A target is a number");
}

}  // namespace

std::vector<double> run_values(const fs::path& run, const Measured& measured) {
    const fs::path measures = run / k_measure_results;
    return fs::exists(measures) ? measure_values(measures, measured) : result_values(run / names::results_json, measured);
}

std::string missing_reason(const fs::path& run, const Measured& measured) {
    const fs::path measures = run / k_measure_results;
    if (!fs::exists(measures)) return "";
    const json document = read_json_document(measures, {}, "Run it again");
    const json result = document.value(measured.measure, json::object());
    return result.value("detail", json::object()).value("reason", "");
}

}  // namespace cutterflow::cases
