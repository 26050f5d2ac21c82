#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/parameters/parameter.hpp"
#include "geometry/base/parameters/parameter_words.hpp"

namespace cutterflow {
namespace {

using namespace parameter_words;

/// Text in lines of at most `width` characters, each after `lead`.
std::string wrapped(const std::string& text, const std::string& lead, std::size_t width) {
    std::istringstream words(text);
    std::string result;
    std::string line;
    for (std::string word; words >> word;) {
        if (!line.empty() && lead.size() + line.size() + 1 + word.size() > width) {
            result += lead + line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return line.empty() ? result : result + lead + line + "\n";
}

/// What a value may be, in a few words: bounds, choices or type.
std::string allowed_text(const Parameter& parameter) {
    if (parameter.kind == ParameterKind::choice) return join(parameter.choices, " | ");
    const std::string bounds = bounds_text(parameter);
    const std::string kind = kind_text(parameter.kind);
    if (bounds.empty()) return with_unit(parameter, kind);
    return parameter.kind == ParameterKind::integer ? kind + ", " + bounds : bounds;
}

std::string default_text(const Parameter& parameter) {
    if (parameter.default_value) return toml_text(*parameter.default_value);
    if (!parameter.optional) return "required";
    return parameter.derived_from.empty() ? "none" : parameter.derived_from;
}

std::string comment_of(const Parameter& parameter) {
    std::string text = wrapped(parameter.help, "# ", 110);
    std::string facts = allowed_text(parameter);
    if (parameter.default_value) facts += "; default " + default_text(parameter);
    if (!parameter.default_value && !parameter.optional) facts += "; required";
    if (!parameter.default_value && parameter.optional && !parameter.derived_from.empty())
        facts += "; without it: " + parameter.derived_from;
    return text + wrapped("(" + facts + ")", "# ", 110);
}

std::string entry_of(const Parameter& parameter, const ParameterValues* values) {
    const std::string name = name_of(parameter.key);
    if (values != nullptr && values->has(parameter.key)) return fmt::format("{} = {}\n", name, toml_text(*values->find(parameter.key)));
    if (parameter.default_value) return fmt::format("{} = {}\n", name, toml_text(*parameter.default_value));
    return fmt::format("# {} =\n", name);
}

std::string entries_of(const ParameterTable& table, const std::string& section, const ParameterValues* values) {
    std::string text;
    for (const Parameter& parameter : table)
        if (section_of(parameter.key) == section) text += comment_of(parameter) + entry_of(parameter, values);
    return text;
}

std::string repeated_toml(const ParameterTable& table, const std::string& section, const ParameterValues* values);

/// The values of a section, without comments.
std::string values_of(const ParameterTable& table, const std::string& section, const ParameterValues& values) {
    std::string text;
    for (const Parameter& parameter : table)
        if (section_of(parameter.key) == section && values.has(parameter.key)) text += entry_of(parameter, &values);
    return text;
}

/// Sections of the file outside its arrays (array ""), or of one table of an array: those that have values.
std::string sections_within(const ParameterTable& table, const std::string& array, const ParameterValues& values) {
    std::string text;
    for (const std::string& section : sections_of(table)) {
        if (section.empty() || is_repeated_section(table, section) || enclosing_array(table, section) != array) continue;
        if (const std::string entries = values_of(table, section, values); !entries.empty())
            text += fmt::format("\n[{}]\n", section) + entries;
    }
    return text;
}

/// Arrays of tables directly inside `section`.
std::string nested_toml(const ParameterTable& table, const std::string& section, const ParameterValues* values) {
    std::string text;
    for (const std::string& inner : repeated_sections(table, section)) text += repeated_toml(table, inner, values);
    return text;
}

std::string repeated_toml(const ParameterTable& table, const std::string& section, const ParameterValues* values) {
    if (values == nullptr)
        return fmt::format("\n[[{}]]\n", section) + entries_of(table, section, nullptr) + nested_toml(table, section, nullptr);
    std::string text;
    for (const ParameterValues& member : values->tables(section))
        text += fmt::format("\n[[{}]]\n", section) + entries_of(table, section, &member) + sections_within(table, section, member) +
                nested_toml(table, section, &member);
    return text;
}

std::string plain_part(const ParameterTable& table, const std::string& array, const ParameterValues& values) {
    std::string text = values_of(table, array, values) + sections_within(table, array, values);
    for (const std::string& inner : repeated_sections(table, array))
        for (const ParameterValues& member : values.tables(inner))
            text += fmt::format("\n[[{}]]\n", inner) + plain_part(table, inner, member);
    return text;
}

std::string heading_of(const ParameterTable& table, const std::string& section) {
    if (section.empty()) return "top of the file";
    return is_repeated_section(table, section) ? "[[" + section + "]]" : "[" + section + "]";
}

std::string markdown_cell(std::string text) {
    for (std::size_t i = text.find('|'); i != std::string::npos; i = text.find('|', i + 2)) text.insert(i, "\\");
    return text;
}

}  // namespace

std::vector<std::string> repeated_sections(const ParameterTable& table, const std::string& section) {
    std::vector<std::string> repeated;
    for (const std::string& inner : sections_of(table))
        if (is_repeated_section(table, inner) && enclosing_array(table, inner) == section) repeated.push_back(inner);
    return repeated;
}

std::string toml_text(const ParameterValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *integer);
    if (const auto* text = std::get_if<std::string>(&value)) return quoted(*text);
    if (const auto* numbers = std::get_if<std::vector<double>>(&value)) return fmt::format("[{}]", fmt::join(*numbers, ", "));
    if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) {
        std::vector<std::string> written;
        for (const std::string& text : *texts) written.push_back(quoted(text));
        return "[" + join(written, ", ") + "]";
    }
    return std::get<bool>(value) ? "true" : "false";
}

std::string commented_toml(const ParameterTable& table, const ParameterValues* values) {
    std::string text;
    for (const std::string& section : sections_of(table)) {
        if (is_repeated_section(table, section) || !enclosing_array(table, section).empty()) continue;
        if (!section.empty()) text += fmt::format("{}[{}]\n", text.empty() ? "" : "\n", section);
        text += entries_of(table, section, values);
    }
    return text + nested_toml(table, "", values);
}

std::string plain_toml(const ParameterTable& table, const ParameterValues& values) {
    return plain_part(table, "", values);
}

std::string parameters_text(const ParameterTable& table) {
    std::string text;
    for (const std::string& section : sections_of(table)) {
        text += fmt::format("{}{}\n", text.empty() ? "" : "\n", heading_of(table, section));
        std::size_t width = 0;
        for (const Parameter& parameter : table)
            if (section_of(parameter.key) == section) width = std::max(width, name_of(parameter.key).size());
        for (const Parameter& parameter : table) {
            if (section_of(parameter.key) != section) continue;
            text +=
                fmt::format("  {:<{}}  {}; default: {}\n", name_of(parameter.key), width, allowed_text(parameter), default_text(parameter));
            text += wrapped(parameter.help, std::string(width + 4, ' '), 120);
        }
    }
    return text;
}

std::string parameters_markdown(const ParameterTable& table) {
    std::string text;
    for (const std::string& section : sections_of(table)) {
        text += fmt::format("\n## {}\n\n| key | unit | allowed | default | meaning |\n|---|---|---|---|---|\n", heading_of(table, section));
        for (const Parameter& parameter : table) {
            if (section_of(parameter.key) != section) continue;
            const std::string source = parameter.reference.empty() ? "" : " [" + parameter.reference + "]";
            text += fmt::format("| `{}` | {} | {} | {} | {}{} |\n", name_of(parameter.key), parameter.unit,
                                markdown_cell(allowed_text(parameter)), markdown_cell(default_text(parameter)),
                                markdown_cell(parameter.help), source);
        }
    }
    return text;
}

}  // namespace cutterflow
