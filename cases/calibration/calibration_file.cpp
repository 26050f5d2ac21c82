#include "cases/calibration/calibration_file.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/scenes/study_kind.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/parameters/parameter_reading.hpp"
#include "geometry/base/parameters/parameter_row.hpp"
#include "geometry/base/profiles/profile.hpp"

namespace cutterflow::cases {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_most_parameters = 4;
constexpr int k_default_values = 5;
constexpr double k_between = 0.3819660113;  // place in a range that is no value of a grid and no whole number
constexpr int k_profile_places = 100;       // N of the profile error [WasserfallCoetzeeMeyer2024]

std::vector<std::string> objective_names() {
    std::vector<std::string> names;
    for (const calibration::ObjectiveFunction& row : calibration::objective_functions()) names.emplace_back(row.name);
    return names;
}

std::string objective_help() {
    std::string help;
    for (const calibration::ObjectiveFunction& row : calibration::objective_functions())
        help += fmt::format("{}{}: {}. {}", help.empty() ? "" : " ", row.name, row.equation, row.help);
    return help;
}

ParameterTable make_table() {
    using Kind = ParameterKind;
    using Row = ParameterRow;
    return {
        Row("name", Kind::text, "-", "Title of the page.").by_default(std::string("calibration")),
        Row("study", Kind::texts, "-", "Study files, relative to this file; all have the keys that are varied."),
        Row("method", Kind::choice, "-",
            "surface: a grid, then places where its quadratic fit is best; grid: the grid alone; bobyqa: an optimiser that chooses every "
            "place.")
            .one_of({"surface", "grid", "bobyqa"})
            .by_default(std::string("surface")),
        Row("objective", Kind::choice, "-", objective_help())
            .one_of(objective_names())
            .by_default(std::string("squared_misfit"))
            .source("WasserfallCoetzeeMeyer2024"),
        Row("repeats", Kind::integer, "-", "Runs of each study at each place; they differ in the seed.")
            .at_least(1)
            .at_most(100)
            .by_default(std::int64_t{3}),
        Row("repeats_at_answer", Kind::integer, "-",
            "Runs of each study at the chosen parameters, with seeds of their own. Held-out targets are judged there alone.")
            .at_least(1)
            .at_most(100)
            .by_default(std::int64_t{3}),
        Row("rounds", Kind::integer, "-", "Rounds of up to three further places after the grid of surface, while an interval is too wide.")
            .at_least(0)
            .at_most(50)
            .by_default(std::int64_t{2}),
        Row("evaluations", Kind::integer, "-", "Places that bobyqa may try.").at_least(5).at_most(1000).by_default(std::int64_t{30}),
        Row("budget.runs", Kind::integer, "-", "Runs that the plan may take.").at_least(1),
        Row("budget.core_h", Kind::number, "h", "Core hours that the plan may take; no new place is begun once they are spent.").above(0),
        Row("parameter.name", Kind::text, "-", "What it is called in results.").derived("the key").repeated(),
        Row("parameter.key", Kind::text, "-",
            "Key of the studies, as of sweep --set; a table of an array by its name: contact.gravel-steel.friction.")
            .repeated(),
        Row("parameter.range", Kind::numbers, "-", "Lowest and highest value.").of_length(2).repeated(),
        Row("parameter.values", Kind::numbers, "-", "Values of the grid.").derived("five even ones of the range").repeated(),
        Row("parameter.tolerance", Kind::number, "-", "Half of a 95 % interval that is narrow enough; surface stops there.")
            .above(0)
            .derived("a tenth of the range")
            .repeated(),
        Row("target.name", Kind::text, "-", "What it is called in results.").derived("study and measure").repeated(),
        Row("target.measure", Kind::text, "-",
            "Name of a measure of the study; of a study without measures a number of report/results.json by its keys, as a.b.")
            .repeated(),
        Row("target.study", Kind::text, "-", "File name of its study, without ending.").derived("the only study").repeated(),
        Row("target.value", Kind::number, "-", "What was measured, in the unit of the measure.")
            .derived("none: it has a profile")
            .repeated(),
        Row("target.profile", Kind::path, "-",
            fmt::format("CSV file with the columns x_m,height_m, relative to this file: heights at {} even places are compared with the "
                        "profile of the measure.",
                        k_profile_places))
            .derived("none: it has a value")
            .repeated(),
        Row("target.lowest_m", Kind::number, "m", "Places where the measured profile is not above this are left out.")
            .at_least(0)
            .derived("0")
            .repeated(),
        Row("target.tolerance", Kind::number, "-", "Half of the 95 % interval of what was measured, in its unit.").above(0).repeated(),
        Row("target.weight", Kind::number, "-", "In the objective.").above(0).derived("1").repeated(),
        Row("target.held_out", Kind::boolean, "-", "Never in the objective, always reported.").by_default(false).repeated(),
    };
}

CalibrationPlan plan_of(const CalibrationFile& file, const StudyAccess& access) {
    constexpr std::size_t places_of_a_round = 3;
    CalibrationPlan plan;
    if (file.method == "bobyqa") {
        plan.further = static_cast<std::size_t>(file.evaluations);
    } else {
        plan.grid = 1;
        for (const CalibratedParameter& parameter : file.parameters) plan.grid *= parameter.values.size();
        if (file.method == "surface") plan.further = places_of_a_round * static_cast<std::size_t>(file.rounds);
    }
    const std::size_t places = plan.grid + plan.further;
    plan.runs = places * file.runs_of_a_place() + file.runs_of_the_answer();
    double core_s = 0.0;
    for (std::size_t study = 0; study < file.studies.size(); ++study) {
        const std::optional<double> one = access.predicted_core_s(file.studies[study]);
        if (!one) return plan;
        const std::size_t of_places = file.is_fitted(study) ? places * static_cast<std::size_t>(file.repeats) : 0;
        core_s += *one * static_cast<double>(of_places + static_cast<std::size_t>(file.repeats_at_answer));
    }
    plan.core_h = core_s / 3600.0;
    return plan;
}

/// What two files have in common that may share a folder: all but the budget.
std::string identity(ParameterValues values) {
    values.set("budget.runs", std::int64_t{1});
    values.set("budget.core_h", 1.0);
    return plain_toml(calibration_table(), values);
}

/// A table of an array as messages name it.
std::string place_of(const ParameterValues& values, const char* key, const fs::path& file) {
    const std::string where = values.where(key);
    return where.empty() ? file.string() : where;
}

class Reader {
public:
    Reader(const fs::path& file, const StudyAccess& access) : path_(file), access_(access), mistakes_(file.string()) {}

