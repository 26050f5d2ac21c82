/// \file Parameters of gravel that nobody told are looked for by `cutterflow calibrate`, from draw-downs made with them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/statistics/sample.hpp"
#include "validation/harness/program_run.hpp"
#include "validation/harness/reference_table.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
namespace fs = std::filesystem;

constexpr double k_least_tolerance = 0.01;  // of a target

/// A parameter that is hidden.
struct Unknown {
    const char *name, *key;
    double low, high;        ///< range of the search
    double hidden_from, to;  ///< where the hidden value lies
    double tolerance;        ///< half of an interval that is narrow enough
    double hidden = 0.0;
};

/// A draw-down with its unknowns.
struct Trial {
    std::string folder, study;  ///< text of the study, which ends in [run]
    std::vector<const char*> measures;
    std::vector<Unknown> unknowns;
    int measured_pours = 0, repeats = 1, rounds = 0;
};

/// Values off every grid.
void hide(Trial& trial, unsigned seed) {
    std::mt19937 random(seed);
    for (Unknown& unknown : trial.unknowns)
        unknown.hidden = std::uniform_real_distribution<double>(unknown.hidden_from, unknown.to)(random);
}

struct Target {
    const char* measure;
    double value = 0.0, tolerance = 0.0;
};

void begin_or_resume(const fs::path& folder, const std::string& output, std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"-o", output});
    if (fs::exists(folder / output)) arguments.emplace_back("--resume");
    run_cutterflow(folder, arguments);
}

/// Pours with other seeds than those of the calibration.
std::vector<Target> measured(const fs::path& folder, const Trial& trial) {
    write_file(folder / "hidden.toml", trial.study + "seed = 1001\n");
    std::vector<std::string> arguments = {"sweep", "hidden.toml", "--repeats", std::to_string(trial.measured_pours)};
    for (const Unknown& unknown : trial.unknowns)
        arguments.insert(arguments.end(), {"--set", fmt::format("{}={}", unknown.key, unknown.hidden)});
    begin_or_resume(folder, "hidden", arguments);
    std::vector<Target> targets;
    for (const char* measure : trial.measures) {
        std::vector<double> values;
        for (const fs::directory_entry& run : fs::directory_iterator(folder / "hidden")) {
            const fs::path file = run.path() / "report/measures.json";
            if (!fs::exists(file)) continue;
            const nlohmann::json value = nlohmann::json::parse(read_file(file)).at(measure).at("value");
            if (!value.is_null()) values.push_back(value);
        }
        const Sample sample = sample_of(values);
        if (sample.count > 1)
            targets.push_back({measure, sample.mean, std::max(half_interval(sample), k_least_tolerance * std::abs(sample.mean))});
    }
    return targets;
}

std::string parameter(const Unknown& unknown) {
    return fmt::format("[[parameter]]\nname = \"{}\"\nkey = \"{}\"\nrange = [{}, {}]\nvalues = [{}, {}, {}]\ntolerance = {}\n",
                       unknown.name, unknown.key, unknown.low, unknown.high, unknown.low, 0.5 * (unknown.low + unknown.high), unknown.high,
                       unknown.tolerance);
}

nlohmann::json calibrate(const fs::path& folder, const Trial& trial, const std::vector<Target>& targets) {
    std::string text =
        fmt::format("name = \"recovery\"\nstudy = [\"rig.toml\"]\nrepeats = {}\nrounds = {}\n[budget]\nruns = 60\ncore_h = 20\n",
                    trial.repeats, trial.rounds);
    for (const Unknown& unknown : trial.unknowns) text += parameter(unknown);
    for (const Target& target : targets)
        text += fmt::format("[[target]]\nmeasure = \"{}\"\nvalue = {}\ntolerance = {}\n", target.measure, target.value, target.tolerance);
    write_file(folder / "rig.toml", trial.study);
    write_file(folder / "calibration.toml", text);
    begin_or_resume(folder, "calibration", {"calibrate", "calibration.toml"});
    return nlohmann::json::parse(read_file(folder / "calibration/calibration.json"));
}

/// How far a value lies outside the interval of a parameter; no number, which fails, where there is no interval.
double outside(const nlohmann::json& interval, double value) {
    if (interval.is_null()) return std::numeric_limits<double>::quiet_NaN();
    return std::max({0.0, interval.at(0).get<double>() - value, value - interval.at(1).get<double>()});
}

nlohmann::json recover(const Verification& verification, const Trial& trial) {
    const fs::path folder = verification.folder(trial.folder);
    return calibrate(folder, trial, measured(folder, trial));
}

