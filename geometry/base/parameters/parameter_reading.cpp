#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/parameters/parameter.hpp"
#include "geometry/base/parameters/parameter_reading.hpp"
#include "geometry/base/parameters/parameter_words.hpp"
#include "geometry/base/toml.hpp"

namespace cutterflow {
namespace {

using namespace parameter_words;

std::string join_key(const std::string& section, const std::string& name) {
    return section.empty() ? name : section + "." + name;
}

/// "feed" of "feed.class.share", empty without a dot.
std::string first_section_of(const std::string& key) {
    const std::size_t dot = key.find('.');
    return dot == std::string::npos ? "" : key.substr(0, dot);
}

bool is_inside(const std::string& key, const std::string& section) {
    return section.empty() || key.rfind(section + ".", 0) == 0;
}

bool is_section(const ParameterTable& table, const std::string& name) {
    return std::any_of(table.begin(), table.end(), [&](const Parameter& p) { return is_inside(p.key, name); });
}

const Parameter* find_parameter(const ParameterTable& table, const std::string& key) {
    const auto found = std::find_if(table.begin(), table.end(), [&](const Parameter& p) { return p.key == key; });
    return found == table.end() ? nullptr : &*found;
}

/// As TOML. toml++ writes single values only: to break the lines of an array it converts log10 of each number to an unsigned one, which
/// is undefined for numbers up to 0.1 and for infinity.
std::string toml_of(const toml::node& node) {
    std::vector<std::string> parts;
    if (const toml::array* array = node.as_array()) {
        for (const toml::node& item : *array) parts.push_back(toml_of(item));
        return fmt::format("[{}]", fmt::join(parts, ", "));
    }
    if (const toml::table* table = node.as_table()) {
        for (auto&& [key, value] : *table) parts.push_back(fmt::format("{} = {}", std::string_view(key.str()), toml_of(value)));
        return fmt::format("{{ {} }}", fmt::join(parts, ", "));
    }
    if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());  // toml++ writes 0.015 with 17 digits
    std::ostringstream stream;
    stream << toml::toml_formatter(node, toml::format_flags::none);
    return stream.str();
}

std::string node_text(const toml::node& node) {
    std::string text = toml_of(node);
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

/// The number of a TOML integer or float; none for anything else.
std::optional<double> number_in(const toml::node& node) {
    if (const auto* integer = node.as_integer()) return static_cast<double>(integer->get());
    if (const auto* number = node.as_floating_point()) return number->get();
    return std::nullopt;
}

std::optional<std::string> text_in(const toml::node& node) {
    if (const auto* text = node.as_string()) return text->get();
    return std::nullopt;
}

/// A list of the parameter's length, of at least one, whose members `member(node)` reads.
template <class Member, class Read>
std::optional<ParameterValue> list_of(const Parameter& parameter, const toml::node& node, Read member) {
    const toml::array* array = node.as_array();
    if (array == nullptr || array->empty() || (parameter.length > 0 && array->size() != parameter.length)) return std::nullopt;
    std::vector<Member> list;
    for (const toml::node& item : *array) {
        const std::optional<Member> value = member(item);
        if (!value) return std::nullopt;
        list.push_back(*value);
    }
    return list;
}

/// The node's value if it has the parameter's type.
std::optional<ParameterValue> typed_value(const Parameter& parameter, const toml::node& node) {
    switch (parameter.kind) {
        case ParameterKind::number:
            if (const auto number = number_in(node)) return *number;
            return std::nullopt;
        case ParameterKind::integer:
            if (const auto* integer = node.as_integer()) return integer->get();
            return std::nullopt;
        case ParameterKind::text:
        case ParameterKind::choice:
        case ParameterKind::path:
            if (const auto* text = node.as_string()) return text->get();
            return std::nullopt;
        case ParameterKind::boolean:
            if (const auto* boolean = node.as_boolean()) return boolean->get();
            return std::nullopt;
        case ParameterKind::numbers:
            return list_of<double>(parameter, node, number_in);
        case ParameterKind::texts:
            return list_of<std::string>(parameter, node, text_in);
    }
    throw std::logic_error("unknown ParameterKind");
}

std::optional<Mistake> number_mistake(const Parameter& parameter, double number, const ParameterValue& value) {
    const std::string what = fmt::format("{} = {}", parameter.key, toml_text(value));
    if (!std::isfinite(number)) return Mistake{"", what + " is not finite", "It must be a finite number", "Correct the value"};
    const bool low = parameter.minimum && (parameter.minimum_excluded ? number <= *parameter.minimum : number < *parameter.minimum);
    const bool high = parameter.maximum && number > *parameter.maximum;
    if (!low && !high) return std::nullopt;
    return Mistake{"", what + (low ? " is too low" : " is too high"), fmt::format("It must be {}", bounds_text(parameter)),
                   has_unit(parameter) ? fmt::format("Correct the value; its unit is {}", parameter.unit) : "Correct the value"};
}

std::optional<Mistake> choice_mistake(const Parameter& parameter, const std::string& word) {
    if (std::find(parameter.choices.begin(), parameter.choices.end(), word) != parameter.choices.end()) return std::nullopt;
    const std::string nearest = nearest_word(word, parameter.choices);
    return Mistake{"", fmt::format("{} = {} is no choice", parameter.key, quoted(word)),
                   fmt::format("It must be one of {}", join(parameter.choices, ", ")),
                   nearest.empty() ? "Choose one of them" : fmt::format("Did you mean \"{}\"?", nearest)};
}

/// Reads one file's tree against the table and collects every mistake on the way.
class Reader {
public:
    Reader(const ParameterTable& table, std::string name) : table_(table), name_(std::move(name)) {}

    ParameterValues read(const toml::table& root) {
        ParameterValues values;
        read_section(root, "", values);
        fill_in(values, "", name_);
        return values;
    }

    const std::vector<Mistake>& mistakes() const { return mistakes_; }
    bool complete() const { return complete_; }

private:
    std::string where(const toml::node& node) const { return fmt::format("{}:{}", name_, node.source().begin.line); }

    void add(std::string where, std::string what, std::string rule, std::string remedy) {
        complete_ = false;
        mistakes_.push_back({std::move(where), std::move(what), std::move(rule), std::move(remedy)});
    }

    void read_section(const toml::table& section, const std::string& prefix, ParameterValues& values) {
        // toml++ sorts keys; report mistakes in the order of the file.
        std::vector<std::pair<std::string, const toml::node*>> entries;
        for (const auto& [key, node] : section) entries.emplace_back(std::string(key.str()), &node);
        std::sort(entries.begin(), entries.end(),
                  [](const auto& a, const auto& b) { return a.second->source().begin < b.second->source().begin; });
        for (const auto& [name, node] : entries) read_entry(join_key(prefix, name), *node, values);
    }

    void read_entry(const std::string& key, const toml::node& node, ParameterValues& values) {
        const bool section_in_its_place = node.is_table() && is_section(table_, key);
        if (const Parameter* parameter = find_parameter(table_, key); parameter != nullptr && !section_in_its_place)
            return read_value(*parameter, node, values);
        if (!is_section(table_, key)) return report_unknown(key, node);
        if (is_repeated_section(table_, key)) return read_repeated(key, node, values);
        if (const toml::table* section = node.as_table()) {
            values.set_where(key, where(node));
            return read_section(*section, key, values);
        }
        add(where(node), fmt::format("{} = {} is not a section", key, node_text(node)), fmt::format("{} contains keys", key),
            fmt::format("Write [{}] on a separate line and its keys below", key));
    }

    void read_repeated(const std::string& key, const toml::node& node, ParameterValues& values) {
        const toml::array* array = node.as_array();
        const bool tables_only =
            array != nullptr && std::all_of(array->begin(), array->end(), [](const toml::node& item) { return item.is_table(); });
        values.set_where(key, where(node));
        if (!tables_only)
            return add(where(node), fmt::format("{} is not a list of tables", key), fmt::format("{} may occur several times", key),
                       fmt::format("Write [[{}]] with two brackets and its keys below", key));
        for (const toml::node& item : *array) {
            ParameterValues member;
            const std::set<std::string> outside = std::exchange(meant_, {});
            read_section(*item.as_table(), key, member);
            fill_in(member, key, where(item));
            meant_ = outside;
            values.tables_for_writing(key).push_back(std::move(member));
        }
    }

    void read_value(const Parameter& parameter, const toml::node& node, ParameterValues& values) {
        values.set_where(parameter.key, where(node));
        const std::optional<ParameterValue> value = typed_value(parameter, node);
        if (!value)
            return add(where(node), fmt::format("{} = {} has the wrong type", parameter.key, node_text(node)),
                       fmt::format("It must be {}", kind_with_unit(parameter)), "Correct the value");
        if (std::optional<Mistake> mistake = value_mistake(parameter, *value)) {
            return add(where(node), mistake->what, mistake->rule, mistake->remedy);
        }
        values.set(parameter.key, *value);
    }

    void report_unknown(const std::string& key, const toml::node& node) {
        const bool section = node.is_table() || node.is_array_of_tables();
        const std::string nearest = section ? nearest_section(key) : nearest_key(key);
        meant_.insert(nearest);
        mistakes_.push_back({where(node), fmt::format("{} {} is unknown", section ? "section" : "key", key), known_neighbours(key),
                             nearest.empty() ? "Remove it" : fmt::format("Did you mean {}?", nearest)});
    }

    /// A section within another one is a misspelling of one of the same table.
    std::string nearest_section(const std::string& key) const {
        std::vector<std::string> sections = sections_of(table_);
        const std::string first = first_section_of(key);
        const auto is_elsewhere = [&](const std::string& section) { return !first.empty() && first_section_of(section) != first; };
        sections.erase(std::remove_if(sections.begin(), sections.end(), is_elsewhere), sections.end());
        return nearest_word(key, sections);
    }

    /// Keys that begin with this one, as where one has become several, else one of nearly this name in the same table, else one of this
    /// very name in a section outside of arrays of tables.
    std::string nearest_key(const std::string& key) const {
        std::vector<std::string> beside, single, longer;
        for (const Parameter& parameter : table_) {
            if (first_section_of(parameter.key) == first_section_of(key))
                beside.push_back(parameter.key);
            else if (enclosing_array(table_, parameter.key).empty())
                single.push_back(parameter.key);
            if (parameter.key.rfind(key + "_", 0) == 0) longer.push_back(parameter.key);
        }
        if (!longer.empty()) return join(longer, " and ");
        std::string nearest = nearest_word(key, beside);
        if (nearest.empty()) nearest = of_nearest_name(key, beside);
        return nearest.empty() ? of_nearest_name(key, single) : nearest;
    }

    /// Of `keys` one whose name without its section is nearly that of `key`; empty when there is none.
    static std::string of_nearest_name(const std::string& key, const std::vector<std::string>& keys) {
        std::vector<std::string> names;
        std::transform(keys.begin(), keys.end(), std::back_inserter(names), name_of);
        const std::string nearest = nearest_word(name_of(key), names);
        const auto found = std::find(names.begin(), names.end(), nearest);
        return nearest.empty() ? "" : keys[static_cast<std::size_t>(found - names.begin())];
    }

    std::vector<std::string> named_sections() const {
        std::vector<std::string> sections = sections_of(table_);
        sections.erase(std::remove(sections.begin(), sections.end(), ""), sections.end());
        return sections;
    }

    std::string known_neighbours(const std::string& key) const {
        std::vector<std::string> known;
        const std::string section = section_of(key);
        for (const Parameter& parameter : table_)
            if (section_of(parameter.key) == section) known.push_back(name_of(parameter.key));
        for (const std::string& inner : sections_of(table_))
            if (!inner.empty() && section_of(inner) == section && find_parameter(table_, inner) == nullptr) known.push_back(name_of(inner));
        if (section.empty() || known.empty()) return fmt::format("The file's sections are {}", join(named_sections(), ", "));
        return fmt::format("The keys of {} are {}", section, join(known, ", "));
    }

    /// Where a missing key is to be written.
    std::string place_of(const Parameter& parameter) const {
        if (parameter.repeated) return fmt::format("to [[{}]]", enclosing_array(table_, parameter.key));
        const std::string section = section_of(parameter.key);
        return section.empty() ? "at the top of the file" : fmt::format("to [{}]", section);
    }

    /// Defaults and missing keys of one place: the file outside its arrays of tables (section ""), or one table of an array.
    void fill_in(ParameterValues& values, const std::string& repeated_section, const std::string& place) {
        for (const Parameter& parameter : table_) {
            if (enclosing_array(table_, parameter.key) != repeated_section || values.gives(parameter.key)) continue;
            if (parameter.default_value) {
                values.set(parameter.key, *parameter.default_value);
            } else if (!parameter.optional && meant_.count(parameter.key) > 0) {
                complete_ = false;  // it is told of the key that is misspelt
            } else if (!parameter.optional) {
                add(place, fmt::format("{} is missing", parameter.key), "It is required and has no default: " + parameter.help,
                    fmt::format("Add {} ({}) {}", name_of(parameter.key), kind_with_unit(parameter), place_of(parameter)));
            }
        }
    }

    const ParameterTable& table_;
    std::string name_;
    std::vector<Mistake> mistakes_;
    std::set<std::string> meant_;  // of the place that is read: keys of which unknown ones are a misspelling
    bool complete_ = true;
};

constexpr const char* k_toml_rule = "The file must be TOML: [section], key = value, text in quotes";

toml::table parse_toml(const std::string& toml, const std::string& name) {
    try {
        return toml::parse(toml, name);
    } catch (const toml::parse_error& error) {
        throw UserError(
            {{fmt::format("{}:{}", name, error.source().begin.line), std::string(error.description()), k_toml_rule, "Correct that line"}});
    } catch (const TomlAssertion&) {
        throw UserError({{name, "a key or a value begins with a character that cannot stand there", k_toml_rule,
                          "Look for stray brackets and commas, as in [[[section]]]"}});
    }
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({substituted, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

}  // namespace

std::optional<Mistake> value_mistake(const Parameter& parameter, const ParameterValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return number_mistake(parameter, *number, value);
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return number_mistake(parameter, static_cast<double>(*integer), value);
    if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
        for (const double number : *numbers)
            if (std::optional<Mistake> mistake = number_mistake(parameter, number, value)) return mistake;
        return std::nullopt;
    }
    if (parameter.kind == ParameterKind::choice) return choice_mistake(parameter, std::get<std::string>(value));
    if (parameter.kind == ParameterKind::path && std::get<std::string>(value).empty())
        return Mistake{"", fmt::format("{} = \"\" is empty", parameter.key), "It must name a file",
                       parameter.optional ? "Give its path, or leave the key out" : "Give its path"};
    return std::nullopt;
}

ReadParameters parse_with_mistakes(const ParameterTable& table, const std::string& toml, const std::string& name) {
    Reader reader(table, name);
    ParameterValues values = reader.read(parse_toml(toml, name));
    return {std::move(values), reader.mistakes(), reader.complete()};
}

std::optional<std::string> text_of_key(const std::string& toml, const std::string& key) {
    try {
        const toml::table root = parse_toml(toml, "");
        if (const auto* text = root.at_path(key).as_string()) return text->get();
    } catch (const UserError&) {
    }
    return std::nullopt;
}

ParameterValues parse_parameters(const ParameterTable& table, const std::string& toml, const std::string& name) {
    ReadParameters read = parse_with_mistakes(table, toml, name);
    if (!read.mistakes.empty()) throw UserError(std::move(read.mistakes));
    return std::move(read.values);
}

ParameterValues read_parameters(const ParameterTable& table, const std::filesystem::path& file) {
    return parse_parameters(table, read_file(file), file.string());
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& known) {
    std::string nearest;
    std::size_t best = word.size() / 3 + 1;
    for (const std::string& candidate : known) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < best) {
            best = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

}  // namespace cutterflow