    CalibrationFile read() {
        if (const std::string kind = kind_named_in(path_); !kind.empty())
            throw UserError({{path_.string(), fmt::format("it is a study of kind \"{}\"", kind), "A calibration names studies",
                              "Name it as study of a calibration, or run it with cutterflow run"}});
        const ReadParameters read = parse_with_mistakes(calibration_table(), read_file(path_), path_.string());
        mistakes_.add(read.mistakes);
        const ParameterValues& values = read.values;
        read_method(values);
        read_studies(values);
        for (const ParameterValues& table : values.tables("parameter")) read_parameter(table);
        for (const ParameterValues& table : values.tables("target")) read_target(table);
        found_.measured = fitted_measured_;
        found_.measured.insert(found_.measured.end(), held_out_measured_.begin(), held_out_measured_.end());
        check_whole(values);
        check_unused(values);
        if (read.complete) read_budget(values);
        check_points();
        if (read.complete && studies_are_sound_) mistakes_.gather([&] { check_plan(); });
        mistakes_.refuse();
        found_.identity = identity(values) + profiles_;
        return found_;
    }

private:
    // A value that is wrong or missing is told by the table; what is there is read all the same.

    static std::string text_of(const ParameterValues& table, const char* key) { return table.has(key) ? table.text(key) : ""; }

    static bool is_held_out(const ParameterValues& target) { return target.has("target.held_out") && target.boolean("target.held_out"); }

    void read_method(const ParameterValues& values) {
        found_.name = text_of(values, "name");
        found_.method = text_of(values, "method");
        if (values.has("objective")) found_.objective = calibration::find_objective(values.text("objective"));
    }

    void read_studies(const ParameterValues& values) {
        if (!values.has("study")) return;
        std::set<std::string> stems;
        for (const std::string& text : values.texts("study")) {
            const fs::path study = path_.parent_path() / text;
            mistakes_.require(fs::exists(study), fmt::format("study {} does not exist", study.string()),
                              "Studies are files beside the calibration, or have paths from it", "Check the path");
            mistakes_.require(stems.insert(study.stem().string()).second, fmt::format("two studies are called {}", study.stem().string()),
                              "Runs are named after their study", "Rename one");
            found_.studies.push_back(study);
            measures_.push_back(measures_of(study));
        }
    }

