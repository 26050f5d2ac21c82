#pragma once
/// \file Error against cost, one option at a time, the others at the program's defaults: shared by the pareto cases.
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/verification.hpp"

namespace cutterflow::validation {

/// One run.
struct Trial {
    double core_s = 0.0;
    double error = 0.0;
};

/// A value of an option, as a change of the defaults; one without a change is the default itself.
template <class Options>
struct OptionValue {
    std::string label;
    std::function<void(Options&)> change;
};

/// One chart: the default first.
template <class Options>
struct Sweep {
    std::string title;
    std::vector<OptionValue<Options>> values;
};

template <class Options>
std::vector<OptionValue<Options>> number_values(double Options::*member, const std::vector<double>& values) {
    std::vector<OptionValue<Options>> result = {{fmt::format("{:g}", Options().*member), {}}};
    for (const double value : values)
        result.push_back({fmt::format("{:g}", value), [member, value](Options& options) { options.*member = value; }});
    return result;
}

/// Of Options::convection.
template <class Options>
std::vector<OptionValue<Options>> scheme_values(const std::vector<std::string>& schemes) {
    std::vector<OptionValue<Options>> result = {{Options().convection, {}}};
    for (const std::string& scheme : schemes) result.push_back({scheme, [scheme](Options& options) { options.convection = scheme; }});
    return result;
}

/// The options that one rock in a tank has, with the values that its charts show.
/// \param mesh  rock diameters over cells beside the default
template <class Options>
std::vector<Sweep<Options>> one_rock_sweeps(const std::vector<double>& mesh) {
    return {{"mesh: rock diameter over cell", number_values(&Options::rock_over_cell, mesh)},
            {"time step: travel of the rock in cells", number_values(&Options::travel, {0.0625, 0.125, 0.5, 1.0})},
            {"kernel width gamma", number_values(&Options::gamma, {0.5, 0.75, 1.5, 2.0})},
            {"DEM step over the shortest contact time", number_values(&Options::dem_step, {0.025, 0.05, 0.2, 0.4})},
            {"Young's modulus, Pa", number_values(&Options::youngs_modulus, {1e6, 1e7, 1e9})},
            {"scheme of convection", scheme_values<Options>({"upwind", "limitedLinearV 1", "linear"})}};
}

/// Section rock.contact of couplingProperties.
inline std::string pareto_contact(double youngs_modulus, double dem_step) {
    return fmt::format(
        "youngsModulus {:g}; poissonRock 0.24; poissonSteel 0.27; wetRestitution true; timeStepFraction {}; maxSpeed 1.5; {}",
        youngs_modulus, dem_step, k_paper_contact_pairs);
}

/// A trial that an earlier start of the case finished in this folder, or a new one.
template <class Options>
Trial finished_or_run(const std::filesystem::path& folder, const Options& options,
                      const std::function<Trial(const std::filesystem::path&, const Options&)>& run) {
    const std::filesystem::path mark = folder.string() + ".json";
    if (std::filesystem::exists(mark)) {
        const nlohmann::json kept = nlohmann::json::parse(read_file(mark));
        return {kept.at("core_s"), kept.at("error")};
    }
    std::filesystem::remove_all(folder);
    const Trial trial = run(folder, options);
    write_file(mark, nlohmann::json{{"core_s", trial.core_s}, {"error", trial.error}}.dump(2) + "\n");
    return trial;
}

/// Runs every value of every sweep, the default once, and shows one chart a sweep. What an earlier start finished is kept.
/// \param run  runs the case in a folder that is not yet there
/// \return the default's
template <class Options>
Trial run_pareto(Verification& verification, const std::vector<Sweep<Options>>& sweeps, const std::string& error_axis,
                 const std::function<Trial(const std::filesystem::path&, const Options&)>& run) {
    const Trial standard = finished_or_run(verification.folder("default"), Options(), run);
    for (std::size_t s = 0; s < sweeps.size(); ++s) {
        Chart chart{sweeps[s].title, "core seconds", error_axis, {}};
        for (std::size_t v = 0; v < sweeps[s].values.size(); ++v) {
            const OptionValue<Options>& value = sweeps[s].values[v];
            Trial trial = standard;
            if (value.change) {
                Options options;
                value.change(options);
                trial = finished_or_run(verification.folder(fmt::format("run_{}_{}", s, v)), options, run);
            }
            chart.points.push_back({value.label, trial.core_s, trial.error, !value.change});
        }
        verification.chart(chart);
    }
    return standard;
}

}  // namespace cutterflow::validation
