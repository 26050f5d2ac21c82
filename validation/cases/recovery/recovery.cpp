/// \file Friction and restitution that nobody told are looked for by `cutterflow calibrate`, from a draw-down made with them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/file_content.hpp"
#include "geometry/base/statistics/sample.hpp"
#include "validation/harness/program_run.hpp"
#include "validation/harness/reference_table.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
namespace fs = std::filesystem;

constexpr int k_pours = 3;
constexpr double k_least_tolerance = 0.01;  // of a target
const char* const k_friction = "contact.gravel-gravel.friction";
const char* const k_restitution = "contact.gravel-gravel.restitution";

struct Hidden {
    double friction, restitution;
};

Hidden draw() {
    std::mt19937 random(20);
    std::uniform_real_distribution<double> between(0.3, 0.7);
    const double friction = between(random);
    return {friction, between(random)};
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
std::vector<Target> measured(const fs::path& folder, const Hidden& hidden) {
    write_file(folder / "hidden.toml", read_file(case_file("recovery/rig.toml")) + "seed = 1001\n");
    begin_or_resume(folder, "hidden",
                    {"sweep", "hidden.toml", "--set", fmt::format("{}={}", k_friction, hidden.friction), "--set",
                     fmt::format("{}={}", k_restitution, hidden.restitution), "--repeats", std::to_string(k_pours)});
    std::vector<Target> targets{{"left"}, {"middle"}, {"rate"}};
    for (Target& target : targets) {
        std::vector<double> values;
        for (const fs::directory_entry& run : fs::directory_iterator(folder / "hidden")) {
            const fs::path file = run.path() / "report/measures.json";
            if (fs::exists(file)) values.push_back(nlohmann::json::parse(read_file(file)).at(target.measure).at("value"));
        }
        const Sample sample = sample_of(values);
        target.value = sample.mean;
        target.tolerance = std::max(half_interval(sample), k_least_tolerance * target.value);
    }
    return targets;
}

std::string parameter(const std::string& name, const char* key) {
    return fmt::format("[[parameter]]\nname = \"{}\"\nkey = \"{}\"\nrange = [0.2, 0.8]\nvalues = [0.2, 0.5, 0.8]\ntolerance = 0.05\n", name,
                       key);
}

nlohmann::json calibrate(const fs::path& folder, const std::vector<Target>& targets) {
    std::string text = "name = \"recovery\"\nstudy = [\"rig.toml\"]\nrepeats = 2\nrounds = 1\n[budget]\nruns = 30\ncore_h = 1\n";
    text += parameter("friction", k_friction) + parameter("restitution", k_restitution);
    for (const Target& target : targets)
        text += fmt::format("[[target]]\nmeasure = \"{}\"\nvalue = {}\ntolerance = {}\n", target.measure, target.value, target.tolerance);
    write_file(folder / "rig.toml", read_file(case_file("recovery/rig.toml")));
    write_file(folder / "calibration.toml", text);
    begin_or_resume(folder, "calibration", {"calibrate", "calibration.toml"});
    return nlohmann::json::parse(read_file(folder / "calibration/calibration.json"));
}

/// How far a value lies outside the interval of a parameter; no number, which fails, where there is no interval.
double outside(const nlohmann::json& interval, double value) {
    if (interval.is_null()) return std::numeric_limits<double>::quiet_NaN();
    return std::max({0.0, interval.at(0).get<double>() - value, value - interval.at(1).get<double>()});
}

void run(Verification& verification) {
    const fs::path folder = verification.folder("draw_down");
    const Hidden hidden = draw();
    const nlohmann::json found = calibrate(folder, measured(folder, hidden));
    const nlohmann::json &friction = found.at("parameters").at(0), &restitution = found.at("parameters").at(1);
    const double value = friction.at("value");
    const std::string runs =
        fmt::format("{} runs, {:.2g} core h", found.at("cost").at("runs").get<int>(), found.at("cost").at("core_h").get<double>());
    verification.absolute("friction that was found", "-", value, hidden.friction, 0.05, {"exact", runs, {}});
    verification.at_least("distance of the friction found from the hidden one", "-", std::abs(value - hidden.friction), 1e-9,
                          {"exact", "0 would be the target's own pour", {}});
    verification.at_most("hidden friction outside its 95 % interval by", "-", outside(friction.at("interval_95"), hidden.friction), 0.0,
                         {"exact", "interval " + friction.at("interval_95").dump(), {}});
    verification.at_most("hidden restitution outside its 95 % interval by", "-", outside(restitution.at("interval_95"), hidden.restitution),
                         0.0, {"exact", "interval " + restitution.at("interval_95").dump(), {}});
    verification.report("restitution that was found", "-", restitution.at("value"), hidden.restitution,
                        {"exact", "a draw-down hardly feels it", {}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
