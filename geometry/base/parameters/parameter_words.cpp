#include "geometry/base/parameters/parameter_words.hpp"
#include "geometry/base/toml.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

namespace cutterflow::parameter_words {

std::string section_of(const std::string& key) {
    const std::size_t dot = key.rfind('.');
    return dot == std::string::npos ? "" : key.substr(0, dot);
}

std::string name_of(const std::string& key) {
    const std::size_t dot = key.rfind('.');
    return dot == std::string::npos ? key : key.substr(dot + 1);
}

std::string join(const std::vector<std::string>& words, const char* separator) {
    return fmt::format("{}", fmt::join(words, separator));
}

std::vector<std::string> sections_of(const ParameterTable& table) {
    std::vector<std::string> sections;
    for (const Parameter& parameter : table) {
        const std::string section = section_of(parameter.key);
        if (std::find(sections.begin(), sections.end(), section) == sections.end()) sections.push_back(section);
    }
    return sections;
}

bool is_repeated_section(const ParameterTable& table, const std::string& section) {
    return std::any_of(table.begin(), table.end(), [&](const Parameter& p) { return p.repeated && section_of(p.key) == section; });
}

std::string enclosing_array(const ParameterTable& table, const std::string& key) {
    std::string section = section_of(key);
    while (!section.empty() && !is_repeated_section(table, section)) section = section_of(section);
    return section;
}

std::string kind_text(ParameterKind kind) {
    switch (kind) {
        case ParameterKind::number:
            return "a number";
        case ParameterKind::integer:
            return "a whole number";
        case ParameterKind::text:
            return "text in quotes";
        case ParameterKind::choice:
            return "one of its choices in quotes";
        case ParameterKind::boolean:
            return "true or false";
        case ParameterKind::path:
            return "a path in quotes";
        case ParameterKind::numbers:
            return "a list of numbers";
        case ParameterKind::texts:
            return "a list of texts in quotes";
    }
    throw std::logic_error("unknown ParameterKind");
}

bool has_unit(const Parameter& parameter) {
    return !parameter.unit.empty() && parameter.unit != "-";
}

std::string with_unit(const Parameter& parameter, const std::string& text) {
    return has_unit(parameter) ? text + " " + parameter.unit : text;
}

std::string kind_with_unit(const Parameter& parameter) {
    std::string kind = kind_text(parameter.kind);
    if (parameter.length > 0) kind.replace(0, std::string("a list of").size(), fmt::format("a list of {}", parameter.length));
    return has_unit(parameter) ? kind + " in " + parameter.unit : kind;
}

std::string bounds_text(const Parameter& parameter) {
    const auto number = [](double value) { return fmt::format("{}", value); };
    if (!parameter.minimum && !parameter.maximum) return "";
    if (!parameter.minimum) return with_unit(parameter, "at most " + number(*parameter.maximum));
    const std::string low = (parameter.minimum_excluded ? "above " : "at least ") + number(*parameter.minimum);
    if (!parameter.maximum) return with_unit(parameter, low);
    if (parameter.minimum_excluded) return with_unit(parameter, low + ", at most " + number(*parameter.maximum));
    return with_unit(parameter, number(*parameter.minimum) + " to " + number(*parameter.maximum));
}

std::string quoted(const std::string& text) {
    std::ostringstream stream;
    stream << toml::toml_formatter(toml::value<std::string>(text), toml::format_flags::none);
    return stream.str();
}

}  // namespace cutterflow::parameter_words
