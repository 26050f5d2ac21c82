// One row per setting: keys once each, defaults within their own bounds, and every bound kept by the check.
#include <limits>
#include <optional>
#include <set>

#include <gtest/gtest.h>

#include "solver/ports/dem_settings.hpp"
#include "solver/ports/setting_table.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::coupling {
namespace {

template <class Settings>
Settings defaults_of(const Settings&) {
    return {};
}

template <class Settings>
Settings defaults_of(const std::optional<Settings>&) {
    return {};
}

/// Calls `check` with the defaults of each struct that has a table.
template <class Check>
void for_every_table(Check check) {
    const CouplingSettings settings;
    const auto check_defaults = [&](const auto& section) { check(defaults_of(section)); };
    visit_coupling_sections(settings, [&](const char*, const auto& section) { check_defaults(section); });
    check_defaults(ContactSettings());
    check_defaults(PairSettings());
    check_defaults(settings.soil);
    check_defaults(settings.queue);
    check_defaults(settings.outflow);
    check_defaults(settings.stop);
    check_defaults(settings.checkpoint);
    check_defaults(settings.record);
}

/// Settings that the table allows.
template <class Settings>
Settings good_settings() {
    Settings settings;
    for (const Setting<Settings>& setting : setting_table<Settings>())
        if (!setting.parameter.default_value) setting.assign(settings, setting.parameter.maximum.value_or(1.0));
    return settings;
}

/// The number as the setting's kind has it.
ParameterValue as_kind(const Parameter& parameter, double number) {
    if (parameter.kind == ParameterKind::integer) return static_cast<std::int64_t>(number);
    return number;
}

/// The nearest value on the other side of a bound.
double beyond(const Parameter& parameter, double bound, double outwards) {
    if (parameter.kind == ParameterKind::integer) return bound + outwards;
    return std::nextafter(bound, outwards * std::numeric_limits<double>::infinity());
}

template <class Settings>
std::size_t mistakes_with(const Setting<Settings>& setting, double number) {
    Settings settings = good_settings<Settings>();
    setting.assign(settings, as_kind(setting.parameter, number));
    return setting_mistakes(settings, "section", "file").size();
}

template <class Settings>
void expect_keys_once_with_help_and_an_allowed_default(const Settings& defaults) {
    std::set<std::string> keys;
    for (const Setting<Settings>& setting : setting_table<Settings>()) {
        EXPECT_TRUE(keys.insert(setting.parameter.key).second) << setting.parameter.key;
        EXPECT_FALSE(setting.parameter.help.empty()) << setting.parameter.key;
        if (!setting.parameter.default_value) continue;
        EXPECT_EQ(*setting.parameter.default_value, setting.value_in(defaults)) << setting.parameter.key;
        EXPECT_FALSE(value_mistake(setting.parameter, *setting.parameter.default_value)) << setting.parameter.key;
    }
    EXPECT_TRUE(setting_mistakes(good_settings<Settings>(), "section", "file").empty());
}

TEST(SettingTables, have_every_key_once_with_help_and_an_allowed_default) {
    for_every_table([](const auto& defaults) { expect_keys_once_with_help_and_an_allowed_default(defaults); });
}

template <class Settings>
void expect_bounds_kept(const Settings&) {
    for (const Setting<Settings>& setting : setting_table<Settings>()) {
        const Parameter& parameter = setting.parameter;
        if (parameter.minimum) {
            const double least = *parameter.minimum;
            EXPECT_EQ(mistakes_with(setting, least), parameter.minimum_excluded ? 1u : 0u) << parameter.key;
            EXPECT_EQ(mistakes_with(setting, beyond(parameter, least, 1.0)), 0u) << parameter.key;
            EXPECT_EQ(mistakes_with(setting, beyond(parameter, least, -1.0)), 1u) << parameter.key;
        }
        if (parameter.maximum) {
            EXPECT_EQ(mistakes_with(setting, *parameter.maximum), 0u) << parameter.key;
            EXPECT_EQ(mistakes_with(setting, beyond(parameter, *parameter.maximum, 1.0)), 1u) << parameter.key;
        }
        if (parameter.kind == ParameterKind::number) {
            EXPECT_EQ(mistakes_with(setting, std::numeric_limits<double>::quiet_NaN()), 1u) << parameter.key;
            EXPECT_EQ(mistakes_with(setting, std::numeric_limits<double>::infinity()), 1u) << parameter.key;
        }
    }
}

TEST(SettingTables, accept_every_bound_and_refuse_what_is_next_beyond_it) {
    for_every_table([](const auto& defaults) { expect_bounds_kept(defaults); });
}

template <class Settings>
void expect_names_in_mistakes(const Settings&) {
    for (const Setting<Settings>& setting : setting_table<Settings>()) {
        if (!setting.parameter.minimum) continue;
        Settings settings = good_settings<Settings>();
        setting.assign(settings, as_kind(setting.parameter, *setting.parameter.minimum - 1.0));
        const std::vector<Mistake> mistakes = setting_mistakes(settings, "section", "file");
        ASSERT_EQ(mistakes.size(), 1u) << setting.parameter.key;
        EXPECT_EQ(mistakes[0].where, "file");
        EXPECT_EQ(mistakes[0].what.rfind("section." + setting.parameter.key + " = ", 0), 0u) << mistakes[0].what;
    }
}

TEST(SettingTables, name_the_section_the_key_and_the_file) {
    for_every_table([](const auto& defaults) { expect_names_in_mistakes(defaults); });
}

}  // namespace
}  // namespace cutterflow::coupling
