#pragma once
/// \file Values of a study's keys that a sweep varies: `--set KEY=a,b`.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::cases {

/// The values of one key: `swing.speed_m_min=4,8`. A list stands in brackets: `solid.tube.velocity_m_s=[0,0,0.1],[0,0,0.2]`.
struct KeyAxis {
    std::string key;
    std::vector<std::string> values;  ///< as TOML writes them
};

/// \param words  of --set \param params  the command that lists the keys, for messages
/// \throws UserError  with every word that is no key of the table with values
std::vector<KeyAxis> key_axes(const ParameterTable& table, const std::vector<std::string>& words, const std::string& params);

/// Repeats of a setting, numbered from `first` on: repeat n has the study's seed plus n.
struct RepeatRange {
    int count = 1;
    int first = 0;
    RepeatRange(int number, int from = 0) : count(number), first(from) {}
    /// Whether names and seeds tell repeats apart: a single one, the first, is the study itself.
    bool are_numbered() const { return count > 1 || first > 0; }
};

/// \throws UserError  when an axis varies the seed that repeats count up
void require_free_seed(const std::vector<KeyAxis>& axes, const std::string& seed, const RepeatRange& repeats);

/// \param is_random  whether the seed that repeats count up changes anything of the study `point`
/// \param differ_by, remedy  what is random in studies of the kind, and how this one gets it, for the message
/// \throws UserError  when repeats would all be one run, whose scatter of 0 tells nothing
void require_random(bool is_random, int repeats, const std::string& point, const std::string& differ_by, const std::string& remedy);

/// A key of a study, perhaps of one table of an array of tables alone: `contact.gravel-steel.friction` is `friction` of the table
/// [[contact]] with pair = ["gravel", "steel"], `solid.tube.material` that of the table [[solid]] with name = "tube".
struct KeyPath {
    const Parameter* parameter = nullptr;
    std::string array;   ///< innermost array of tables that the key stands in; empty: none
    std::string member;  ///< name of one table of it; empty: every table that gives the key
};

/// None when the table has no such key. Whether there is a table of that name, a study tells.
std::optional<KeyPath> find_key(const ParameterTable& table, const std::string& text);

/// Changes a key. \return how many values were set: 0 when no table gives the key, or none has the name
int set_key(ParameterValues& values, const ParameterTable& table, const KeyPath& key,
            const std::function<ParameterValue(const ParameterValues&)>& value);

/// \param key  as the user wrote it, for messages
/// \throws UserError  when the text is no value of the parameter's kind
ParameterValue value_of_text(const std::string& key, const Parameter& parameter, const std::string& text);

/// A study with some keys changed.
struct KeySetting {
    std::string name;  ///< "_speed_m_min_4_gap_m_0.03": part of the names of its points
    ParameterValues values;
};

/// All combinations of the axes' values.
/// \throws UserError  when no table gives a key of a repeated section, two axes set the same key of one table, or a text is no value of
/// its key's kind
std::vector<KeySetting> key_settings(const ParameterTable& table, const ParameterValues& base, const std::vector<KeyAxis>& axes);

/// A mistake in the text of a point, without a line of it: the text is written when nothing is wrong.
Mistake of_point(Mistake mistake, const std::string& point);

/// A text as part of a name of a folder: OpenFOAM takes few characters in a path.
std::string safe_name(std::string text);

}  // namespace cutterflow::cases
