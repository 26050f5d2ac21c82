#include "cases/sweep/key_axes.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>

#include "geometry/base/error.hpp"

namespace cutterflow::cases {
namespace {

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
    return parts;
}

/// \throws UserError  when the text is no value of the parameter's kind
ParameterValue value_of(const Parameter& parameter, const std::string& text) {
    const auto refuse = [&](const char* rule) { throw UserError(fmt::format("--set {}={}", parameter.key, text), rule, "Correct it"); };
    if (parameter.kind == ParameterKind::path) return std::filesystem::absolute(text).string();  // the points lie in other folders
    if (parameter.kind == ParameterKind::boolean) {
        if (text != "true" && text != "false") refuse("The value is true or false");
        return text == "true";
    }
    if (parameter.kind != ParameterKind::number && parameter.kind != ParameterKind::integer) return text;
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' ||
        (parameter.kind == ParameterKind::integer && number != static_cast<double>(static_cast<std::int64_t>(number))))
        refuse("The value is a number");
    if (parameter.kind == ParameterKind::integer) return static_cast<std::int64_t>(number);
    return number;
}

/// In the tables of `section` and of the sections within it.
int set_in_tables(ParameterValues& values, const ParameterTable& table, const std::string& section, const std::string& key,
                  const std::function<ParameterValue(const ParameterValues&)>& value) {
    int count = 0;
    for (const std::string& name : repeated_sections(table, section)) {
        if (key.rfind(name + ".", 0) != 0) continue;
        for (ParameterValues& one : values.tables_for_writing(name)) {
            count += set_in_tables(one, table, name, key, value);
            if (one.where(key).empty()) continue;
            one.set(key, value(one));
            ++count;
        }
    }
    return count;
}

}  // namespace

std::vector<KeyAxis> key_axes(const ParameterTable& table, const std::vector<std::string>& words, const std::string& params) {
    std::vector<KeyAxis> axes;
    std::vector<Mistake> mistakes;
    for (const std::string& word : words) {
        const std::size_t equals = word.find('=');
        const KeyAxis axis{word.substr(0, equals),
                           equals == std::string::npos ? std::vector<std::string>{} : split(word.substr(equals + 1))};
        if (axis.values.empty()) mistakes.push_back({"", fmt::format("--set {}", word), "It is written as KEY=a,b", "Give the values"});
        if (!find_parameter(table, axis.key)) {
            std::vector<std::string> known;
            for (const Parameter& parameter : table) known.push_back(parameter.key);
            const std::string nearest = nearest_word(axis.key, known);
            mistakes.push_back({"", fmt::format("--set {}: there is no such key", axis.key), fmt::format("{} lists them", params),
                                nearest.empty() ? "Correct it" : fmt::format("Did you mean {}?", nearest)});
        }
        axes.push_back(axis);
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    return axes;
}

const Parameter* find_parameter(const ParameterTable& table, const std::string& key) {
    const auto found = std::find_if(table.begin(), table.end(), [&](const Parameter& parameter) { return parameter.key == key; });
    return found == table.end() ? nullptr : &*found;
}

int set_key(ParameterValues& values, const ParameterTable& table, const Parameter& parameter,
            const std::function<ParameterValue(const ParameterValues&)>& value) {
    if (parameter.repeated) return set_in_tables(values, table, "", parameter.key, value);
    values.set(parameter.key, value(values));
    return 1;
}

std::vector<KeySetting> key_settings(const ParameterTable& table, const ParameterValues& base, const std::vector<KeyAxis>& axes) {
    std::vector<KeySetting> settings{{"", base}};
    for (const KeyAxis& axis : axes) {
        const Parameter& parameter = *find_parameter(table, axis.key);
        std::vector<KeySetting> varied;
        for (const KeySetting& setting : settings)
            for (const std::string& text : axis.values) {
                KeySetting one = setting;
                const ParameterValue value = value_of(parameter, text);
                if (set_key(one.values, table, parameter, [&](const ParameterValues&) { return value; }) == 0)
                    throw UserError(fmt::format("--set {}: no table of the study gives this key", axis.key),
                                    "A sweep changes what is there", "Write the key into the tables that it shall change");
                one.name += fmt::format("_{}_{}", safe_name(axis.key.substr(axis.key.find('.') + 1)), safe_name(text));
                varied.push_back(std::move(one));
            }
        settings = std::move(varied);
    }
    return settings;
}

std::string safe_name(std::string text) {
    for (char& c : text)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
    return text;
}

}  // namespace cutterflow::cases
