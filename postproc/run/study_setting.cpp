#include "postproc/run/study_setting.hpp"

#include <initializer_list>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/toml.hpp"

namespace cutterflow::postproc {
namespace {

constexpr std::initializer_list<const char*> k_release_keys{"seed", "start_revolution"};

toml::table parsed(const std::string& toml, const std::string& where) {
    try {
        return toml::parse(toml);
    } catch (const std::runtime_error& error) {  // toml::parse_error or TomlAssertion
        throw UserError({{where, fmt::format("a study cannot be read as TOML: {}", error.what()), "",
                          "Give a run directory written by `cutterflow run`"}});
    }
}

void erase_keys(toml::table* table, std::initializer_list<const char*> keys) {
    if (table)
        for (const char* key : keys) table->erase(key);
}

template <typename Each>
void for_each_feed(toml::table& study, const Each& each) {
    if (toml::array* feeds = study["feed"].as_array())
        for (toml::node& feed : *feeds)
            if (toml::table* table = feed.as_table()) each(*table);
}

/// Every value by its path; 60 and 60.0 are the same number.
void add_values(const toml::node& node, const std::string& path, std::map<std::string, std::string>& values) {
    if (const toml::table* table = node.as_table())
        for (auto&& [key, value] : *table)
            add_values(value, path.empty() ? std::string(key.str()) : fmt::format("{}.{}", path, key.str()), values);
    else if (const toml::array* array = node.as_array())
        for (std::size_t i = 0; i < array->size(); ++i) add_values(*array->get(i), fmt::format("{}[{}]", path, i + 1), values);
    else if (node.is_number())
        values[path] = fmt::format("{:.9g}", node.value_or(0.0));
    else if (node.is_boolean())
        values[path] = node.value_or(false) ? "true" : "false";
    else
        values[path] = node.value_or(std::string());
}

std::string release_of(toml::table& study) {
    std::string text;
    for_each_feed(study, [&](toml::table& feed) {
        for (const char* key : k_release_keys) text += fmt::format("{}{:.9g};", key, feed[key].value_or(0.0));
    });
    return text;
}

/// In place of their names: "cutter, SHA-256" for "cutter.file". Places of measurement change no result.
void add_files(const std::map<std::string, std::string>& files, std::map<std::string, std::string>& values) {
    const std::string ending = ".file";
    for (const auto& [key, hash] : files) {
        if (key == "report.adv_points") continue;
        values.erase(key);
        const bool is_of_section = key.size() > ending.size() && key.compare(key.size() - ending.size(), ending.size(), ending) == 0;
        values[(is_of_section ? key.substr(0, key.size() - ending.size()) : key) + ", SHA-256"] = hash.substr(0, 12);
    }
}

}  // namespace

std::map<std::string, std::string> study_values(const std::string& toml, const std::string& where) {
    std::map<std::string, std::string> values;
    add_values(parsed(toml, where), "", values);
    return values;
}

StudySetting study_setting(const std::string& toml, const std::map<std::string, std::string>& files) {
    toml::table study = parsed(toml, "");
    StudySetting setting{{}, release_of(study)};
    study.erase("name");
    erase_keys(study["report"].as_table(), {"adv_points", "adv_probe_diameter_m", "adv_probe_length_m", "adv_position_error_m"});
    erase_keys(study["run"].as_table(), {"checkpoint_interval_s", "write_interval_s"});
    for_each_feed(study, [](toml::table& feed) { erase_keys(&feed, k_release_keys); });
    add_values(study, "", setting.values);
    add_files(files, setting.values);
    return setting;
}

}  // namespace cutterflow::postproc