    /// None of a study that cannot be read, of which check_points tells.
    std::optional<std::vector<StudyMeasure>> measures_of(const fs::path& study) const {
        if (!fs::exists(study)) return std::nullopt;
        try {
            return access_.measures(study);
        } catch (const UserError&) {
            return std::nullopt;
        }
    }

    void read_budget(const ParameterValues& values) {
        found_.repeats = static_cast<int>(values.integer("repeats"));
        found_.repeats_at_answer = static_cast<int>(values.integer("repeats_at_answer"));
        found_.rounds = static_cast<int>(values.integer("rounds"));
        found_.evaluations = static_cast<int>(values.integer("evaluations"));
        found_.budget_runs = static_cast<double>(values.integer("budget.runs"));
        found_.budget_core_h = values.number("budget.core_h");
    }

    void read_parameter(const ParameterValues& table) {
        if (!table.has("parameter.range")) return;
        CalibratedParameter parameter;
        parameter.key = text_of(table, "parameter.key");
        const std::string name = table.has("parameter.name") ? table.text("parameter.name") : parameter.key;
        const double low = table.numbers("parameter.range")[0], high = table.numbers("parameter.range")[1];
        parameter.range = {name, low, high, table.has("parameter.tolerance") ? table.number("parameter.tolerance") : 0.1 * (high - low)};
        const std::string where = place_of(table, "parameter.range", path_);
        if (!(low < high))
            mistakes_.add({where, fmt::format("the range of {} is {} to {}: it is empty", name, low, high),
                           "The first value is below the second", "Correct the range"});
        if (table.has("parameter.values")) {
            parameter.values = table.numbers("parameter.values");
            std::sort(parameter.values.begin(), parameter.values.end());
            if (const auto twice = std::adjacent_find(parameter.values.begin(), parameter.values.end()); twice != parameter.values.end())
                mistakes_.add({where, fmt::format("{} has {} twice", name, *twice), "The values of a grid differ", "Leave one out"});
            for (const double value : parameter.values)
                if (value < std::min(low, high) || value > std::max(low, high))
                    mistakes_.add({where, fmt::format("{} = {} is outside of its range, {} to {}", name, value, low, high),
                                   "The grid lies in the range", "Correct the value or the range"});
        } else {
            for (int i = 0; i < k_default_values; ++i) parameter.values.push_back(low + (high - low) * i / (k_default_values - 1));
        }
        if (found_.method == "surface" && parameter.values.size() < 3)
            mistakes_.add({where, fmt::format("{} has {} value(s)", name, parameter.values.size()),
                           "A quadratic needs three values of each parameter", "Add values, or use method = \"grid\""});
        else if (parameter.values.size() < 2)
            mistakes_.add({where, fmt::format("{} has {} value", name, parameter.values.size()), "A grid compares values",
                           "Add values, or write the value into the studies"});
        places_.push_back(where);
        found_.parameters.push_back(std::move(parameter));
    }

    void read_target(const ParameterValues& table) {
        calibration::Target target;
        Measured measured;
        const bool held_out = is_held_out(table);
        measured.measure = text_of(table, "target.measure");
        const std::string where = place_of(table, "target.measure", path_);
        measured.study = study_index(table, where);
        const std::string stem = measured.study < found_.studies.size() ? found_.studies[measured.study].stem().string() : "";
        target.name = table.has("target.name") ? table.text("target.name")
                                               : (found_.studies.size() > 1 ? stem + ": " : std::string()) + measured.measure;
        if (table.has("target.tolerance")) target.tolerance = table.number("target.tolerance");
        if (table.has("target.weight")) target.weight = table.number("target.weight");
        if (held_out && table.has("target.weight"))
            mistakes_.add({where, fmt::format("the held-out target {} has the weight {} in the objective", target.name, target.weight),
                           "A held-out target never enters the objective", "Remove its weight, or held_out = true"});
        const bool value = !table.where("target.value").empty(), profile = !table.where("target.profile").empty();
        if (value == profile)
            mistakes_.add({where, fmt::format("the target {} has {}", target.name, value ? "a value and a profile" : "no value"),
                           "A target is either a value or a profile", "Give one of them"});
        if (table.has("target.value")) target.values = {table.number("target.value")};
        if (value && !table.where("target.lowest_m").empty())
            mistakes_.add({table.where("target.lowest_m"), fmt::format("the target {} has a value and lowest_m", target.name),
                           "lowest_m leaves out places of a profile", "Remove it"});
        if (table.has("target.profile")) read_target_profile(table, target, measured);
        check_measure(measured, profile && !value, where);
        if (found_.objective != nullptr && found_.objective->relative && !held_out &&
            std::count(target.values.begin(), target.values.end(), 0.0) > 0)
            mistakes_.add({where, fmt::format("the target {} is 0", target.name), "A relative error divides by the target",
                           "Use objective = \"squared_misfit\""});
        (held_out ? found_.targets.held_out : found_.targets.fitted).push_back(target);
        (held_out ? held_out_measured_ : fitted_measured_).push_back(measured);
    }

