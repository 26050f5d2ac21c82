#pragma once
/// \file Values of a study's keys that a sweep varies: `--set KEY=a,b`.
#include <functional>
#include <string>
#include <vector>

#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::cases {

/// The values of one key: `swing.speed_m_min=4,8`.
struct KeyAxis {
    std::string key;
    std::vector<std::string> values;  ///< as TOML writes them
};

/// \param words  of --set \param params  the command that lists the keys, for messages
/// \throws UserError  with every word that is no key of the table with values
std::vector<KeyAxis> key_axes(const ParameterTable& table, const std::vector<std::string>& words, const std::string& params);

/// The row of a key; null when the table has none.
const Parameter* find_parameter(const ParameterTable& table, const std::string& key);

/// Changes a key; of a repeated section in every table that gives it. \return how many values were set
int set_key(ParameterValues& values, const ParameterTable& table, const Parameter& parameter,
            const std::function<ParameterValue(const ParameterValues&)>& value);

/// A study with some keys changed.
struct KeySetting {
    std::string name;  ///< "_speed_m_min_4_gap_m_0.03": part of the names of its points
    ParameterValues values;
};

/// All combinations of the axes' values.
/// \throws UserError  when no table gives a key of a repeated section, or a text is no value of its key's kind
std::vector<KeySetting> key_settings(const ParameterTable& table, const ParameterValues& base, const std::vector<KeyAxis>& axes);

/// A text as part of a name of a folder: OpenFOAM takes few characters in a path.
std::string safe_name(std::string text);

}  // namespace cutterflow::cases
