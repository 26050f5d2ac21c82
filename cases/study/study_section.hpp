#pragma once
/// \file Sections of the study that hold settings of the solver as they are: their keys are those of constant/couplingProperties in the
/// study's spelling.
#include <algorithm>
#include <cctype>
#include <string>

#include "geometry/base/parameters/parameter.hpp"
#include "solver/ports/dem_settings.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::cases {

/// minWidthInCells -> min_width_in_cells.
inline std::string snake_case(const std::string& words) {
    std::string text;
    for (const char letter : words) {
        const auto character = static_cast<unsigned char>(letter);
        if (std::isupper(character) != 0) text += '_';
        text += static_cast<char>(std::tolower(character));
    }
    return text;
}

inline std::string lower_case(std::string text) {
    for (char& letter : text) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return text;
}

template <class Settings>
struct StudySection {
    const char* name;
    /// A setting that follows from the study instead (null: there is none).
    const char* derived_setting = nullptr;

    bool offers(const coupling::Setting<Settings>& setting) const {
        return derived_setting == nullptr || setting.parameter.key != derived_setting;
    }
    /// With its unit, as everywhere in a study: rock.youngs_modulus_pa.
    std::string key_of(const coupling::Setting<Settings>& setting) const {
        const std::string& unit = setting.parameter.unit;
        return std::string(name) + "." + snake_case(setting.parameter.key) + (unit == "-" ? "" : "_" + lower_case(unit));
    }
    /// Rows of the settings that a study offers, in its spelling.
    ParameterTable rows() const {
        ParameterTable all;
        for (const coupling::Setting<Settings>& setting : coupling::setting_table<Settings>()) {
            if (!offers(setting)) continue;
            all.push_back(setting.parameter);
            all.back().key = key_of(setting);
        }
        return all;
    }
    /// \pre there is such a setting
    static const Parameter& row(const std::string& key_in_dictionary) {
        const auto& table = coupling::setting_table<Settings>();
        return std::find_if(table.begin(), table.end(), [&](const auto& setting) { return setting.parameter.key == key_in_dictionary; })
            ->parameter;
    }
    Settings read(const ParameterValues& resolved) const {
        Settings settings;
        for (const coupling::Setting<Settings>& setting : coupling::setting_table<Settings>())
            if (offers(setting)) setting.assign(settings, *resolved.find(key_of(setting)));
        return settings;
    }
};

/// Keys of a pair of materials, as "rock.friction_steel".
inline std::string key_of(const coupling::MaterialPair& pair, const coupling::Setting<coupling::PairSettings>& setting) {
    return "rock." + snake_case(setting.parameter.key) + "_" + pair.other;
}

inline constexpr const char* k_preset_key = "rock.preset";
inline constexpr StudySection<coupling::ContactSettings> k_contact_section{"rock", "maxSpeed"};
inline constexpr StudySection<coupling::ClosureSettings> k_closure_section{"closures"};
inline constexpr StudySection<coupling::KernelSettings> k_kernel_section{"kernel"};

}  // namespace cutterflow::cases
