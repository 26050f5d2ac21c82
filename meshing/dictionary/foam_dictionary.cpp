#include "meshing/dictionary/foam_dictionary.hpp"
#include "geometry/base/file_content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace cutterflow::meshing {
namespace {

constexpr std::size_t k_indent = 4;
constexpr std::size_t k_key_width = 16;
constexpr std::size_t k_line_length = 100;

bool brackets_balanced(const std::string& text) {
    int depth = 0;
    for (const char c : text) {
        if (c == '(') ++depth;
        if (c == ')' && --depth < 0) return false;
    }
    return depth == 0;
}

/// What OpenFOAM reads as one word: no white space, quote, slash, semicolon or brace; round brackets in pairs, not in front.
bool is_word(const std::string& text) {
    if (text.empty() || text.front() == '(' || text.front() == '#' || text.front() == '$') return false;
    const bool clean =
        std::none_of(text.begin(), text.end(), [](unsigned char c) { return c <= ' ' || std::strchr("\"'/;{}[]", c) != nullptr; });
    return clean && brackets_balanced(text);
}

const std::string& require_word(const std::string& text) {
    if (!is_word(text)) throw std::invalid_argument("'" + text + "' is not a word of an OpenFOAM dictionary");
    return text;
}

std::string quote(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '\n') throw std::invalid_argument("a quoted text of an OpenFOAM dictionary must not contain a line end");
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + '"';
}

std::string number_text(double number) {
    if (!std::isfinite(number)) throw std::invalid_argument("an OpenFOAM dictionary holds finite numbers only");
    return fmt::format("{}", number);
}

std::string spaces(std::size_t n) {
    return std::string(n, ' ');
}

}  // namespace

FoamDictionary::FoamDictionary() = default;
FoamDictionary::FoamDictionary(const FoamDictionary&) = default;
FoamDictionary::FoamDictionary(FoamDictionary&&) noexcept = default;
FoamDictionary& FoamDictionary::operator=(const FoamDictionary&) = default;
FoamDictionary& FoamDictionary::operator=(FoamDictionary&&) noexcept = default;
FoamDictionary::~FoamDictionary() = default;

FoamDictionary& FoamDictionary::append(std::string written_key, FoamValue value) {
    const bool known = std::any_of(entries_.begin(), entries_.end(), [&](const FoamEntry& e) { return e.key == written_key; });
    if (known) throw std::invalid_argument("the key '" + written_key + "' occurs twice in one OpenFOAM dictionary");
    entries_.push_back({std::move(written_key), {std::move(value)}});
    return *this;
}

FoamDictionary& FoamDictionary::add(const std::string& key, FoamValue value) {
    return append(require_word(key), std::move(value));
}

FoamDictionary& FoamDictionary::add_pattern(const std::string& pattern, FoamValue value) {
    return append(quote(pattern), std::move(value));
}

FoamDictionary& FoamDictionary::add_flag(const std::string& key) {
    append(require_word(key), true);
    entries_.back().values.clear();
    return *this;
}

bool FoamDictionary::empty() const {
    return entries_.empty();
}

std::string FoamDictionary::text(std::size_t indent) const {
    std::string result;
    for (const FoamEntry& entry : entries_) {
        result += spaces(indent) + entry.key;
        if (entry.values.empty()) {
            result += ";\n";
        } else if (const FoamValue& value = entry.values.front(); value.is_dictionary()) {
            result += '\n' + spaces(indent) + value.text(indent) + '\n';
        } else {
            // At least one space: without it OpenFOAM reads an opening bracket as part of the key.
            result += spaces(entry.key.size() < k_key_width ? k_key_width - entry.key.size() : 1) + value.text(indent) + ";\n";
        }
    }
    return result;
}

FoamValue::FoamValue(double number) : plain_(number_text(number)) {}
FoamValue::FoamValue(int number) : plain_(std::to_string(number)) {}
FoamValue::FoamValue(std::int64_t number) : plain_(std::to_string(number)) {}
FoamValue::FoamValue(std::size_t number) : plain_(std::to_string(number)) {}
FoamValue::FoamValue(const Vec3& v) : plain_(fmt::format("({} {} {})", number_text(v.x()), number_text(v.y()), number_text(v.z()))) {}
FoamValue::FoamValue(const std::string& word) : plain_(require_word(word)) {}
FoamValue::FoamValue(const char* word) : FoamValue(std::string(word)) {}
FoamValue::FoamValue(FoamDictionary dictionary) : kind_(Kind::dictionary), dictionary_(std::move(dictionary)) {}
FoamValue::FoamValue(Kind kind, std::vector<FoamValue> items) : kind_(kind), items_(std::move(items)) {}

FoamValue FoamValue::quoted(const std::string& text) {
    FoamValue value(true);
    value.plain_ = quote(text);
    return value;
}

FoamValue FoamValue::list(std::vector<FoamValue> items) {
    return FoamValue(Kind::list, std::move(items));
}

FoamValue FoamValue::sequence(std::vector<FoamValue> items) {
    if (items.empty()) throw std::invalid_argument("a sequence of an OpenFOAM dictionary needs one item or more");
    return FoamValue(Kind::sequence, std::move(items));
}

FoamValue FoamValue::dimensions(const std::array<int, 7>& exponents) {
    FoamValue value(true);
    value.plain_ = fmt::format("[{}]", fmt::join(exponents, " "));
    return value;
}

FoamValue FoamValue::raw(const std::string& tokens) {
    const bool clean = std::none_of(tokens.begin(), tokens.end(), [](char c) { return std::strchr(";{}\n", c) != nullptr; });
    if (tokens.empty() || !clean || !brackets_balanced(tokens))
        throw std::invalid_argument("'" + tokens + "' cannot be written unquoted in an OpenFOAM dictionary");
    FoamValue value(true);
    value.plain_ = tokens;
    return value;
}

std::string FoamValue::text(std::size_t indent) const {
    switch (kind_) {
        case Kind::plain:
            return plain_;
        case Kind::dictionary:
            return "{\n" + dictionary_.text(indent + k_indent) + spaces(indent) + "}";
        case Kind::sequence: {
            std::string result;
            for (const FoamValue& item : items_) result += (result.empty() ? "" : " ") + item.text(indent);
            return result;
        }
        case Kind::list: {
            std::string line, lines;
            for (const FoamValue& item : items_) {
                const std::string part = item.text(indent + k_indent);
                line += (line.empty() ? "" : " ") + part;
                lines += spaces(indent + k_indent) + part + '\n';
            }
            if (line.size() <= k_line_length && line.find('\n') == std::string::npos) return "(" + line + ")";
            return "(\n" + lines + spaces(indent) + ")";
        }
    }
    return {};
}

std::string foam_file_text(const std::string& foam_class, const std::string& object, const FoamDictionary& contents) {
    FoamDictionary header;
    header.add("version", 2.0).add("format", "ascii").add("class", foam_class).add("object", object);
    return "FoamFile\n{\n" + header.text(k_indent) + "}\n\n" + contents.text();
}

void write_foam_file(const std::filesystem::path& path, const std::string& foam_class, const FoamDictionary& contents) {
    write_file(path, foam_file_text(foam_class, path.filename().string(), contents));
}

}  // namespace cutterflow::meshing
