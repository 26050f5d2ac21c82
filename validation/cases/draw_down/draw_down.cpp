/// \file By how much water slows a draw-down of gravel, from pours of the example studies.
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/runner/machine.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/process/side_by_side.hpp"
#include "geometry/base/statistics/sample.hpp"
#include "validation/harness/program_run.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
namespace fs = std::filesystem;

const char* const k_source = "WasserfallCoetzeeMeyer2024";
constexpr double k_density_ratio = 1000.0 / 2650.0;

/// What one run shows. A slope that is not straight has no angle.
struct Flow {
    double rate = 0.0, rate_of_middle = 0.0;  ///< [kg/s]
    std::optional<double> angle;              ///< of what stays in the box [deg]
};

/// One setting, by pours.
struct Setting {
    std::string name;
    std::vector<Flow> flows;
};

/// The text with lines added at the start of a section.
std::string with_lines(std::string text, const std::string& section, const std::string& lines) {
    const std::string head = "\n[" + section + "]\n";
    const std::size_t start = text.find(head);
    if (start == std::string::npos) throw std::runtime_error("the example has no section [" + section + "]");
    return text.insert(start + head.size(), lines);
}

/// A study of the example with another seed.
std::string study_text(const std::string& study, int seed) {
    return with_lines(read_file(installation().data / "cases/examples/draw_down" / study), "run", fmt::format("seed = {}\n", seed));
}

/// The text with the line of a key replaced.
std::string with_line(std::string text, const std::string& key, const std::string& value) {
    const std::size_t start = text.find("\n" + key + " = ") + 1;
    return text.replace(start, text.find('\n', start) - start, key + " = " + value);
}

std::optional<double> value_of(const nlohmann::json& measure) {
    return measure.at("value").is_null() ? std::nullopt : std::optional<double>(measure.at("value"));
}

Flow flow_of(const fs::path& folder) {
    const nlohmann::json measures = nlohmann::json::parse(read_file(folder / "run/report/measures.json"));
    return {measures.at("rate").at("value"), value_of(measures.at("rate_of_the_middle_half")).value_or(std::nan("")),
            value_of(measures.at("shear_angle"))};
}

/// One size of the box: its studies and how many pours it takes.
struct Rig {
    std::string prefix;  ///< of the folders
    std::string dry_study, wet_study;
    int pours = 0;
    double end_s = 0.0;  ///< 0: as in the studies
};

const Rig k_small{"", "small.toml", "small_submerged.toml", 3}, k_full{"full_", "study.toml", "submerged.toml", 5};

/// As long as the rate is measured.
const Rig k_terms{"terms_", "small.toml", "small_submerged.toml", 3, 1.6};

/// The pours of a setting, on all cores.
class Pours {
public:
    Pours(Verification& verification, Rig rig) : verification_(verification), rig_(std::move(rig)) {}

    Setting dry() { return run("dry", rig_.dry_study, "", false); }
    /// From the beds of the dry pours. \param closures  added to those of the study
    Setting wet(const std::string& name, const std::string& closures = "") { return run(name, rig_.wet_study, closures, true); }
    /// Of all runs so far and their beds.
    double core_s() const { return core_s_; }

private:
    Setting run(const std::string& name, const std::string& study, const std::string& closures, bool from_dry) {
        side_by_side(static_cast<std::size_t>(rig_.pours), cases::available_cores(), [&](std::size_t pour) {
            const int seed = static_cast<int>(pour) + 1;
            const fs::path own = folder(name, seed);
            std::string text = study_text(study, seed);
            if (rig_.end_s > 0.0) text = with_line(std::move(text), "end_s", fmt::format("{}", rig_.end_s));
            if (!closures.empty()) text = with_lines(std::move(text), "closures", closures);
            fs::create_directories(own);
            write_file(own / "study.toml", text);
            run_study(own, from_dry ? folder("dry", seed) / "run" : fs::path());
        });
        Setting setting{name, {}};
        for (int seed = 1; seed <= rig_.pours; ++seed) {
            const fs::path own = folder(name, seed);
            setting.flows.push_back(flow_of(own));
            core_s_ += stage_core_s(own / "run", "run") + (from_dry ? 0.0 : stage_core_s(own / "run", "bed"));
        }
        return setting;
    }
    fs::path folder(const std::string& name, int seed) const {
        return verification_.folder(fmt::format("{}{}_{}", rig_.prefix, name, seed));
    }

    Verification& verification_;
    Rig rig_;
    double core_s_ = 0.0;
};

/// Of 1 - wet/dry, pour by pour: each pour has one bed.
Sample reduction(const Setting& dry, const Setting& wet, double Flow::*rate) {
    std::vector<double> values;
    for (std::size_t k = 0; k < wet.flows.size(); ++k) values.push_back(1.0 - wet.flows[k].*rate / (dry.flows[k].*rate));
    return sample_of(values);
}

