#include "postproc/analysis/settings/setting_comparison.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "geometry/base/json_document.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/statistics/sample.hpp"
#include "postproc/analysis/comparison.hpp"
#include "postproc/analysis/settings/distinct_runs.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/draw/page.hpp"
#include "postproc/run/input_files.hpp"
#include "postproc/run/study_setting.hpp"

namespace cutterflow::postproc {

namespace {

namespace fs = std::filesystem;

constexpr const char* k_repeat = "_repeat";
constexpr double k_unknown = std::numeric_limits<double>::quiet_NaN();

/// "pipe_hole_0_repeat2" as the name of a setting and its repeat; a run that is alone is repeat 1.
std::pair<std::string, int> name_and_repeat(const fs::path& run) {
    const std::string name = (run.has_filename() ? run : run.parent_path()).filename().string();
    const std::size_t at = name.rfind(k_repeat);
    if (at == std::string::npos) return {name, 1};
    const std::string number = name.substr(at + std::string(k_repeat).size());
    if (number.empty() || number.find_first_not_of("0123456789") != std::string::npos) return {name, 1};
    int repeat = 1;
    if (std::from_chars(number.data(), number.data() + number.size(), repeat).ec != std::errc()) return {name, 1};
    return {name.substr(0, at), repeat};
}

struct RunSetting {
    std::map<std::string, std::string> values;  // of the study by their paths, without what tells repeats apart
    std::map<std::string, std::string> files;   // SHA-256 of the files that the study names
    std::string seeds;                          // of all its tables

