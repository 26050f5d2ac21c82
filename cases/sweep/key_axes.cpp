#include "cases/sweep/key_axes.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/parameters/parameter_reading.hpp"
#include "geometry/base/parameters/parameter_words.hpp"

namespace cutterflow::cases {
namespace {

/// At commas outside of brackets.
std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> parts;
    int depth = 0;
    for (const char c : text) {
        if (parts.empty()) parts.emplace_back();
        depth += c == '[' ? 1 : c == ']' ? -1 : 0;
        if (c == ',' && depth == 0)
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

std::optional<double> number_of(const std::string& text) {
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    while (*end == ' ') ++end;
    if (text.empty() || *end != '\0') return std::nullopt;
    return number;
}

/// Of "[0, 0, 0.1]".
std::optional<std::vector<double>> numbers_of(const std::string& text) {
    if (text.size() < 2 || text.front() != '[' || text.back() != ']') return std::nullopt;
    std::vector<double> numbers;
    for (const std::string& part : split(text.substr(1, text.size() - 2))) {
        const std::optional<double> number = number_of(part);
        if (!number) return std::nullopt;
        numbers.push_back(*number);
    }
    return numbers;
}

/// What a table of an array is called: by its key `name`, else by the texts of its key `pair`.
bool is_called(const ParameterValues& values, const std::string& array, const std::string& name) {
    if (values.has(array + ".name")) return values.text(array + ".name") == name;
    if (!values.has(array + ".pair")) return false;
    const std::vector<std::string>& pair = values.texts(array + ".pair");
    return pair.size() == 2 && (name == pair[0] + "-" + pair[1] || name == pair[1] + "-" + pair[0]);
}

/// The largest that a double tells from its neighbours: 2^53.
constexpr double k_largest_integer = 9007199254740992.0;

/// The row of a key; null when the table has none.
const Parameter* find_parameter(const ParameterTable& table, const std::string& key) {
    const auto found = std::find_if(table.begin(), table.end(), [&](const Parameter& parameter) { return parameter.key == key; });
    return found == table.end() ? nullptr : &*found;
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

/// \throws UserError  with every text that is no value of its key, or is out of its bounds
void require_values(const ParameterTable& table, const std::vector<KeyAxis>& axes) {
    Mistakes mistakes;
    for (const KeyAxis& axis : axes)
        for (const std::string& text : axis.values)
            mistakes.gather([&] {
                const Parameter& parameter = *find_key(table, axis.key)->parameter;
                if (const auto wrong = value_mistake(parameter, value_of_text(axis.key, parameter, text)))
                    throw UserError(fmt::format("--set {}{}", axis.key, wrong->what.substr(parameter.key.size())), wrong->rule,
                                    wrong->remedy);
            });
    mistakes.refuse();
}

/// Tables of a study whose key an axis sets.
std::set<const ParameterValues*> tables_of(const ParameterTable& table, ParameterValues& values, const KeyPath& key) {
    std::set<const ParameterValues*> found;
    set_key(values, table, key, [&](const ParameterValues& one) {
        found.insert(&one);
        return ParameterValue(std::string());
    });
    return found;
}

/// The later of two axes would decide alone, under a point's name that tells otherwise.
/// \throws UserError  when two axes set the same key of one table
void require_apart(const ParameterTable& table, ParameterValues values, const std::vector<KeyAxis>& axes) {
    std::vector<Mistake> mistakes;
    for (auto a = axes.begin(); a != axes.end(); ++a)
        for (auto b = a + 1; b != axes.end(); ++b) {
            const KeyPath one = *find_key(table, a->key), other = *find_key(table, b->key);
            if (one.parameter != other.parameter) continue;
            const auto of_one = tables_of(table, values, one), of_other = tables_of(table, values, other);
            if (std::any_of(of_one.begin(), of_one.end(), [&](const ParameterValues* reached) { return of_other.count(reached) > 0; }))
                mistakes.push_back({"", fmt::format("--set {} and {} set the same key of one table", a->key, b->key),
                                    "A key has one value at a point", "Remove one of them, or name the tables of both"});
        }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

/// A value as it counts: 0.1 and 0.10 are one. A text that is no value, of which key_settings tells, stays as it is.
ParameterValue counted(const std::optional<KeyPath>& key, const std::string& text) {
    try {
        if (key) return value_of_text(key->parameter->key, *key->parameter, text);
    } catch (const UserError&) {
    }
    return text;
}

/// Whether one of two keys is a part of the other, as grains.diameter_m and grains.diameter_m.uniform_by_number: a table gives one of them.
bool exclude_each_other(const std::string& one, const std::string& other) {
    return one.rfind(other + ".", 0) == 0 || other.rfind(one + ".", 0) == 0;
}

/// \param axis  the key as it was written
/// \throws UserError  when the values give a key that excludes this one
void require_same_form(const ParameterTable& table, const ParameterValues& values, const std::string& key, const std::string& axis) {
    for (const Parameter& parameter : table)
        if (exclude_each_other(parameter.key, key) && values.has(parameter.key))
            throw UserError(fmt::format("--set {}: the study gives {}", axis, parameter.key), "One of the two counts",
                            "Vary that key, or write this one into the study in its place");
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
        const std::optional<KeyPath> key = find_key(table, axis.key);
        if (!key) {
            std::vector<std::string> known;
            for (const Parameter& parameter : table) known.push_back(parameter.key);
            const std::string nearest = nearest_word(axis.key, known);
            mistakes.push_back({"", fmt::format("--set {}: there is no such key", axis.key), fmt::format("{} lists them", params),
                                nearest.empty() ? "Correct it" : fmt::format("Did you mean {}?", nearest)});
        }
        if (std::any_of(axes.begin(), axes.end(), [&](const KeyAxis& other) { return other.key == axis.key; }))
            mistakes.push_back({"", fmt::format("--set {} is given twice", axis.key), "A key has one list of values", "Put all into one"});
        std::vector<ParameterValue> values;
        for (const std::string& text : axis.values) {
            values.push_back(counted(key, text));
            if (std::count(values.begin(), values.end(), values.back()) == 2)
                mistakes.push_back(
                    {"", fmt::format("--set {} has {} twice", axis.key, text), "Every point is another one", "Give each value once"});
        }
        axes.push_back(axis);
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    return axes;
}

void require_free_seed(const std::vector<KeyAxis>& axes, const std::string& seed, const RepeatRange& repeats) {
    if (repeats.are_numbered() && std::any_of(axes.begin(), axes.end(), [&](const KeyAxis& axis) { return axis.key == seed; }))
        throw UserError(fmt::format("--set {} beside --repeats", seed), "Repeats count the seed up from the study's", "Remove one of them");
}

void require_random(bool is_random, int repeats, const std::string& point, const std::string& differ_by, const std::string& remedy) {
    if (repeats > 1 && !is_random)
        throw UserError({{point, fmt::format("{} repeats of a study in which nothing is random", repeats),
                          fmt::format("Repeats differ by {}; without it all of them are the same run", differ_by),
                          fmt::format("{}, or run it once", remedy)}});
}

std::optional<KeyPath> find_key(const ParameterTable& table, const std::string& text) {
    using parameter_words::enclosing_array;
    if (const Parameter* parameter = find_parameter(table, text)) return KeyPath{parameter, enclosing_array(table, text), ""};
    std::optional<KeyPath> found;
    for (const Parameter& parameter : table) {
        const std::string array = enclosing_array(table, parameter.key);
        if (array.empty() || text.rfind(array + ".", 0) != 0) continue;
        const std::string key = parameter.key.substr(array.size()), rest = text.substr(array.size() + 1);  // ".friction"
        if (rest.size() <= key.size() || rest.compare(rest.size() - key.size(), key.size(), key) != 0) continue;
        const std::string member = rest.substr(0, rest.size() - key.size());
        if (!found || member.size() < found->member.size()) found = KeyPath{&parameter, array, member};
    }
    return found;
}

int set_key(ParameterValues& values, const ParameterTable& table, const KeyPath& key,
            const std::function<ParameterValue(const ParameterValues&)>& value) {
    if (key.array.empty()) {
        values.set(key.parameter->key, value(values));
        return 1;
    }
    if (key.member.empty()) return set_in_tables(values, table, "", key.parameter->key, value);
    int count = 0;
    for (ParameterValues& one : values.tables_for_writing(key.array)) {
        if (!is_called(one, key.array, key.member)) continue;
        one.set(key.parameter->key, value(one));
        ++count;
    }
    return count;
}

ParameterValue value_of_text(const std::string& key, const Parameter& parameter, const std::string& text) {
    const auto refuse = [&](const char* rule) { throw UserError(fmt::format("--set {}={}", key, text), rule, "Correct it"); };
    const std::optional<double> number = number_of(text);
    switch (parameter.kind) {
        case ParameterKind::path:
            return std::filesystem::absolute(text).string();  // the points lie in other folders
        case ParameterKind::boolean:
            if (text != "true" && text != "false") refuse("The value is true or false");
            return text == "true";
        case ParameterKind::text:
        case ParameterKind::choice:
            return text;
        case ParameterKind::number:
            if (!number) refuse("The value is a number");
            return *number;
        case ParameterKind::integer:
            if (!number || *number != std::trunc(*number) || std::abs(*number) > k_largest_integer) refuse("The value is a whole number");
            return static_cast<std::int64_t>(*number);
        case ParameterKind::numbers: {
            const std::optional<std::vector<double>> numbers = numbers_of(text);
            if (!numbers) refuse("The value is a list of numbers in brackets, as [0,0,1]");
            return *numbers;
        }
        case ParameterKind::texts:
            refuse("It names what the table is about");
    }
    throw std::logic_error("unknown ParameterKind");
}

std::vector<KeySetting> key_settings(const ParameterTable& table, const ParameterValues& base, const std::vector<KeyAxis>& axes) {
    require_values(table, axes);
    require_apart(table, base, axes);
    std::vector<KeySetting> settings{{"", base}};
    for (const KeyAxis& axis : axes) {
        const KeyPath key = *find_key(table, axis.key);
        std::vector<KeySetting> varied;
        for (const KeySetting& setting : settings)
            for (const std::string& text : axis.values) {
                KeySetting one = setting;
                const ParameterValue value = value_of_text(axis.key, *key.parameter, text);
                const auto checked = [&](const ParameterValues& values) {
                    require_same_form(table, values, key.parameter->key, axis.key);
                    return value;
                };
                if (set_key(one.values, table, key, checked) == 0)
                    throw UserError(key.member.empty()
                                        ? fmt::format("--set {}: no table of the study gives this key", axis.key)
                                        : fmt::format("--set {}: no table [[{}]] is called {}", axis.key, key.array, key.member),
                                    "A sweep changes what is there", "Write the key into the tables that it shall change");
                one.name += fmt::format("_{}_{}", safe_name(axis.key.substr(axis.key.find('.') + 1)), safe_name(text));
                varied.push_back(std::move(one));
            }
        settings = std::move(varied);
    }
    return settings;
}

Mistake of_point(Mistake mistake, const std::string& point) {
    if (mistake.where.rfind(point + ":", 0) == 0) mistake.where = point;
    return mistake;
}

std::string safe_name(std::string text) {
    text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c == '[' || c == ']'; }), text.end());
    for (char& c : text)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
    return text;
}

}  // namespace cutterflow::cases
