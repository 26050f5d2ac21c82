#include "geometry/base/json_document.hpp"

#include <cstdint>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"

namespace cutterflow {
namespace {

using nlohmann::json;

constexpr int k_deepest = 100;       // copying and writing a document recurse
constexpr std::size_t k_shown = 60;  // characters of a wrong value
constexpr const char* k_every_item = "*";

bool is_whole(const json& value) {
    constexpr auto largest = static_cast<std::uint64_t>(std::numeric_limits<int>::max());
    if (value.is_number_unsigned()) return value.get<std::uint64_t>() <= largest;
    return value.is_number_integer() && value.get<std::int64_t>() >= 0;  // values from a file are unsigned unless negative
}

bool is_of(JsonKind kind, const json& value) {
    switch (kind) {
        case JsonKind::object:
            return value.is_object();
        case JsonKind::text:
            return value.is_string();
        case JsonKind::truth:
            return value.is_boolean();
        case JsonKind::number:
            return value.is_number();
        case JsonKind::number_or_null:
            return value.is_number() || value.is_null();
        case JsonKind::whole:
            return is_whole(value);
        case JsonKind::whole_or_null:
            return is_whole(value) || value.is_null();
    }
    return false;
}

const char* rule_of(JsonKind kind) {
    switch (kind) {
        case JsonKind::object:
            return "It is an object";
        case JsonKind::text:
            return "It is a text";
        case JsonKind::truth:
            return "It is true or false";
        case JsonKind::number:
            return "It is a number";
        case JsonKind::number_or_null:
            return "It is a number or null";
        case JsonKind::whole:
            return "It is a whole number from 0 to 2147483647";
        case JsonKind::whole_or_null:
            return "It is a whole number from 0 to 2147483647, or null";
    }
    return "";
}

std::string shown(const json& value) {
    std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    if (text.size() > k_shown) text = text.substr(0, k_shown) + "...";
    return text;
}

/// Finds the mistakes of a document.
class DocumentCheck {
public:
    DocumentCheck(std::string file, std::string remedy) : file_(std::move(file)), remedy_(std::move(remedy)) {}

    void check(const json& document, const JsonField& field) { check(document, "", field.place, field); }
    std::vector<Mistake> take() { return std::move(mistakes_); }

private:
    /// \param at  where `value` is in the document
    /// \param left  what is left of the field's place from there
    void check(const json& value, const std::string& at, const std::string& left, const JsonField& field) {
        if (left.empty()) {
            if (!is_of(field.kind, value)) miss(fmt::format("{} = {}", at, shown(value)), rule_of(field.kind));
            return;
        }
        const std::size_t slash = left.find('/');
        const std::string key = left.substr(0, slash), rest = slash == std::string::npos ? "" : left.substr(slash + 1);
        if (key == k_every_item) {
            if (!value.is_array()) return miss(fmt::format("{} = {}", at, shown(value)), "It is an array");
            for (std::size_t i = 0; i < value.size(); ++i) check(value[i], fmt::format("{}[{}]", at, i), rest, field);
            return;
        }
        if (!value.is_object()) return miss(fmt::format("{} = {}", at, shown(value)), "It is an object");
        const std::string place = at.empty() ? key : fmt::format("{}.{}", at, key);
        if (const auto found = value.find(key); found != value.end()) return check(*found, place, rest, field);
        if (field.required) miss(fmt::format("{} is missing", place), rest.empty() ? rule_of(field.kind) : "The file holds it");
    }

    /// Fields of one object share its mistake.
    void miss(const std::string& what, const std::string& rule) {
        if (said_.insert(what).second) mistakes_.push_back({file_, what, rule, remedy_});
    }

    std::string file_, remedy_;
    std::set<std::string> said_;
    std::vector<Mistake> mistakes_;
};

}  // namespace

json read_json_document(const std::filesystem::path& file, const std::vector<JsonField>& fields, const std::string& remedy) {
    const auto refuse = [&](const std::string& what, const std::string& rule) { throw UserError({{file.string(), what, rule, remedy}}); };
    if (!std::filesystem::is_regular_file(file)) refuse("the file cannot be read", "It must be there and readable");
    bool too_deep = false;
    json document = json::parse(
        read_file(file),
        [&](int depth, json::parse_event_t, const json&) {
            too_deep = too_deep || depth > k_deepest;
            return !too_deep;
        },
        false);
    if (too_deep) refuse("its values are nested too deeply", fmt::format("At most {} levels are read", k_deepest));
    if (!document.is_object()) refuse("this is not a JSON object", "The file is one as Cutterflow writes it");
    DocumentCheck check(file.string(), remedy);
    for (const JsonField& field : fields) check.check(document, field);
    std::vector<Mistake> mistakes = check.take();
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    return document;
}

}  // namespace cutterflow
