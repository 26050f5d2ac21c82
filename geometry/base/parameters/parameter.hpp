#pragma once
/// \file Typed, documented parameters of the project's TOML files (studies, cutters). One declaration per key serves reading, checking,
/// the commented template, `cutterflow params` and the manual page.
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "geometry/base/error.hpp"

namespace cutterflow {

enum class ParameterKind { number, integer, text, choice, boolean, path, numbers, texts };

using ParameterValue = std::variant<double, std::int64_t, std::string, bool, std::vector<double>, std::vector<std::string>>;

/// One key. Its name contains the unit (`rotor.speed_rpm`); values keep the file's unit, conversion happens where a struct is
/// filled.
struct Parameter {
    std::string key;  ///< "section.name_unit"; for repeated tables "feed.count" with `repeated`
    ParameterKind kind = ParameterKind::number;
    std::string unit;                             ///< for people: "rpm", "m3/s", "-" ...
    std::optional<ParameterValue> default_value;  ///< none: the key is required, unless `optional`
    bool optional = false;                        ///< may be absent without a default; `derived_from` describes the value used
    std::optional<double> minimum, maximum;       ///< inclusive bounds; of a list: of each number
    bool minimum_excluded = false;                ///< the minimum itself is not allowed (a discharge of 0)
    std::vector<std::string> choices;             ///< for ParameterKind::choice
    std::size_t length = 0;                       ///< of a list; 0: one or more
    std::string help;                             ///< one or two sentences
    std::string derived_from;                     ///< how an absent optional value is derived
    /// Member of an array of tables: of [[feed]] for "feed.count"; arrays nest ("feed.class.share"). A key that is not and stands in a
    /// table within an array's table ("side.flow.speed_m_s" in `flow = { speed_m_s = 1 }` of [[side]]) belongs to that one; it is optional
    /// and has no default. A key may stand beside a table of its name, and is one of both.
    bool repeated = false;
    std::string reference;  ///< key in docs/references.bib, may be empty
    std::string stage;      ///< of a run: the first one that uses the key; empty where the table's files have no stages
};

using ParameterTable = std::vector<Parameter>;

/// What is wrong with a value of the parameter's type: not finite, outside the bounds, not among the choices. None: it is allowed.
std::optional<Mistake> value_mistake(const Parameter& parameter, const ParameterValue& value);

/// A key is read that has no value. Of a file without mistakes that is a defect.
class NoValue : public std::logic_error {
public:
    explicit NoValue(const std::string& key) : std::logic_error("parameter " + key + " has no value") {}
};

/// The values of one file (or of one of its repeated tables). A key whose value was refused has none, but its place.
class ParameterValues {
public:
    bool has(const std::string& key) const;
    bool gives(const std::string& key) const;                  ///< it has a value, or the file gives one that was refused
    const ParameterValue* find(const std::string& key) const;  ///< null when it has no value
    double number(const std::string& key) const;               ///< also of an integer
    std::int64_t integer(const std::string& key) const;
    const std::string& text(const std::string& key) const;  ///< text, choice or path
    bool boolean(const std::string& key) const;
    const std::vector<double>& numbers(const std::string& key) const;
    const std::vector<std::string>& texts(const std::string& key) const;
    /// The tables of an array of tables, in the file's order; their keys are full ("feed.count").
    const std::vector<ParameterValues>& tables(const std::string& name) const;

    void set(const std::string& key, ParameterValue value);
    void remove(const std::string& key);
    std::vector<ParameterValues>& tables_for_writing(const std::string& name);

    /// Place of a key ("study.toml:12"), for messages; empty when it has its default.
    std::string where(const std::string& key) const;
    void set_where(const std::string& key, std::string where);

private:
    template <typename T>
    const T& get(const std::string& key) const;

    std::map<std::string, ParameterValue> values_;
    std::map<std::string, std::string> where_;
    std::map<std::string, std::vector<ParameterValues>> tables_;
};

/// Reads a TOML file against a table and fills in defaults.
/// \throws UserError  with every mistake of the file: not readable, not TOML, unknown key (with the nearest known one), wrong type,
///                    outside its bounds, not among its choices, missing
ParameterValues read_parameters(const ParameterTable& table, const std::filesystem::path& file);

/// As read_parameters, from text; messages show `name` as the file.
ParameterValues parse_parameters(const ParameterTable& table, const std::string& toml, const std::string& name);

/// A value as TOML writes it.
std::string toml_text(const ParameterValue& value);

/// TOML text with every key of the table, its help, unit, bounds and default as comments. Required keys are left to fill in; `values`
/// (may be null) replaces defaults.
std::string commented_toml(const ParameterTable& table, const ParameterValues* values = nullptr);

/// TOML text of all values, without comments.
std::string plain_toml(const ParameterTable& table, const ParameterValues& values);

/// The table as aligned text for a terminal, and as a Markdown manual page.
std::string parameters_text(const ParameterTable& table);
std::string parameters_markdown(const ParameterTable& table);

/// Arrays of tables that stand in the tables of an array ("": in the file, outside of arrays), but in none between: {"feed.class"} in
/// "feed".
std::vector<std::string> repeated_sections(const ParameterTable& table, const std::string& section);

/// The word of `known` nearest to `word` (edit distance at most a third of its length), or empty.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace cutterflow