    /// The study has the measure of a target, and a profile where the target has one.
    void check_measure(const Measured& measured, bool has_profile, const std::string& where) {
        if (measured.measure.empty() || measured.study >= found_.studies.size()) return;
        const std::optional<std::vector<StudyMeasure>>& known = measures_[measured.study];
        if (!known) return;
        const fs::path& study = found_.studies[measured.study];
        std::vector<std::string> names, profiles;
        for (const StudyMeasure& measure : *known) {
            names.push_back(measure.name);
            if (measure.has_profile) profiles.push_back(measure.name);
        }
        const auto among = [&](const std::vector<std::string>& list) {
            return std::find(list.begin(), list.end(), measured.measure) != list.end();
        };
        if (!names.empty() && !among(names)) {
            const std::string nearest = nearest_word(measured.measure, names);
            return mistakes_.add({where, fmt::format("{} has no measure {}", study.string(), measured.measure),
                                  fmt::format("Its measures are {}", fmt::join(names, ", ")),
                                  nearest.empty() ? "Correct it" : fmt::format("Did you mean {}?", nearest)});
        }
        if (has_profile && !among(profiles))
            mistakes_.add({where, fmt::format("{} of {} has no profile", measured.measure, study.string()),
                           profiles.empty() ? "Heights of a profile are compared with those of a measure of what = \"profile\""
                                            : fmt::format("Its measures with a profile are {}", fmt::join(profiles, ", ")),
                           "Name a measure of what = \"profile\", or give a value in place of the profile"});
    }

    std::size_t study_index(const ParameterValues& table, const std::string& where) {
        std::vector<std::string> stems;
        for (const fs::path& study : found_.studies) stems.push_back(study.stem().string());
        if (!table.has("target.study")) {
            if (stems.size() <= 1) return 0;
            mistakes_.add({where, fmt::format("the target {} names no study", text_of(table, "target.measure")),
                           fmt::format("With several studies each target belongs to one: {}", fmt::join(stems, ", ")),
                           fmt::format("Add study = \"{}\"", stems.front())});
            return stems.size();
        }
        const std::string name = table.text("target.study");
        const auto found = std::find(stems.begin(), stems.end(), name);
        if (found == stems.end() && !stems.empty()) {
            const std::string nearest = nearest_word(name, stems);
            mistakes_.add({place_of(table, "target.study", path_), fmt::format("target.study = \"{}\" is no study", name),
                           fmt::format("Studies are {}", fmt::join(stems, ", ")),
                           nearest.empty() ? "Correct it" : fmt::format("Did you mean {}?", nearest)});
        }
        return static_cast<std::size_t>(found - stems.begin());
    }

    void read_target_profile(const ParameterValues& table, calibration::Target& target, Measured& measured) {
        const fs::path file = path_.parent_path() / table.text("target.profile");
        if (!fs::exists(file))
            return mistakes_.add({place_of(table, "target.profile", path_), fmt::format("{} does not exist", file.string()),
                                  "Profiles are files beside the calibration, or have paths from it", "Check the path"});
        Profile profile;
        if (!mistakes_.gather([&] { profile = read_profile(file); })) return;
        const std::vector<double>& places = profile.place;
        const std::vector<double>& heights = profile.height;
        profiles_ += sha256_of_file(file);
        const double lowest = table.has("target.lowest_m") ? table.number("target.lowest_m") : 0.0;
        const double first = places.front(), last = places.back();
        for (int i = 0; i < k_profile_places; ++i) {
            const double x = first + (last - first) * i / (k_profile_places - 1);
            std::size_t row = 1;
            while (row + 1 < places.size() && places[row] < x) ++row;
            const double share = (x - places[row - 1]) / (places[row] - places[row - 1]);
            const double height = (1.0 - share) * heights[row - 1] + share * heights[row];
            if (height <= lowest) continue;
            measured.places.push_back(x);
            target.values.push_back(height);
        }
        if (target.values.empty())
            mistakes_.add({file.string(), fmt::format("no height is above {} m", lowest), "A profile has places that count",
                           "Correct the heights or lowest_m"});
    }

