/// \file By how much water slows a draw-down of gravel, from pours of the example studies.
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/statistics/sample.hpp"
#include "validation/harness/program_run.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
namespace fs = std::filesystem;

const char* const k_source = "WasserfallCoetzeeMeyer2024";
constexpr double k_density_ratio = 1000.0 / 2650.0;

/// Pours of one setting.
struct Pours {
    std::string name;
    Sample rate, rate_of_middle, angle;  ///< [kg/s], [kg/s], [deg]
};

/// Of the runs that have a value.
Sample sample_in(const fs::path& runs, const std::string& measure) {
    std::vector<double> values;
    for (const fs::directory_entry& run : fs::directory_iterator(runs)) {
        const fs::path file = run.path() / "report/measures.json";
        if (!fs::exists(file)) continue;
        const nlohmann::json value = nlohmann::json::parse(read_file(file)).at(measure).at("value");
        if (value.is_number()) values.push_back(value);
    }
    return sample_of(values);
}

Pours pour(const fs::path& folder, const std::string& name, const std::string& study, int count, const std::vector<std::string>& set = {}) {
    std::vector<std::string> arguments{"sweep", (installation().data / "cases/examples/draw_down" / study).string()};
    for (const std::string& key : set) arguments.insert(arguments.end(), {"--set", key});
    arguments.insert(arguments.end(), {"--repeats", std::to_string(count), "-o", name});
    if (fs::exists(folder / name)) arguments.emplace_back("--resume");
    run_cutterflow(folder, arguments);
    const fs::path runs = folder / name;
    return {name, sample_in(runs, "rate"), sample_in(runs, "rate_of_the_middle_half"), sample_in(runs, "shear_angle")};
}

double square_of_error(const Sample& sample) {
    return sample.variance / static_cast<double>(sample.count);
}

/// 1 - wet/dry, and its standard error.
struct Reduction {
    double value = 0.0, error = 0.0;
};

Reduction reduction(const Sample& dry, const Sample& wet) {
    const double ratio = wet.mean / dry.mean;
    return {1.0 - ratio, ratio * std::sqrt(square_of_error(dry) / (dry.mean * dry.mean) + square_of_error(wet) / (wet.mean * wet.mean))};
}

std::vector<std::string> row_of(const Pours& dry, const Pours& pours) {
    const Reduction slower = reduction(dry.rate, pours.rate), of_middle = reduction(dry.rate_of_middle, pours.rate_of_middle);
    return {pours.name,
            std::to_string(pours.rate.count),
            fmt::format("{:.2f}", pours.rate.mean),
            fmt::format("{:.1f} +- {:.1f}", 100.0 * slower.value, 100.0 * slower.error),
            fmt::format("{:.1f} +- {:.1f}", 100.0 * of_middle.value, 100.0 * of_middle.error),
            fmt::format("{:.1f}", pours.angle.mean)};
}

void judge(Verification& verification, const Pours& dry, const Pours& wet) {
    const Reduction slower = reduction(dry.rate, wet.rate), of_middle = reduction(dry.rate_of_middle, wet.rate_of_middle);
    const std::string pours = fmt::format("{} and {} pours", dry.rate.count, wet.rate.count);
    verification.report("rate of flow, dry", "kg/s", dry.rate.mean, {}, {k_source, pours, {}});
    verification.absolute("reduction of the rate under water", "-", slower.value, 0.345, 0.045,
                          {k_source, "0.32 to 0.37 measured, " + pours, {}});
    verification.at_most("its standard error", "-", slower.error, 0.02, {"exact", pours, {}});
    verification.report("reduction over the middle half of the mass", "-", of_middle.value, 0.345,
                        {k_source, fmt::format("standard error {:.2g}", of_middle.error), {}});
    verification.at_most(
        "change of the slope that stays in the box", "deg", std::abs(wet.angle.mean - dry.angle.mean), 1.1,
        {k_source,
         fmt::format("{:.1f} dry, {:.1f} under water, of {} and {} pours, standard error {:.2g}", dry.angle.mean, wet.angle.mean,
                     dry.angle.count, wet.angle.count, std::sqrt(square_of_error(dry.angle) + square_of_error(wet.angle))),
         {}});
}

/// Drag off: what buoyancy and added mass do alone.
void check_control(Verification& verification, const Pours& dry, const Pours& control, double expected) {
    const Reduction slower = reduction(dry.rate, control.rate);
    verification.absolute(
        "reduction with drag off: " + control.name, "-", slower.value, expected, 0.04,
        {"exact", fmt::format("Beverloo's flow with the submerged weight over the inertia; standard error {:.2g}", slower.error), {}});
}

void run(Verification& verification) {
    const fs::path folder = verification.folder("pours");
    const bool whole = verification.wants(Effort::longest);
    const std::string dry_study = whole ? "study.toml" : "small.toml", wet_study = whole ? "submerged.toml" : "small_submerged.toml";
    const int count = whole ? 5 : 3, of_switched = 3;
    const Pours dry = pour(folder, "dry", dry_study, count), wet = pour(folder, "under_water", wet_study, count);
    judge(verification, dry, wet);
    ExhibitTable table{"Each term switched",
                       {"setting", "pours", "rate [kg/s]", "reduction [%]", "over the middle half [%]", "slope [deg]"},
                       {row_of(dry, dry), row_of(dry, wet)}};
    verification.table(table);
    if (!whole) return;
    const std::string drag_off = "closures.drag_modifier=1e-6", no_added_mass = "closures.added_mass=0";
    const auto switched = [&](const std::string& name, const std::vector<std::string>& set) {
        const Pours pours = pour(folder, name, wet_study, of_switched, set);
        table.rows.push_back(row_of(dry, pours));
        verification.table(table);
        return pours;
    };
    check_control(verification, dry, switched("added_mass_alone", {drag_off}),
                  1.0 - std::sqrt((1.0 - k_density_ratio) / (1.0 + 0.5 * k_density_ratio)));
    check_control(verification, dry, switched("buoyancy_alone", {drag_off, no_added_mass}), 1.0 - std::sqrt(1.0 - k_density_ratio));
    switched("no_hindrance", {"closures.hindrance=none"});
    switched("no_added_mass", {no_added_mass});
    switched("drag_times_4", {"closures.drag_modifier=4"});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