std::string runs_of(const nlohmann::json& found) {
    return fmt::format("{} runs, {:.2g} core h", found.at("cost").at("runs").get<int>(), found.at("cost").at("core_h").get<double>());
}

/// Whether the targets leave an end of the interval open: it is that of the range then.
bool is_open(const nlohmann::json& parameter) {
    const auto reaches = parameter.value("interval_reaches_range", std::vector<bool>{});
    return std::find(reaches.begin(), reaches.end(), true) != reaches.end();
}

/// No number, which fails, where there is no interval or one without an end.
double half_interval(const nlohmann::json& parameter) {
    const nlohmann::json& interval = parameter.at("interval_95");
    if (interval.is_null() || is_open(parameter)) return std::numeric_limits<double>::quiet_NaN();
    return 0.5 * (interval.at(1).get<double>() - interval.at(0).get<double>());
}

void check_interval(Verification& verification, const std::string& name, const nlohmann::json& found, double hidden) {
    verification.at_most("hidden " + name + " outside its 95 % interval by", "-", outside(found.at("interval_95"), hidden), 0.0,
                         {"exact",
                          fmt::format("interval {}{}", found.at("interval_95").dump(),
                                      is_open(found) ? ", open where it reaches the end of the range: that side cannot fail" : ""),
                          {}});
}

void check_friction(Verification& verification, const std::string& name, const nlohmann::json& found, double hidden,
                    const std::string& runs) {
    const double value = found.at("value");
    verification.absolute(name + " that was found", "-", value, hidden, 0.05, {"exact", runs, {}});
    verification.at_least("distance of the " + name + " found from the hidden one", "-", std::abs(value - hidden), 1e-9,
                          {"exact", "0 would be the target's own pour", {}});
    check_interval(verification, name, found, hidden);
}

/// Friction and restitution of dry gravel in a small box.
void recover_dry(Verification& verification) {
    Trial trial{"draw_down", read_file(case_file("recovery/rig.toml")), {"left", "middle", "rate"}, {}, 10, 4, 1};
    trial.unknowns = {{"friction", "contact.gravel-gravel.friction", 0.2, 0.8, 0.3, 0.7, 0.05},
                      {"restitution", "contact.gravel-gravel.restitution", 0.2, 0.8, 0.3, 0.7, 0.05}};
    hide(trial, 20);
    const nlohmann::json found = recover(verification, trial);
    const nlohmann::json &friction = found.at("parameters").at(0), &restitution = found.at("parameters").at(1);
    check_friction(verification, "friction", friction, trial.unknowns[0].hidden, runs_of(found));
    verification.at_most("half of the friction's interval", "-", half_interval(friction), 0.2,
                         {"exact", "95 %; the bound is what was expected of ten and four pours, README.md", {}});
    check_interval(verification, "restitution", restitution, trial.unknowns[1].hidden);
    verification.report("restitution that was found", "-", restitution.at("value"), trial.unknowns[1].hidden,
                        {"exact", "a draw-down hardly feels it", {}});
}

/// Friction and the modifier of the drag of gravel under water, in the small rig of the example.
void recover_under_water(Verification& verification) {
    std::string study = read_file(installation().data / "cases/examples/draw_down/small_submerged.toml");
    study.insert(study.find("[run]\n"),
                 "[[measure]]\nname = \"middle\"\nwhat = \"mass_in\"\n"
                 "region = { box = { lower_m = [-0.3, -0.075, 0], upper_m = [0.3, 0.075, 0.95] } }\n\n");
    Trial trial{"under_water", study, {"rate", "rate_of_the_middle_half", "shear_angle", "middle"}, {}, 3, 1, 1};
    trial.unknowns = {{"friction", "contact.gravel-gravel.friction", 0.2, 0.8, 0.35, 0.65, 0.05},
                      {"drag modifier", "closures.drag_modifier", 1.0, 4.0, 1.5, 3.5, 0.3}};
    hide(trial, 21);
    const nlohmann::json found = recover(verification, trial);
    const nlohmann::json &friction = found.at("parameters").at(0), &modifier = found.at("parameters").at(1);
    check_friction(verification, "friction under water", friction, trial.unknowns[0].hidden, runs_of(found));
    verification.relative("drag modifier that was found", "-", modifier.at("value"), trial.unknowns[1].hidden, 0.15,
                          {"exact", runs_of(found), {}});
    check_interval(verification, "drag modifier", modifier, trial.unknowns[1].hidden);
}

void run(Verification& verification) {
    recover_dry(verification);
    if (verification.wants(Effort::longest)) recover_under_water(verification);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