    void check_whole(const ParameterValues& values) {
        const std::size_t parameters = values.tables("parameter").size();
        const std::vector<ParameterValues>& targets = values.tables("target");
        mistakes_.require(parameters >= 1 && parameters <= k_most_parameters, fmt::format("{} [[parameter]]", parameters),
                          fmt::format("A calibration varies 1 to {} keys", k_most_parameters), "Add or remove some");
        mistakes_.require(!(found_.method == "bobyqa" && parameters == 1), "bobyqa with one parameter", "It needs two or more",
                          "Use method = \"surface\"");
        mistakes_.require(!std::all_of(targets.begin(), targets.end(), is_held_out), "no [[target]] is fitted",
                          "The objective needs a target that is not held out", "Add one");
        std::set<std::string> keys, names;
        for (const CalibratedParameter& parameter : found_.parameters) {
            const bool is_new = parameter.key.empty() || keys.insert(parameter.key).second;
            mistakes_.require(is_new, fmt::format("{} is varied twice", parameter.key), "Each parameter has a key of its own",
                              "Remove one");
            mistakes_.require(!is_new || parameter.range.name.empty() || names.insert(parameter.range.name).second,
                              fmt::format("two parameters are called {}", parameter.range.name), "Results tell parameters by their names",
                              "Rename one");
        }
        require_own_names(found_.targets.fitted);
        require_own_names(found_.targets.held_out);
        check_held_out();
        for (std::size_t study = 0; study < found_.studies.size(); ++study)
            mistakes_.require(has_target(study), fmt::format("{} has no target", found_.studies[study].string()),
                              "The runs of each study are compared with a target", "Add a [[target]] with this study, or remove it");
    }

    /// Rounds and evaluations that the method does not take.
    void check_unused(const ParameterValues& values) {
        if (found_.method.empty()) return;
        const auto require_method = [&](const char* key, const std::string& method, const char* rule) {
            if (found_.method != method && !values.where(key).empty())
                mistakes_.add({values.where(key), fmt::format("{} is given with method = \"{}\"", key, found_.method), rule,
                               fmt::format("Remove it, or use method = \"{}\"", method)});
        };
        require_method("rounds", "surface", "Rounds follow the grid of method = \"surface\"");
        require_method("evaluations", "bobyqa", "Evaluations are the places that method = \"bobyqa\" tries");
    }

    bool has_target(std::size_t study) const {
        return std::any_of(found_.measured.begin(), found_.measured.end(), [&](const Measured& one) { return one.study == study; });
    }

    void require_own_names(const std::vector<calibration::Target>& targets) {
        std::set<std::string> names;
        for (const calibration::Target& target : targets)
            mistakes_.require(target.name.empty() || names.insert(target.name).second,
                              fmt::format("two targets are called {}", target.name), "Results tell targets by their names",
                              "Remove one, or give it another name");
    }

    /// The same measurement cannot be held out and fitted.
    void check_held_out() {
        for (std::size_t h = 0; h < held_out_measured_.size(); ++h)
            for (const Measured& fitted : fitted_measured_)
                if (fitted.study == held_out_measured_[h].study && fitted.measure == held_out_measured_[h].measure)
                    mistakes_.add(fmt::format("the held-out target {} is in the objective as well", found_.targets.held_out[h].name),
                                  "A held-out target never enters the objective", "Remove one of the two");
    }

    /// Repeats, the keys, the ends of the ranges and the grid are allowed in all studies.
    void check_points() {
        const int repeats = std::max(found_.repeats, found_.repeats_at_answer);
        for (const fs::path& study : found_.studies) {
            const bool sound = fs::exists(study) && mistakes_.gather([&] { access_.points(study, {}, repeats, fs::path("runs")); });
            studies_are_sound_ = studies_are_sound_ && sound;
            for (std::size_t n = 0; sound && n < found_.parameters.size(); ++n)
                if (!found_.parameters[n].key.empty()) check_parameter(study, found_.parameters[n], places_[n]);
            if (sound && mistakes_.empty()) check_together(study);
        }
    }

    /// The parameters set different tables.
    void check_together(const fs::path& study) {
        std::vector<KeyAxis> axes;
        for (const CalibratedParameter& parameter : found_.parameters) axes.push_back({parameter.key, {number_text(parameter.range.low)}});
        require_points(study, axes, places_.back());
    }

