/// \file Studies of water with a free surface.
#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/cli/kinds/stage_lines.hpp"
#include "cases/cli/kinds/study_kind.hpp"
#include "cases/runner/disk_space.hpp"
#include "cases/runner/surface_stages.hpp"
#include "cases/scenes/free_surface/surface_study.hpp"
#include "cases/sweep/surface_sweep.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/process/shell_word.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/versions.hpp"
#include "postproc/analysis/surface_comparison.hpp"
#include "postproc/pages/free_surface/surface_page.hpp"

namespace cutterflow::cli {
namespace {

namespace fs = std::filesystem;

std::string new_study(const NewOptions& options) {
    if (!options.cutter.empty() || options.unit)
        throw UserError("--cutter and --unit with --kind free_surface", "Such a study has no cutter", "Leave them out");
    return cases::surface_study_template(fs::path(options.study).stem().string());
}

void check(const CheckOptions& options) {
    const cases::SurfaceCheck check = cases::check_surface_study(options.study);
    if (options.json) {
        std::cout << nlohmann::json{{"scene", check.scene},
                                    {"prediction", check.prediction},
                                    {"close", check.close},
                                    {"warnings", check.notes}}
                         .dump(2)
                  << std::endl;
        return;
    }
    std::cout << to_text(check) << fmt::format("{} is valid; next: cutterflow run {}\n", options.study, shell_word(options.study));
}

std::optional<double> predicted_core_s(const fs::path& study) {
    return cases::check_surface_study(study).prediction.at("core_s").get<double>();
}

void mesh(const RunOptions& options) {
    throw UserError(fmt::format("mesh of {}", options.study), "A scene with a free surface needs no mesh", "Use cutterflow run");
}

void run(const RunOptions& options) {
    const fs::path solver = installation().programs / "cutterSurface";
    Mistakes mistakes;
    if (options.ranks != 1)
        mistakes.add({"", fmt::format("--ranks {}", options.ranks), "A scene with a free surface runs on one core",
                      "Leave it out; run several studies side by side"});
    if (!options.start_from.empty())
        mistakes.add({"", "--start-from with a scene with a free surface", "It has no frozen-rotor flow", "Leave it out"});
    mistakes.gather([&] { cases::require_usable_run_directory(options.folder()); });
    cases::SurfaceCheck check;
    mistakes.gather([&] { check = cases::check_surface_study(options.study); });
    mistakes.refuse();
    require_programs({solver.string()});
    const cases::RunDirectory directory(options.folder());
    cases::Manifest manifest(directory.file(names::manifest));
    manifest.set_kind("free_surface");
    const auto versions = build_versions();
    manifest.set_versions({versions.begin(), versions.end()});
    try {
        cases::run_stages(directory, manifest, cases::surface_stages(directory, options.study, check, solver), "report", options.resume,
                          stage_lines(3));
    } catch (const Interrupted& interrupted) {
        throw Interrupted(fmt::format("{}. Finished work is kept in {}; resume with: cutterflow run {} -o {} --resume", interrupted.what(),
                                      directory.path().string(), shell_word(options.study), shell_word(options.folder().string())));
    } catch (const std::exception&) {
        cases::refuse_full_disk(directory.path());
        throw;
    }
    say_where_the_report_is(options, directory);
}

void report(const ReportOptions& options) {
    if (options.adv_points || options.still_folder)
        throw UserError(fmt::format("{} with a scene with a free surface", options.adv_points ? "--adv" : "--static"),
                        "It belongs to cutters", "Leave it out");
    const fs::path page = postproc::write_surface_report(options.folder);
    std::cout << (options.json ? read_file(fs::path(options.folder) / names::results_json) : fmt::format("the report: {}\n", page.string()))
              << std::flush;
}

std::vector<cases::SweepPoint> points(const SweepOptions& options, const fs::path&) {
    if (!options.axes.speeds.empty() || !options.axes.discharges.empty() || !options.axes.designs.empty() || options.ranks != 1)
        throw UserError("--rpm, --discharge, --design or --ranks in a sweep of a free-surface study", "They belong to cutters",
                        "Use --set KEY=a,b and --repeats");
    return cases::surface_sweep_points(options.study, cases::key_axes(cases::surface_study_table(), options.set, k_surface_kind.params),
                                       options.axes.repeats);
}

fs::path write_comparison(const std::vector<fs::path>& runs, const fs::path& folder) {
    return postproc::write_surface_comparison(postproc::compare_surface_runs(runs), folder);
}

void compare(const CompareOptions& options) {
    Mistakes mistakes;
    mistakes.require(options.measured.empty(), "--measured with free-surface runs",
                     "Measured points are spillage and production of cutters", "Leave it out");
    mistakes.require(!options.still_folder, "--static with free-surface runs", "Their page has no script to leave out", "Use --output");
    std::vector<postproc::SettingResults> settings;
    mistakes.gather([&] { settings = postproc::compare_surface_runs({options.runs.begin(), options.runs.end()}); });
    mistakes.refuse();
    std::cout << (options.json ? postproc::surface_comparison_json(settings).dump(2) + "\n" : postproc::setting_comparison_text(settings));
    if (options.output) say(fmt::format("the page: {}", postproc::write_surface_comparison(settings, *options.output).string()));
}

}  // namespace

const StudyKind k_surface_kind{"free_surface",
                               "water with a free surface",
                               "cutterflow params --kind free_surface",
                               cases::surface_study_table,
                               new_study,
                               check,
                               predicted_core_s,
                               mesh,
                               run,
                               postproc::is_surface_run,
                               report,
                               points,
                               false,
                               write_comparison,
                               compare};

}  // namespace cutterflow::cli