/// Of wet less dry, of the pours that have both angles.
Sample change_of_angle(const Setting& dry, const Setting& wet) {
    std::vector<double> values;
    for (std::size_t k = 0; k < wet.flows.size(); ++k)
        if (dry.flows[k].angle && wet.flows[k].angle) values.push_back(*wet.flows[k].angle - *dry.flows[k].angle);
    return sample_of(values);
}

double mean_rate(const Setting& setting) {
    double sum = 0.0;
    for (const Flow& flow : setting.flows) sum += flow.rate;
    return sum / static_cast<double>(setting.flows.size());
}

std::string percent(const Sample& share) {
    return fmt::format("{:.1f} +- {:.1f}", 100.0 * share.mean, 100.0 * standard_error(share));
}

std::vector<std::string> row_of(const Setting& dry, const Setting& setting) {
    return {setting.name, std::to_string(setting.flows.size()), fmt::format("{:.2f}", mean_rate(setting)),
            percent(reduction(dry, setting, &Flow::rate))};
}

void judge(Verification& verification, const Setting& dry, const Setting& wet) {
    const Sample slower = reduction(dry, wet, &Flow::rate), of_middle = reduction(dry, wet, &Flow::rate_of_middle);
    const Sample angle = change_of_angle(dry, wet);
    const std::string pours = fmt::format("{} pours, each dry and under water", slower.count);
    verification.report("rate of flow, dry", "kg/s", mean_rate(dry), {}, {k_source, pours, {}});
    verification.absolute(
        "reduction of the rate under water", "-", slower.mean, 0.345, 0.045,
        {k_source, "0.32 to 0.37 measured, here within the 2 points that the standard error may have: 0.30 to 0.39; " + pours, {}});
    verification.at_most("its standard error", "-", standard_error(slower), 0.02, {"exact", pours, {}});
    verification.report("reduction over the middle half of the mass", "-", of_middle.mean, 0.345,
                        {k_source, fmt::format("standard error {:.2g}", standard_error(of_middle)), {}});
    const std::string error = angle.count > 1 ? fmt::format(", standard error {:.2g}", standard_error(angle)) : "";
    verification.at_most("change of the slope that stays in the box", "deg", angle.count > 0 ? std::abs(angle.mean) : std::nan(""), 1.1,
                         {k_source, fmt::format("of the {} pours with straight slopes{}", angle.count, error), {}});
}

/// Drag off: what buoyancy and added mass do alone.
void check_control(Verification& verification, const Setting& dry, const Setting& control, double expected) {
    const Sample slower = reduction(dry, control, &Flow::rate);
    verification.absolute(
        "reduction with drag off, " + control.name, "-", slower.mean, expected, 0.04,
        {"exact",
         fmt::format("flow by the submerged weight over the inertia; standard error {:.2g}: with one of 0.03 the row sees a buoyancy or an "
                     "added mass that is missing, not one that is a third too small",
                     standard_error(slower)),
         {}});
}

/// Each term of the coupling switched, in the small rig. \return core seconds
double switch_terms(Verification& verification) {
    Pours pours(verification, k_terms);
    const Setting dry = pours.dry();
    ExhibitTable table{"Each term switched, small rig", {"setting", "pours", "rate [kg/s]", "reduction [%]"}, {}};
    const auto add = [&](const Setting& setting) {
        table.rows.push_back(row_of(dry, setting));
        verification.table(table);
        return setting;
    };
    add(dry);
    add(pours.wet("under_water"));
    const std::string drag_off = "drag_modifier = 1e-6\n", no_added_mass = "added_mass = 0.0\n";
    check_control(verification, dry, add(pours.wet("added_mass_alone", drag_off)),
                  1.0 - std::sqrt((1.0 - k_density_ratio) / (1.0 + 0.5 * k_density_ratio)));
    check_control(verification, dry, add(pours.wet("buoyancy_alone", drag_off + no_added_mass)), 1.0 - std::sqrt(1.0 - k_density_ratio));
    add(pours.wet("no_hindrance", "hindrance = \"none\"\n"));
    add(pours.wet("no_added_mass", no_added_mass));
    add(pours.wet("drag_times_4", "drag_modifier = 4.0\n"));
    return pours.core_s();
}

void run(Verification& verification) {
    const bool whole = verification.wants(Effort::longest);
    Pours pours(verification, whole ? k_full : k_small);
    const Setting dry = pours.dry(), wet = pours.wet("under_water");
    judge(verification, dry, wet);
    const double core_s = pours.core_s() + switch_terms(verification);
    verification.report("core time of the runs", "s", core_s, {}, {"exact", "beds included; of all starts of the case", {}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
