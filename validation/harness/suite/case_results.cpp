#include "validation/harness/suite/case_results.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "geometry/base/error.hpp"

namespace cutterflow::validation {
namespace {

constexpr std::array<std::pair<CaseVerdict, const char*>, 5> k_verdicts{{{CaseVerdict::pass, "pass"},
                                                                         {CaseVerdict::fail, "fail"},
                                                                         {CaseVerdict::not_converged, "not converged"},
                                                                         {CaseVerdict::skipped, "skipped"},
                                                                         {CaseVerdict::reported, "reported"}}};
constexpr std::array<std::pair<Rule, const char*>, 5> k_rules{{{Rule::relative, "relative"},
                                                               {Rule::absolute, "absolute"},
                                                               {Rule::at_most, "at most"},
                                                               {Rule::at_least, "at least"},
                                                               {Rule::none, "none"}}};

template <typename Table, typename Value>
const char* word_of(const Table& table, Value value) {
    return std::find_if(table.begin(), table.end(), [&](const auto& row) { return row.first == value; })->second;
}

template <typename Table>
auto value_of(const Table& table, const std::string& word) {
    const auto found = std::find_if(table.begin(), table.end(), [&](const auto& row) { return word == row.second; });
    if (found == table.end()) throw std::runtime_error("unknown word \"" + word + "\"");
    return found->first;
}

/// JSON has no infinity and no not-a-number: both become null.
nlohmann::json number_json(const std::optional<double>& value) {
    return value && std::isfinite(*value) ? nlohmann::json(*value) : nlohmann::json();
}

std::optional<double> number_from(const nlohmann::json& json, const char* key) {
    const nlohmann::json& value = json.at(key);
    return value.is_null() ? std::nullopt : std::optional<double>(value.get<double>());
}

VerifiedQuantity read_quantity(const nlohmann::json& json) {
    VerifiedQuantity quantity;
    quantity.name = json.at("quantity");
    quantity.unit = json.at("unit");
    quantity.reference = number_from(json, "reference");
    quantity.value = number_from(json, "value");
    quantity.error = number_from(json, "error");
    quantity.tolerance = number_from(json, "tolerance");
    quantity.aim = number_from(json, "aim");
    quantity.rule = value_of(k_rules, json.at("rule"));
    quantity.verdict = value_of(k_verdicts, json.at("verdict"));
    quantity.source = json.at("source");
    quantity.note = json.at("note");
    return quantity;
}

UserError not_a_result(const std::string& where, const std::string& what) {
    return UserError(
        {{where, what, "A result of `cutterflow verify` has every key of docs/design/009-verification.md", "Run the case again"}});
}

}  // namespace

void judge(VerifiedQuantity& quantity) {
    const double value = quantity.value.value_or(std::nan(""));
    const double tolerance = quantity.tolerance.value_or(std::nan(""));
    double error = value;
    if (quantity.rule == Rule::relative) error = std::abs(value / quantity.reference.value_or(std::nan("")) - 1.0);
    if (quantity.rule == Rule::absolute) error = std::abs(value - quantity.reference.value_or(std::nan("")));
    quantity.error = error;
    if (quantity.rule == Rule::none) return;
    const bool passed = quantity.rule == Rule::at_least ? error >= tolerance : error <= tolerance;
    quantity.verdict = passed ? CaseVerdict::pass : CaseVerdict::fail;
}

CaseVerdict VerifiedCase::verdict() const {
    if (failed_as_a_whole) return CaseVerdict::fail;
    const auto any = [&](CaseVerdict verdict) {
        return std::any_of(quantities.begin(), quantities.end(), [&](const VerifiedQuantity& q) { return q.verdict == verdict; });
    };
    // In this order: what passed beside a failure does not count.
    for (const CaseVerdict verdict : {CaseVerdict::fail, CaseVerdict::not_converged, CaseVerdict::pass, CaseVerdict::reported})
        if (any(verdict)) return verdict;
    return CaseVerdict::skipped;
}

std::string verdict_text(CaseVerdict verdict) {
    return word_of(k_verdicts, verdict);
}

nlohmann::json quantity_json(const VerifiedQuantity& quantity) {
    return {{"quantity", quantity.name},
            {"unit", quantity.unit},
            {"reference", number_json(quantity.reference)},
            {"value", number_json(quantity.value)},
            {"error", number_json(quantity.error)},
            {"tolerance", number_json(quantity.tolerance)},
            {"aim", number_json(quantity.aim)},
            {"rule", word_of(k_rules, quantity.rule)},
            {"verdict", verdict_text(quantity.verdict)},
            {"source", quantity.source},
            {"note", quantity.note}};
}

nlohmann::json case_json(const VerifiedCase& result) {
    nlohmann::json quantities = nlohmann::json::array();
    for (const VerifiedQuantity& quantity : result.quantities) quantities.push_back(quantity_json(quantity));
    nlohmann::json json = {
        {"case", result.name},     {"title", result.title},     {"class", result.effort},     {"verdict", verdict_text(result.verdict())},
        {"reason", result.reason}, {"quantities", quantities},  {"core_s", result.core_s},    {"wall_s", result.wall_s},
        {"date", result.date},     {"machine", result.machine}, {"programs", result.programs}};
    if (result.stopped) json["stopped"] = true;
    if (!result.exhibits.empty()) json["exhibits"] = exhibits_json(result.exhibits);
    return json;
}

VerifiedQuantity quantity_from_json(const nlohmann::json& json, const std::string& where) {
    try {
        return read_quantity(json);
    } catch (const std::exception& error) {
        throw not_a_result(where, error.what());
    }
}

VerifiedCase case_from_json(const std::string& text, const std::string& where) {
    try {
        const nlohmann::json json = nlohmann::json::parse(text);
        VerifiedCase result;
        result.name = json.at("case");
        result.title = json.at("title");
        result.effort = json.at("class");
        result.reason = json.at("reason");
        for (const nlohmann::json& quantity : json.at("quantities")) result.quantities.push_back(read_quantity(quantity));
        if (json.contains("exhibits")) result.exhibits = exhibits_from_json(json.at("exhibits"));
        result.failed_as_a_whole = json.at("verdict") == verdict_text(CaseVerdict::fail) && !result.reason.empty();
        result.stopped = json.value("stopped", false);
        result.core_s = json.at("core_s");
        result.wall_s = json.at("wall_s");
        result.date = json.at("date");
        result.machine = json.at("machine");
        result.programs = json.at("programs");
        return result;
    } catch (const std::exception& error) {
        throw not_a_result(where, error.what());
    }
}

}  // namespace cutterflow::validation
