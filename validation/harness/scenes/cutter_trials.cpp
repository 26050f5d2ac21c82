#include "validation/harness/scenes/cutter_trials.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "cases/runner/stages.hpp"
#include "cases/scenes/cutter/flow_dictionaries.hpp"
#include "cases/testing/tiny_rotor_mesh.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/run_files.hpp"
#include "meshing/dictionary/foam_dictionary.hpp"
#include "validation/harness/pareto.hpp"
#include "validation/harness/program_run.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_top_bin = "60-90mm";  // the first below the ring, whose steel reaches down to 50 mm
constexpr const char* k_default = "default";

/// The model cutter at 60 rpm, a revolution a second.
std::string study(const CutterOptions& options) {
    constexpr double k_twelfth = 1.0 / 12.0;
    std::string text = "[cutter]\nfile = \"../cutter.stl\"\nunit = \"m\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n";
    text += fmt::format("[report]\noutflow_start_s = {}\n", k_twelfth);
    text += fmt::format("[run]\nflow_revolutions = {}\nmax_revolutions = {}\nstop_undecided = 0\n", k_twelfth,
                        (options.rock ? 2.0 : 3.0) * k_twelfth);
    if (options.max_courant) text += fmt::format("max_courant = {}\n", *options.max_courant);
    if (!options.rock) return text;
    if (options.gamma) text += fmt::format("[kernel]\ngamma = {}\n", *options.gamma);
    text += "[rock]\npreset = \"paper\"\n";
    if (options.dem_step) text += fmt::format("time_step_fraction = {}\n", *options.dem_step);
    if (options.youngs_modulus) text += fmt::format("youngs_modulus_pa = {}\n", *options.youngs_modulus);
    return text + "[[feed]]\ncount = 60\n[[feed.class]]\ndiameter_m = 0.02\n";
}

double top_outflow(const nlohmann::json& results) {
    for (const nlohmann::json& bin : results.at("outflow").at("bins"))
        if (bin.at("name") == k_top_bin) return bin.at("radial_velocity_mean_m_s");
    throw std::runtime_error(std::string("the run has no bin ") + k_top_bin);
}

/// As a user overrides a generated file.
void override_convection(const fs::path& run, cases::ConvectionScheme scheme) {
    cases::CaseInputs inputs = cases::test::tiny_inputs();
    inputs.numerics.convection = scheme;
    for (const cases::FoamFile& file : cases::run_system_files(inputs))
        if (file.path == "system/fvSchemes") meshing::write_foam_file(run / "overrides" / file.path, file.foam_class, file.contents);
}

/// Of the flow [N m], over whole passings of a blade; none when the run is shorter.
std::optional<double> torque(const fs::path& folder) {
    const auto rotor = nlohmann::json::parse(read_file(folder / "run" / names::results_json)).at("rotor");
    const auto& mean = rotor.at("torque_flow_mean_n_m");
    return mean.is_null() ? std::nullopt : std::optional<double>(mean.get<double>());
}

/// \return its cost; the outflow [m/s] takes the place of the error
Trial run_trial(const fs::path& folder, const CutterOptions& options) {
    write_file(folder / "study.toml", study(options));
    const fs::path common = folder.parent_path(), donor = common / k_default / "run";
    const fs::path crown = installation().data / "cases/examples/model_cutter/crown.toml";
    if (!fs::exists(common / "cutter.stl")) run_cutterflow(common, {"generate-cutter", crown.string(), "-o", "cutter.stl"});
    const bool first = folder.filename() == k_default;
    if (!first) cases::share_stages(donor, folder / "run", {"geometry", "mesh"});
    if (options.convection) override_convection(folder / "run", *options.convection);
    const double outflow = top_outflow(run_study(folder, first ? fs::path() : donor));
    return {stage_core_s(folder / "run", "run"), outflow};
}

struct CutterTrial {
    Trial trial;
    std::optional<double> torque;  ///< mean of the flow's [N m]
};

void show(Verification& verification, const std::string& title, const std::vector<CutterValue>& values,
          const std::vector<CutterTrial>& trials) {
    Chart chart{title, "core seconds", "distance of the outflow from the finest run, %", {}};
    ExhibitTable table{fmt::format("Outflow {} below the ring plane: {}", k_top_bin, title),
                       {"value", "core seconds", "outflow, m/s", "torque of the flow, N m"},
                       {}};
    for (std::size_t v = 0; v < values.size(); ++v) {
        const Trial& trial = trials[v].trial;
        const double distance = 100.0 * std::abs(trial.error / trials.back().trial.error - 1.0);
        chart.points.push_back({values[v].label, trial.core_s, distance, values[v].standard});
        table.rows.push_back({values[v].label, fmt::format("{:.1f}", trial.core_s), fmt::format("{:.5f}", trial.error),
                              trials[v].torque ? fmt::format("{:.3f}", *trials[v].torque) : "–"});
        if (values[v].standard && v + 1 < values.size())  // as the finest it would be held against itself
            verification.report("distance of the default's outflow from the finest run: " + title, "%", distance, {},
                                {"exact", "first bin below the ring, " + std::string(k_top_bin), {}});
    }
    verification.table(table);
    verification.chart(chart);
}

}  // namespace

void run_cutter_sweeps(Verification& verification, const CutterOptions& standard, const std::vector<CutterSweep>& sweeps) {
    const auto finished = [&](const std::string& name, const CutterOptions& options) -> CutterTrial {
        const fs::path folder = verification.folder(name);
        return {finished_or_run<CutterOptions>(folder, options, run_trial), torque(folder)};
    };
    const CutterTrial of_defaults = finished(k_default, standard);
    for (std::size_t s = 0; s < sweeps.size(); ++s) {
        std::vector<CutterTrial> trials;
        for (std::size_t v = 0; v < sweeps[s].values.size(); ++v) {
            const CutterValue& value = sweeps[s].values[v];
            trials.push_back(value.standard ? of_defaults : finished(fmt::format("run_{}_{}", s, v), value.options));
        }
        show(verification, sweeps[s].title, sweeps[s].values, trials);
    }
}

}  // namespace cutterflow::validation