    void check_parameter(const fs::path& study, const CalibratedParameter& parameter, const std::string& place) {
        std::set<double> all(parameter.values.begin(), parameter.values.end());
        all.insert({parameter.range.low, parameter.range.high});
        std::vector<std::string> texts;
        for (const double value : all) texts.push_back(number_text(value));
        require_points(study, {{parameter.key, texts}}, place);
        if (found_.method != "grid") check_between(study, parameter, place);
    }

    /// Methods that choose places themselves take them from all of the range.
    void check_between(const fs::path& study, const CalibratedParameter& parameter, const std::string& place) {
        const double between = parameter.range.low + k_between * (parameter.range.high - parameter.range.low);
        const auto takes = [&](double value) {
            Mistakes refused;
            return refused.gather([&] { access_.points(study, {{parameter.key, {number_text(value)}}}, 1, fs::path("runs")); });
        };
        if (takes(between)) return;
        if (takes(std::round(between)))
            mistakes_.add({place, fmt::format("{}: {} takes whole numbers alone", study.string(), parameter.key),
                           fmt::format("method = \"{}\" looks for places between those of the grid", found_.method),
                           "Use method = \"grid\""});
        else
            require_points(study, {{parameter.key, {number_text(between)}}}, place);
    }

    void require_points(const fs::path& study, const std::vector<KeyAxis>& axes, const std::string& place) {
        try {
            access_.points(study, axes, 1, fs::path("runs"));
        } catch (const UserError& error) {
            for (const Mistake& mistake : error.mistakes()) add_of_parameter(study, place, mistake);
        }
    }

    /// What is said of a sweep's option, or of a line of a study that is not written, is of this file's parameter.
    void add_of_parameter(const fs::path& study, const std::string& place, const Mistake& mistake) {
        const std::string option = "--set ";
        const bool of_option = mistake.what.rfind(option, 0) == 0;
        const std::string what = of_option ? "parameter " + mistake.what.substr(option.size()) : mistake.what;
        mistakes_.add({place, fmt::format("{}: {}", study.string(), what), mistake.rule, mistake.remedy});
    }

    void check_plan() {
        const CalibrationPlan& plan = found_.plan = plan_of(found_, access_);
        mistakes_.require(static_cast<double>(plan.runs) <= found_.budget_runs,
                          fmt::format("the plan takes {} runs: {} places of {}, and {} at the answer", plan.runs, plan.grid + plan.further,
                                      found_.runs_of_a_place(), found_.runs_of_the_answer()),
                          fmt::format("budget.runs is {}", found_.budget_runs), "Take fewer values, repeats or rounds, or raise it");
        if (plan.core_h)
            mistakes_.require(*plan.core_h <= found_.budget_core_h, fmt::format("the plan takes about {:.3g} core hours", *plan.core_h),
                              fmt::format("budget.core_h is {}", found_.budget_core_h),
                              "Take fewer values, repeats or rounds, coarser studies, or raise it");
    }

    fs::path path_;
    const StudyAccess& access_;
    Mistakes mistakes_;
    CalibrationFile found_;
    std::vector<std::optional<std::vector<StudyMeasure>>> measures_;  // of the studies
    std::vector<std::string> places_;                                 // of the parameters
    bool studies_are_sound_ = true;
    std::vector<Measured> fitted_measured_, held_out_measured_;
    std::string profiles_;  // their contents' hashes
};

}  // namespace

bool CalibrationFile::is_fitted(std::size_t study) const {
    const auto end = measured.begin() + static_cast<std::ptrdiff_t>(targets.fitted.size());
    return std::any_of(measured.begin(), end, [&](const Measured& one) { return one.study == study; });
}

std::size_t CalibrationFile::runs_of_a_place() const {
    std::size_t fitted = 0;
    for (std::size_t study = 0; study < studies.size(); ++study)
        if (is_fitted(study)) ++fitted;
    return fitted * static_cast<std::size_t>(repeats);
}

std::size_t CalibrationFile::runs_of_the_answer() const {
    return studies.size() * static_cast<std::size_t>(repeats_at_answer);
}

std::vector<calibration::Range> CalibrationFile::ranges() const {
    std::vector<calibration::Range> all;
    for (const CalibratedParameter& parameter : parameters) all.push_back(parameter.range);
    return all;
}

const ParameterTable& calibration_table() {
    static const ParameterTable table = make_table();
    return table;
}

std::string number_text(double value) {
    return fmt::format("{:.6g}", value);
}

CalibrationFile read_calibration(const fs::path& file, const StudyAccess& access) {
    return Reader(file, access).read();
}

}  // namespace cutterflow::cases
