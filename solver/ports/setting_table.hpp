#pragma once
/// \file Settings with their keys, units, bounds, defaults and help in one table per struct. The study, the reader and the writer of
/// constant/couplingProperties and all checks work from it.
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "geometry/base/error.hpp"
#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::coupling {

/// One member of a struct of settings. Instantiated in setting_table.cpp for each struct that has a table.
template <class Settings>
struct Setting {
    using Member = std::variant<double Settings::*, int Settings::*, bool Settings::*, std::string Settings::*>;

    /// Its key is that of constant/couplingProperties, without the section. Without a default a value must be given.
    Parameter parameter;
    Member member;

    ParameterValue value_in(const Settings& settings) const;
    void assign(Settings& settings, const ParameterValue& value) const;
};

template <class Settings>
using SettingTable = std::vector<Setting<Settings>>;

/// The table of a struct; specialised beside each struct that has one.
template <class Settings>
const SettingTable<Settings>& setting_table();

/// Every value of `settings` that its table does not allow. \param section  in front of the keys, as "kernel" \param where  of the file
template <class Settings>
std::vector<Mistake> setting_mistakes(const Settings& settings, const std::string& section, const std::string& where) {
    std::vector<Mistake> mistakes;
    for (const Setting<Settings>& setting : setting_table<Settings>()) {
        Parameter named = setting.parameter;
        named.key = section + "." + named.key;
        if (std::optional<Mistake> mistake = value_mistake(named, setting.value_in(settings))) {
            mistake->where = where;
            mistakes.push_back(std::move(*mistake));
        }
    }
    return mistakes;
}

/// As above, of settings that exist only with their section.
template <class Settings>
std::vector<Mistake> setting_mistakes(const std::optional<Settings>& settings, const std::string& section, const std::string& where) {
    return settings ? setting_mistakes(*settings, section, where) : std::vector<Mistake>();
}

}  // namespace cutterflow::coupling