    bool is_that_of(const RunSetting& other) const { return values == other.values && files == other.files; }
};

std::map<std::string, std::string> files_of(const fs::path& run) {
    const fs::path manifest = run / names::manifest;
    if (!fs::exists(manifest)) return {};
    return input_files(read_json_document(manifest, {{"stages", JsonKind::object}}, "Start again in another directory with -o"));
}

bool is_seed(const std::string& path) {
    return path == "seed" || (path.size() > 5 && path.compare(path.size() - 5, 5, ".seed") == 0);
}

/// Of a study in TOML: all but its name and seeds. Without seeds, repeats are told apart by the numbers of their folders.
RunSetting setting_of(const fs::path& run, const std::string& study_file) {
    const auto [name, repeat] = name_and_repeat(run);
    const fs::path study = run / study_file;
    RunSetting setting;
    if (!fs::exists(study)) {
        setting.values[name] = "";
    } else {
        setting.files = files_of(run);
        for (const auto& [path, value] : study_values(read_file(study), study.string())) {
            if (is_seed(path))
                setting.seeds += (setting.seeds.empty() ? "" : ", ") + value;
            else if (path != "name")
                setting.values[path] = value;
        }
    }
    if (setting.seeds.empty()) setting.seeds = std::to_string(repeat);
    return setting;
}

/// \throws UserError  with the mistakes of all runs
std::vector<RunSetting> settings_of(const std::vector<fs::path>& runs, const std::string& study_file) {
    std::vector<RunSetting> settings(runs.size());
    Mistakes mistakes;
    for (std::size_t n = 0; n < runs.size(); ++n) mistakes.gather([&] { settings[n] = setting_of(runs[n], study_file); });
    mistakes.refuse();
    return settings;
}

/// A setting of the comparison, by its first run.
struct FirstRun {
    fs::path folder;
    RunSetting setting;
};

/// Names that settings share, and how many share each.
std::map<std::string, int> name_counts(const std::vector<SettingResults>& settings) {
    std::map<std::string, int> count;
    for (const SettingResults& setting : settings) ++count[setting.name];
    return count;
}

/// Files in which a setting differs from another one of the same study, as "solid.ramp.file 3f2a41b7".
std::string differing_files(const RunSetting& setting, const std::vector<FirstRun>& first_runs) {
    std::string words;
    for (const auto& [key, hash] : setting.files) {
        const bool differs = std::any_of(first_runs.begin(), first_runs.end(), [&, name = key, content = hash](const FirstRun& other) {
            const auto found = other.setting.files.find(name);
            return other.setting.values == setting.values && found != other.setting.files.end() && found->second != content;
        });
        if (differs) words += fmt::format(", {} {}", key, hash.substr(0, 8));
    }
    return words;
}

/// Puts the folder above it before the name of a setting that another one shares, and behind it the files in which alone they differ.
void tell_names_apart(std::vector<SettingResults>& settings, const std::vector<FirstRun>& first_runs) {
    auto count = name_counts(settings);
    for (std::size_t n = 0; n < settings.size(); ++n)
        if (count[settings[n].name] > 1)
            settings[n].name = (fs::absolute(first_runs[n].folder).lexically_normal().parent_path().filename() / settings[n].name).string();
    count = name_counts(settings);
    for (std::size_t n = 0; n < settings.size(); ++n)
        if (count[settings[n].name] > 1) settings[n].name += differing_files(first_runs[n].setting, first_runs);
}

bool have_same_seeds(const SettingResults& a, const SettingResults& b) {
    return a.repeats.size() == b.repeats.size() && std::is_permutation(a.repeats.begin(), a.repeats.end(), b.repeats.begin());
}

/// \pre both have the same seeds
RepeatMean paired_difference(const SettingResults& setting, const SettingResults& first, std::size_t quantity) {
    std::vector<double> differences;
    for (std::size_t n = 0; n < setting.repeats.size(); ++n) {
        const auto same = std::find(first.repeats.begin(), first.repeats.end(), setting.repeats[n]);
        differences.push_back(setting.quantities[quantity].each[n] -
                              first.quantities[quantity].each[static_cast<std::size_t>(same - first.repeats.begin())]);
    }
    return repeat_mean(differences);
}

/// Of repeats that have nothing in common.
RepeatMean independent_difference(const SettingQuantity& quantity, const SettingQuantity& first) {
    RepeatMean difference{quantity.mean.mean - first.mean.mean, k_unknown};
    if (std::isfinite(quantity.mean.half) && std::isfinite(first.mean.half))
        difference.half = half_interval_of_two(sample_of(first.each), sample_of(quantity.each));
    return difference;
}

/// "0.321 +- 0.012 s"; what is not known is left out.
std::string mean_text(const RepeatMean& value, const std::string& unit, bool sign = false) {
    if (!std::isfinite(value.mean)) return "-";
    const std::string mean = sign ? fmt::format("{:+.4g}", value.mean) : fmt::format("{:.4g}", value.mean);
    const std::string half = std::isfinite(value.half) ? fmt::format(" +- {:.2g}", value.half) : "";
    return mean + half + (unit == "-" ? "" : " " + unit);
}

/// The mean, or of how many repeats a value is known.
std::string value_text(const SettingQuantity& quantity) {
    const std::size_t known = quantity.known();
    if (known == 0 || known == quantity.each.size()) return mean_text(quantity.mean, quantity.unit);
    return fmt::format("{} of {} repeats have a value{}", known, quantity.each.size(),
                       quantity.reason.empty() ? "" : " (" + quantity.reason + ")");
}

/// Why no run has a value, of the first that says so.
std::string reason_of(const std::vector<SettingResults>& settings, std::size_t quantity) {
    for (const SettingResults& setting : settings)
        if (!setting.quantities[quantity].reason.empty()) return setting.quantities[quantity].reason;
    return "";
}

bool is_known(const std::vector<SettingResults>& settings, std::size_t quantity) {
    return std::any_of(settings.begin(), settings.end(), [&](const SettingResults& setting) {
        const SettingQuantity& found = setting.quantities[quantity];
        return std::any_of(found.each.begin(), found.each.end(),
                           [&](double value) { return std::isfinite(value) && (value != 0.0 || !found.zero_is_nothing); });
    });
}

nlohmann::json json_of(const RepeatMean& value) {
    const auto number = [](double n) { return std::isfinite(n) ? nlohmann::json(n) : nlohmann::json(nullptr); };
    return {{"mean", number(value.mean)}, {"half_width", number(value.half)}};
}

void require_different(const std::vector<fs::path>& runs, const std::vector<RunSetting>& settings, const std::string& study_file) {
    const auto are_one_run = [&](std::size_t a, std::size_t b) {
        const fs::path first = runs[a] / names::manifest, second = runs[b] / names::manifest;
        const bool one_manifest = fs::exists(first) && fs::exists(second) && read_file(first) == read_file(second);  // with its times
        return one_manifest ||
               (fs::exists(runs[a] / study_file) && settings[a].is_that_of(settings[b]) && settings[a].seeds == settings[b].seeds);
    };
    require_distinct(runs, are_one_run, "seed");
}

std::vector<std::string> warnings_of(const std::vector<SettingResults>& settings) {
    std::vector<std::string> warnings;
    for (const SettingResults& setting : settings) warnings.insert(warnings.end(), setting.warnings.begin(), setting.warnings.end());
    return warnings;
}

/// Of every run, the same ones. \throws UserError  with the mistakes of all runs
std::vector<std::vector<RunQuantity>> quantities_of_all(const std::vector<fs::path>& runs, const std::vector<RunSetting>& of_runs,
                                                        const std::string& study_file,
                                                        const std::function<std::vector<RunQuantity>(const fs::path&)>& quantities_of) {
    Mistakes mistakes;
    mistakes.gather([&] { require_different(runs, of_runs, study_file); });
    std::vector<std::vector<RunQuantity>> all(runs.size());
    for (std::size_t n = 0; n < runs.size(); ++n) mistakes.gather([&] { all[n] = quantities_of(runs[n]); });
    mistakes.refuse();
    const auto same = [](const RunQuantity& a, const RunQuantity& b) { return a.key == b.key; };
    for (std::size_t n = 1; n < runs.size(); ++n)
        mistakes.require(std::equal(all[0].begin(), all[0].end(), all[n].begin(), all[n].end(), same),
                         fmt::format("{} measures something else than {}", runs[n].string(), name_and_repeat(runs.front()).first),
                         "Runs beside each other have the same measures",
                         "Give them the same [[measure]] tables: cutterflow measure makes them anew");
    mistakes.refuse();
    return all;
}

}  // namespace

std::size_t SettingQuantity::known() const {
    return static_cast<std::size_t>(std::count_if(each.begin(), each.end(), [](double value) { return std::isfinite(value); }));
}

RepeatMean repeat_mean(const std::vector<double>& values) {
    if (values.empty() || !std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
        return {k_unknown, k_unknown};
    const Sample sample = sample_of(values);
    return {sample.mean, sample.count < k_fewest_repeats ? k_unknown : half_interval(sample)};
}

std::string verdict_of(const RepeatMean& difference) {
    if (!std::isfinite(difference.half)) return "no interval";
    if (std::abs(difference.mean) <= difference.half) return "not told apart";
    return difference.mean > 0.0 ? "higher" : "lower";
}

std::vector<SettingResults> compare_settings(const std::vector<fs::path>& runs, const std::string& study_file,
                                             const std::function<std::vector<RunQuantity>(const fs::path&)>& quantities_of,
                                             const std::function<std::string(const fs::path&)>& warning_of) {
    const std::vector<RunSetting> setting_of_run = settings_of(runs, study_file);
    const std::vector<std::vector<RunQuantity>> of_runs = quantities_of_all(runs, setting_of_run, study_file, quantities_of);
    std::vector<SettingResults> settings;
    std::vector<FirstRun> first_runs;
    for (std::size_t n = 0; n < runs.size(); ++n) {
        const std::vector<RunQuantity>& quantities = of_runs[n];
        const auto known = std::find_if(first_runs.begin(), first_runs.end(),
                                        [&](const FirstRun& first) { return first.setting.is_that_of(setting_of_run[n]); });
        const auto number = static_cast<std::size_t>(known - first_runs.begin());
        if (known == first_runs.end()) {
            settings.push_back({name_and_repeat(runs[n]).first, {}, {}});
            first_runs.push_back({runs[n], setting_of_run[n]});
            for (const RunQuantity& one : quantities)
                settings.back().quantities.push_back({one.key, one.name, one.unit, one.zero_is_nothing, {}, {}, {}, {}});
        }
        SettingResults& setting = settings[number];
        setting.repeats.push_back(setting_of_run[n].seeds);
        if (const std::string warning = warning_of ? warning_of(runs[n]) : ""; !warning.empty()) setting.warnings.push_back(warning);
        for (std::size_t q = 0; q < quantities.size(); ++q) {
            setting.quantities[q].each.push_back(quantities[q].value);
            if (setting.quantities[q].reason.empty()) setting.quantities[q].reason = quantities[q].reason;
        }
    }
    tell_names_apart(settings, first_runs);
    for (SettingResults& setting : settings) {
        for (std::size_t q = 0; q < setting.quantities.size(); ++q) {
            setting.quantities[q].mean = repeat_mean(setting.quantities[q].each);
            setting.quantities[q].difference = have_same_seeds(setting, settings.front())
                                                   ? paired_difference(setting, settings.front(), q)
                                                   : independent_difference(setting.quantities[q], settings.front().quantities[q]);
        }
    }
    return settings;
}

std::string unfinished_text(const fs::path& run, double reached, double end) {
    return fmt::format("{} is not finished: it has come to {:.4g} of {:g} s", run.string(), reached, end);
}

std::string setting_comparison_text(const std::vector<SettingResults>& settings) {
    std::string text;
    for (std::size_t q = 0; q < settings.front().quantities.size(); ++q) {
        if (!is_known(settings, q)) {
            if (const std::string reason = reason_of(settings, q); !reason.empty())
                text += fmt::format("{}\n  no value: {}\n", settings.front().quantities[q].name, reason);
            continue;
        }
        text += fmt::format("{}\n", settings.front().quantities[q].name);
        for (const SettingResults& setting : settings) {
            const SettingQuantity& found = setting.quantities[q];
            text += fmt::format("  {:<40} {:<24}", setting.name, value_text(found));
            if (&setting != &settings.front())
                text += fmt::format(" difference {}: {}", mean_text(found.difference, found.unit, true), verdict_of(found.difference));
            text += fmt::format("  ({} run{})\n", setting.repeats.size(), setting.repeats.size() == 1 ? "" : "s");
        }
    }
    text +=
        "value +- half the 95 % interval (Student's t over three or more repeats); differences from the first setting, in pairs of "
        "repeats where all seeds are the same, else by Welch's test\n";
    for (const std::string& warning : warnings_of(settings)) text += fmt::format("warning: {}\n", warning);
    return text;
}

nlohmann::json setting_comparison_json(const std::vector<SettingResults>& settings, const std::string& schema) {
    nlohmann::json rows = nlohmann::json::array();
    for (const SettingResults& setting : settings) {
        nlohmann::json row{{"name", setting.name}, {"repeats", setting.repeats.size()}};
        for (const SettingQuantity& quantity : setting.quantities)
            row[quantity.key] = {
                {"value", json_of(quantity.mean)},
                {"repeats_with_a_value", quantity.known()},
                {"reason", quantity.reason.empty() ? nlohmann::json() : nlohmann::json(quantity.reason)},
                {"difference", json_of(quantity.difference)},
                {"verdict", &setting == &settings.front() ? nlohmann::json() : nlohmann::json(verdict_of(quantity.difference))}};
        rows.push_back(row);
    }
    return {{"schema", schema}, {"settings", rows}, {"warnings", warnings_of(settings)}};
}

fs::path write_setting_comparison(const std::vector<SettingResults>& settings, const std::string& schema, const fs::path& folder) {
    require_own_folder(folder, "comparison.json");
    fs::create_directories(folder);
    write_file(folder / "comparison.json", setting_comparison_json(settings, schema).dump(2) + "\n");
    std::string body = "<header><h1>Comparison of runs</h1></header>\n" + html::notices(warnings_of(settings));
    for (std::size_t q = 0; q < settings.front().quantities.size(); ++q) {
        if (!is_known(settings, q)) continue;
        std::vector<std::vector<std::string>> rows;
        for (const SettingResults& setting : settings) {
            const SettingQuantity& found = setting.quantities[q];
            const bool is_first = &setting == &settings.front();
            rows.push_back({html::escape(setting.name), fmt::format("{}", setting.repeats.size()), value_text(found),
                            is_first ? "" : mean_text(found.difference, found.unit, true), is_first ? "" : verdict_of(found.difference)});
        }
        body += html::section(settings.front().quantities[q].name,
                              html::table({"setting", "runs", "mean", "difference from the first", "verdict"}, rows, true));
    }
    body +=
        "<p>Mean and half of the 95 % interval (Student's t over three or more repeats); differences in pairs of repeats where all "
        "seeds are the same, else by Welch's test. Higher or lower: "
        "the interval "
        "of the difference "
        "leaves 0 out.</p>";
    const Page page(folder / "index.html", PageForm::live);
    page.write("Comparison of runs", body, "");
    return folder / "index.html";
}

}  // namespace cutterflow::postproc
