#include "postproc/analysis/measures/measure_run.hpp"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "geometry/base/json_document.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/parameters/parameter.hpp"
#include "postproc/analysis/measures/measure_kinds.hpp"
#include "postproc/analysis/measures/measure_source.hpp"
#include "postproc/analysis/measures/measure_table.hpp"

namespace cutterflow::postproc {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int k_deepest = 20;  ///< of nested values

json read_list(const fs::path& file) {
    if (!fs::is_regular_file(file))
        throw UserError({{file.string(), "there is no such file", "It says what is measured",
                          "Name the directory of a run whose study has [[measure]], or write the file"}});
    bool too_deep = false;
    json list = json::parse(
        read_file(file),
        [&](int depth, json::parse_event_t, const json&) {
            too_deep = too_deep || depth > k_deepest;
            return !too_deep;
        },
        false);
    if (too_deep || list.is_discarded())
        throw UserError(
            {{file.string(), "this is no JSON", fmt::format("A list of tables, nested at most {} deep", k_deepest), "Correct it"}});
    return list;
}

/// The measure of a name; without a name all of them. \throws UserError  when there is none of this name
json chosen(const json& measures, const std::optional<std::string>& name, const fs::path& file) {
    if (!name) return measures;
    std::vector<std::string> names;
    for (const json& measure : measures) {
        if (!measure.is_object() || !measure.contains("name") || !measure["name"].is_string()) continue;
        names.push_back(measure["name"].get<std::string>());
        if (names.back() == *name) return json::array({measure});
    }
    const std::string nearest = nearest_word(*name, names);
    throw UserError({{file.string(), fmt::format("there is no measure {}", *name), fmt::format("It has {}", fmt::join(names, ", ")),
                      nearest.empty() ? "Name one of them" : fmt::format("Did you mean {}?", nearest)}});
}

json to_json(const MeasureValues& values, const MeasureOutcome& outcome) {
    return {{"what", values.kind().what}, {"value", outcome.value ? json(*outcome.value) : json(nullptr)},
            {"unit", outcome.unit},       {"standard_error", outcome.standard_error ? json(*outcome.standard_error) : json(nullptr)},
            {"detail", outcome.detail},   {"series", outcome.series}};
}

/// Receives a measure that the run's files do not allow. \return its result, if it shall have one
using OnRefusal = std::function<std::optional<MeasureOutcome>(const MeasureValues&, const UserError&)>;

/// \throws UserError  with every mistake of measures.json
json made(const fs::path& run_directory, const std::optional<std::string>& name, Mistakes& mistakes, const OnRefusal& refused) {
    const MeasureSource source(run_directory);
    const fs::path file = run_directory / k_measures;
    const json measures = read_list(file);
    json results = json::object();
    mistakes.add(check_measures(measures, file.string()));
    if (!measures.is_array()) mistakes.refuse();
    if (measures.empty())
        mistakes.add({file.string(), "it names no measure", "Something is measured", "Give the study a [[measure]], or write one"});
    json to_make = json::array();
    mistakes.gather([&] { to_make = chosen(measures, name, file); });
    for (const json& measure : to_make) {
        if (!check_measures(json::array({measure})).empty()) continue;  // told
        const MeasureValues values(measure);
        try {
            results[values.name()] = to_json(values, values.kind().measure(source, values));
        } catch (const UserError& error) {
            if (const auto outcome = refused(values, error)) results[values.name()] = to_json(values, *outcome);
        }
    }
    mistakes.refuse();
    return results;
}

void write_results(const fs::path& run_directory, const json& results) {
    write_file(run_directory / k_measure_results, results.dump(1) + "\n");
}

}  // namespace

bool has_measures(const fs::path& run_directory) {
    return fs::is_regular_file(run_directory / k_measures) && read_list(run_directory / k_measures) != json::array();
}

json measure_run(const fs::path& run_directory, const std::optional<std::string>& name) {
    Mistakes mistakes;
    json results = made(run_directory, name, mistakes, [&](const MeasureValues& values, const UserError& error) {
        for (Mistake mistake : error.mistakes()) {
            mistake.what = fmt::format("measure.{}: {}", values.name(), mistake.what);
            mistakes.add(std::move(mistake));
        }
        return std::nullopt;
    });
    mistakes.refuse();
    return results;
}

json write_measures(const fs::path& run_directory, const std::optional<std::string>& name) {
    json results = measure_run(run_directory, name);
    if (name && fs::exists(run_directory / k_measure_results)) {
        json all = read_measures(run_directory);
        all[*name] = results[*name];
        results = std::move(all);
    }
    write_results(run_directory, results);
    return results;
}

json write_possible_measures(const fs::path& run_directory) {
    Mistakes mistakes;
    json results = made(run_directory, std::nullopt, mistakes, [](const MeasureValues& values, const UserError& error) {
        MeasureOutcome none;
        none.unit = values.kind().unit;
        none.detail = {{"reason", fmt::format("{}: {}", error.mistakes().front().what, error.mistakes().front().rule)}};
        return none;
    });
    write_results(run_directory, results);
    return results;
}

json read_measures(const fs::path& run_directory) {
    const fs::path file = run_directory / k_measure_results;
    const std::string remedy = "Make it anew with cutterflow measure";
    std::vector<JsonField> fields;
    const json unchecked = read_json_document(file, {}, remedy);
    for (const auto& [name, result] : unchecked.items()) {
        fields.push_back({name + "/what", JsonKind::text, true});
        fields.push_back({name + "/value", JsonKind::number_or_null, true});
        fields.push_back({name + "/unit", JsonKind::text, true});
        fields.push_back({name + "/standard_error", JsonKind::number_or_null, true});
        fields.push_back({name + "/detail", JsonKind::object, true});
    }
    return read_json_document(file, fields, remedy);
}

std::string measure_value_text(const json& result) {
    if (result.at("value").is_null()) return "-";
    const std::string unit = result.at("unit") == "-" ? "" : " " + result.at("unit").get<std::string>();
    const std::string error =
        result.at("standard_error").is_null() ? "" : fmt::format(" +- {:.2g}", result.at("standard_error").get<double>());
    return fmt::format("{:.5g}{}{}", result.at("value").get<double>(), error, unit);
}

std::string measures_text(const json& results) {
    std::size_t width = 0;
    for (const auto& [name, result] : results.items()) width = std::max(width, name.size());
    std::string text;
    for (const auto& [name, result] : results.items()) {
        text += fmt::format("{:<{}}  {:<13} {}", name, width, result.at("what").get<std::string>(), measure_value_text(result));
        if (result.at("detail").contains("reason")) text += fmt::format("  ({})", result["detail"]["reason"].get<std::string>());
        text += '\n';
    }
    return text + "value +- standard error\n";
}

}  // namespace cutterflow::postproc
