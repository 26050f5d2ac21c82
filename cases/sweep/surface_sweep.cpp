#include "cases/sweep/surface_sweep.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

#include <fmt/format.h>

#include "cases/scenes/free_surface/surface_study.hpp"
#include "geometry/base/error.hpp"

namespace cutterflow::cases {

namespace {

constexpr const char* k_seed = "bodies.seed";

const Parameter* parameter_of(const std::string& key) {
    const ParameterTable& table = surface_study_table();
    const auto found = std::find_if(table.begin(), table.end(), [&](const Parameter& parameter) { return parameter.key == key; });
    return found == table.end() ? nullptr : &*found;
}

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
    return parts;
}

/// \throws UserError  when the text is no value of the parameter's kind
ParameterValue value_of(const Parameter& parameter, const std::string& text) {
    if (parameter.kind == ParameterKind::path) return std::filesystem::absolute(text).string();  // the points lie in other folders
    if (parameter.kind != ParameterKind::number && parameter.kind != ParameterKind::integer) return text;
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' ||
        (parameter.kind == ParameterKind::integer && number != static_cast<double>(static_cast<std::int64_t>(number))))
        throw UserError(fmt::format("--set {}={}", parameter.key, text), "The value is a number", "Correct it");
    if (parameter.kind == ParameterKind::integer) return static_cast<std::int64_t>(number);
    return number;
}

/// Changes a key, in a repeated section in every table that gives it. \return how many
int set(ParameterValues& values, const Parameter& parameter, const std::function<ParameterValue(const ParameterValues&)>& value) {
    if (!parameter.repeated) {
        values.set(parameter.key, value(values));
        return 1;
    }
    int count = 0;
    for (ParameterValues& table : values.tables_for_writing(parameter.key.substr(0, parameter.key.find('.')))) {
        if (table.where(parameter.key).empty()) continue;
        table.set(parameter.key, value(table));
        ++count;
    }
    return count;
}

/// Letters, digits and the like, for names of folders.
std::string safe(std::string text) {
    for (char& c : text)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
    return text;
}

struct Setting {
    std::string name;
    ParameterValues values;
};

std::vector<Setting> settings_of(const Setting& base, const std::vector<SurfaceAxis>& axes) {
    std::vector<Setting> settings{base};
    for (const SurfaceAxis& axis : axes) {
        const Parameter& parameter = *parameter_of(axis.key);
        std::vector<Setting> varied;
        for (const Setting& setting : settings) {
            for (const std::string& text : axis.values) {
                Setting one = setting;
                const ParameterValue value = value_of(parameter, text);
                if (set(one.values, parameter, [&](const ParameterValues&) { return value; }) == 0)
                    throw UserError(fmt::format("--set {}: no table of the study gives this key", axis.key),
                                    "A sweep changes what is there", "Write the key into the tables that it shall change");
                one.name += fmt::format("_{}_{}", safe(axis.key.substr(axis.key.find('.') + 1)), safe(text));
                varied.push_back(std::move(one));
            }
        }
        settings = std::move(varied);
    }
    return settings;
}

}  // namespace

std::vector<SurfaceAxis> surface_axes(const std::vector<std::string>& words) {
    std::vector<SurfaceAxis> axes;
    std::vector<Mistake> mistakes;
    for (const std::string& word : words) {
        const std::size_t equals = word.find('=');
        const SurfaceAxis axis{word.substr(0, equals),
                               equals == std::string::npos ? std::vector<std::string>{} : split(word.substr(equals + 1))};
        if (axis.values.empty()) mistakes.push_back({"", fmt::format("--set {}", word), "It is written as KEY=a,b", "Give the values"});
        if (!parameter_of(axis.key)) {
            std::vector<std::string> known;
            for (const Parameter& parameter : surface_study_table()) known.push_back(parameter.key);
            const std::string nearest = nearest_word(axis.key, known);
            mistakes.push_back({"", fmt::format("--set {}: there is no such key", axis.key),
                                "cutterflow params --kind free_surface lists them",
                                nearest.empty() ? "Correct it" : fmt::format("Did you mean {}?", nearest)});
        }
        axes.push_back(axis);
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    return axes;
}

std::vector<SweepPoint> surface_sweep_points(const std::filesystem::path& study, const std::vector<SurfaceAxis>& axes, int repeats) {
    const ParameterValues values = read_placed_surface_study(study);  // the points lie in other folders
    std::vector<SweepPoint> points;
    std::vector<Mistake> mistakes;
    for (const Setting& setting : settings_of({safe(study.stem().string()), values}, axes)) {
        for (int repeat = 0; repeat < repeats; ++repeat) {
            Setting one = setting;
            if (repeats > 1) {
                one.name += fmt::format("_repeat{}", repeat + 1);
                set(one.values, *parameter_of(k_seed), [&](const ParameterValues& table) { return table.integer(k_seed) + repeat; });
            }
            one.values.set("name", fmt::format("{}: {}", values.text("name"), one.name));
            const std::string text = commented_toml(surface_study_table(), &one.values);
            try {
                require_surface_study(text, one.name);
            } catch (const UserError& error) {
                for (const Mistake& mistake : error.mistakes()) mistakes.push_back(mistake);
            }
            points.push_back({one.name, text, "", {}});
        }
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    return points;
}

}  // namespace cutterflow::cases
